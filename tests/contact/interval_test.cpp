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

INSTANTIATE_TEST_SUITE_P(, IntervalLaw, testing::Range(0, 11),
                         [](const auto& scene) { return name_of_pairing(scene.param); });

}  // namespace
}  // namespace tactus::test
