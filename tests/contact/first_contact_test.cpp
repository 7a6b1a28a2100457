// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <thread>

#include "contact/contact_cases.hpp"

/// The first contact of a motion is that of every pair of triangles at every waypoint.
namespace tactus::test {
namespace {

using FirstContactLaw = ContactLaw;

TEST_P(FirstContactLaw, FirstContactIsThatOfEveryPairOfTriangles) {
  int close_calls = 0, contacts = 0, cases = 0;
  const TargetContact& contact = scene().contact;
  for (int m = 0; m < 30; ++m) {
    const Motion motion(scene(), random_waypoints(rng));
    for (int k = 0; k < 4; ++k, ++cases) {
      const Pose pose = k < 2 ? pose_near_touching(scene(), motion, rng) : pose_anywhere(scene(), motion, rng);
      const auto plain = reference::first_contact(motion.track, Placed(scene().target, pose), scene().margin);
      const auto found = contact.first_contact(motion.path, pose);
      contacts += plain.has_value();
      if (found != plain) {
        ASSERT_TRUE(is_close_call(scene(), motion, pose, scene().margin, 1, found))
            << "motion " << m << ", case " << k << ": found " << found.value_or(999) << ", not " << plain.value_or(999)
            << " of " << motion.path.size();
        ++close_calls;
      }
      if (found) {
        ASSERT_TRUE(contact.touches(motion.path, *found, pose));
        ASSERT_FALSE(*found > 1 && contact.touches(motion.path, *found - 1, pose));
      }
    }
  }
  EXPECT_LE(close_calls, 2);
  EXPECT_GT(contacts, cases / 5);
  EXPECT_LT(contacts, cases * 4 / 5);
}

/// Exact up to the margin; for wider reaches early by no more than the header says.
TEST_P(FirstContactLaw, FirstWithinIsThatOfEveryPairOfTriangles) {
  constexpr double largest_leaf_radius = 0.01;
  int close_calls = 0;
  for (int m = 0; m < 40; ++m) {
    const Motion motion(scene(), random_waypoints(rng));
    const Pose pose = m % 2 == 0 ? pose_near_touching(scene(), motion, rng) : pose_anywhere(scene(), motion, rng);
    for (const double radius : {0.0, rng.uniform(0.0, 0.002), rng.uniform(0.0, 0.1)}) {
      const std::size_t from = rng.below(motion.path.size() + 2);
      const auto plain = reference::first_contact(motion.track, Placed(scene().target, pose), radius, from);
      const auto found = scene().contact.first_within(motion.path, pose, radius, from);
      if (found == plain) continue;
      if (radius > scene().contact.margin()) {
        const double err = 2.0 * std::max(largest_leaf_radius, 0.4 * radius) + 1e-9;
        const auto earliest = reference::first_contact(motion.track, Placed(scene().target, pose), radius + err, from);
        EXPECT_LE(found.value_or(999), plain.value_or(999));
        EXPECT_GE(found.value_or(999), earliest.value_or(999)) << "motion " << m << ", radius " << radius;
        continue;
      }
      ASSERT_TRUE(is_close_call(scene(), motion, pose, radius, from, found))
          << "motion " << m << ", radius " << radius << ": found " << found.value_or(999) << ", not "
          << plain.value_or(999) << " of " << motion.path.size() << " from " << from;
      ++close_calls;
    }
  }
  EXPECT_LE(close_calls, 1);
}

/// A body that is free stays free however it is moved by less than its clearance.
TEST_P(FirstContactLaw, NoMoveByLessThanTheClearanceTouches) {
  const TargetContact& contact = scene().contact;
  int free = 0;
  for (int m = 0; m < 20; ++m) {
    const Motion motion(scene(), random_waypoints(rng));
    const Pose pose = m % 2 == 0 ? pose_near_touching(scene(), motion, rng) : pose_anywhere(scene(), motion, rng);
    const Pose target_from_tool = pose.inverse() * motion.path.base_from_body(0, 0);
    const contact::Reach reach = contact.reach(0, target_from_tool, scene().margin);
    if (reach.hit) continue;
    ++free;
    for (int k = 0; k < 5; ++k) {
      Pose moved = target_from_tool;
      moved.translation() += std::min(reach.clearance, 1.0) * rng.uniform() * random_direction(rng);
      EXPECT_FALSE(contact.reach(0, moved, scene().margin).hit);
    }
  }
  EXPECT_GT(free, 2);
}

INSTANTIATE_TEST_SUITE_P(, FirstContactLaw, testing::Range(0, 11),
                         [](const auto& scene) { return name_of_pairing(scene.param); });

TEST(TargetContact, APathOfOneWaypointHasNoContact) {
  const Scene& scene = scene_of(0);
  const JointVector q = JointVector::Zero(5);
  const BodyPath path(scene.contact.bodies(), {q});
  const Pose pose(Eigen::Translation3d(path.base_from_body(0, 0).translation()));
  EXPECT_TRUE(scene.contact.touches(path, 0, pose));
  EXPECT_FALSE(scene.contact.first_contact(path, pose));
  EXPECT_FALSE(scene.contact.first_contact(BodyPath(), pose));
}

TEST(TargetContact, AToolInsideAClosedBoxTouchesItAndInsideAnOpenOneDoesNot) {
  JointVector q = JointVector::Zero(5);
  for (const double size : {0.0004, 0.01}) {
    const double room = 3.0 * size;
    for (const bool open : {false, true}) {
      const Scene scene(box(size, size, size), open ? open_box(room, room, room) : box(room, room, room), 1e-5);
      const BodyPath path(scene.contact.bodies(), {q, q});
      const Pose pose(Eigen::Translation3d(path.base_from_body(0, 0).translation()));
      EXPECT_EQ(scene.contact.first_contact(path, pose).has_value(), !open) << size;
    }
  }
}

/// The model is const: threads that share it get what one would.
TEST(TargetContact, AnswersManyThreadsAsOne) {
  Rng rng(5);
  const Scene& scene = scene_of(2);
  const Motion motion(scene, random_waypoints(rng));
  std::vector<Pose> poses;
  for (int i = 0; i < 400; ++i) poses.push_back(pose_anywhere(scene, motion, rng));
  std::vector<std::optional<std::size_t>> shared(poses.size());
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t i = t; i < poses.size(); i += 4) shared[i] = scene.contact.first_contact(motion.path, poses[i]);
    });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_EQ(shared[i], scene.contact.first_contact(motion.path, poses[i]));
}

}  // namespace
}  // namespace tactus::test
