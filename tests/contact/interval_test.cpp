// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "contact/contact_cases.hpp"

/// Every pose of a cell has its first contact in the interval of the cell.
namespace tactus::test {
namespace {

using contact::ContactInterval;
using IntervalLaw = ContactLaw;

double farthest_vertex(const Mesh& mesh) {
  double farthest = 0.0;
  for (const Vector3& v : mesh.vertices) farthest = std::max(farthest, v.norm());
  return farthest;
}

/// An interval has to hold for each pose of a cell, and for one pose with no more radius than it needs.
TEST_P(IntervalLaw, EveryPoseOfACellHasItsFirstContactInTheInterval) {
  const Mesh mesh = scene().target.mesh();
  int certain = 0, later = 0;
  const auto expect_inside = [&](const ContactInterval& interval, const Motion& motion, const Pose& pose) {
    const auto plain = reference::first_contact(motion.track, Placed(scene().target, pose), scene().margin);
    const std::size_t first = plain.value_or(motion.path.size());
    EXPECT_LE(interval.earliest, first);
    EXPECT_GE(interval.latest, first);
    certain += interval.latest < motion.path.size();
    later += interval.earliest > 1;
  };
  for (int m = 0; m < 40; ++m) {
    const Motion motion(scene(), random_waypoints(rng));
    const Pose near = m % 2 == 0 ? pose_near_touching(scene(), motion, rng) : pose_anywhere(scene(), motion, rng);
    const geometry::PoseVector centre = geometry::pose_vector(near);
    geometry::PoseVector half{};
    for (std::size_t d = 0; d < 6; ++d) half[d] = rng.below(4) == 0 ? 0.0 : rng.uniform(0.0, d < 3 ? 0.003 : 0.04);
    const double angle = half[3] + half[4] + half[5];
    const double radius = std::hypot(half[0], half[1], half[2]) + 2.0 * std::sin(0.5 * angle) * farthest_vertex(mesh);
    const ContactInterval interval = scene().contact.first_contact_interval(motion.path, near, radius);
    for (int k = 0; k < 8; ++k) {
      geometry::PoseVector drawn = centre;
      for (std::size_t d = 0; d < 6; ++d)
        drawn[d] += half[d] * (k < 4 ? rng.uniform(-1.0, 1.0) : 2.0 * static_cast<double>(rng.below(2)) - 1.0);
      const Pose pose = geometry::pose_from(drawn);
      const double displacement = largest_displacement(mesh, near, pose) + 1e-12;
      ASSERT_LE(displacement, radius + 1e-11);
      expect_inside(interval, motion, pose);
      expect_inside(scene().contact.first_contact_interval(motion.path, near, displacement), motion, pose);
    }
  }
  EXPECT_GT(later, 40);
  if (!scene().target.solids.empty()) {
    EXPECT_GT(certain, 10);
  } else {
    EXPECT_EQ(certain, 0) << "a surface has no depth";
  }
}

/// As far away in any direction as the radius allows, the pose itself still belongs to the interval.
TEST_P(IntervalLaw, TheRadiusOfAnIntervalMayBeUsedUp) {
  for (int m = 0; m < 25; ++m) {
    const Motion motion(scene(), random_waypoints(rng));
    const Pose pose = pose_near_touching(scene(), motion, rng);
    const auto plain = reference::first_contact(motion.track, Placed(scene().target, pose), scene().margin);
    const std::size_t first = plain.value_or(motion.path.size());
    for (int k = 0; k < 40; ++k) {
      const double radius = std::pow(10.0, rng.uniform(-3.5, -1.5));
      Pose centre = pose;
      centre.translation() += radius * random_direction(rng);
      const ContactInterval interval = scene().contact.first_contact_interval(motion.path, centre, radius + 1e-9);
      ASSERT_LE(interval.earliest, first);
      ASSERT_GE(interval.latest, first);
    }
  }
}

/// Where a body is certainly so deep at one pose, it may at another be less deep by what lies between them; and where
/// it may be within a reach, the robot is.
TEST_P(IntervalLaw, WhatIsCertainlyDeepMayBeNearlyAsDeepAtAnyPoseNearBy) {
  const TargetContact& contact = scene().contact;
  const Mesh mesh = scene().target.mesh();
  int deep = 0, nearer = 0;
  for (int m = 0; m < 60; ++m) {
    const Motion motion(scene(), random_waypoints(rng));
    const Pose pose = m % 2 == 0 ? pose_near_touching(scene(), motion, rng) : pose_anywhere(scene(), motion, rng);
    const std::size_t from = rng.below(3), to = motion.path.size();
    for (int k = 0; k < 10; ++k) {
      const double depth = std::pow(10.0, rng.uniform(-4.5, -2.5));
      geometry::PoseVector moved = geometry::pose_vector(pose);
      for (std::size_t d = 0; d < 6; ++d) moved[d] += rng.uniform(-1.0, 1.0) * (d < 3 ? 0.003 : 0.04);
      const Pose other = geometry::pose_from(moved);
      const double between = largest_displacement(mesh, pose, other) + 1e-9;
      for (std::size_t body = 0; body < motion.path.bodies(); ++body) {
        const std::size_t certain = contact.first_certain_contact(motion.path, body, pose, depth, from, to);
        const std::size_t possible = contact.first_possible_contact(motion.path, body, pose, depth, from, to);
        EXPECT_LE(possible, certain);
        EXPECT_LE(contact.first_possible_contact(motion.path, body, other, depth - between, from, to), certain);
        const std::size_t within = contact.first_possible_contact(motion.path, body, pose, -between, from, to);
        EXPECT_GE(within, contact.first_within(motion.path, pose, between, from).value_or(to));
        deep += certain < to;
        nearer += within < possible;
      }
    }
  }
  EXPECT_GT(nearer, 10);
  if (!scene().target.solids.empty()) {
    EXPECT_GT(deep, 10);
  }
}

INSTANTIATE_TEST_SUITE_P(, IntervalLaw, testing::Range(0, 11),
                         [](const auto& scene) { return name_of_pairing(scene.param); });

}  // namespace
}  // namespace tactus::test
