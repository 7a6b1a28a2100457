// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "contact/contact_cases.hpp"

/// How far the bodies of a robot go along a path.
namespace tactus::test {
namespace {

TEST(BodyPath, NoPointMovesFartherThanTravelled) {
  Rng rng(3);
  const Scene& scene = scene_of(0);
  for (int m = 0; m < 60; ++m) {
    const Motion motion(scene, random_waypoints(rng));
    const std::size_t n = motion.path.size();
    for (std::size_t b = 0; b < scene.arm.parts.size(); ++b)
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j)
          ASSERT_LE(
              largest_displacement(scene.arm.parts[b].shape.mesh(), motion.track[i][b].pose, motion.track[j][b].pose),
              motion.path.travelled(j, b) - motion.path.travelled(i, b) + 1e-12);
  }
}

TEST(BodyPath, TravelledIsTheLengthOfAWayWithoutTurns) {
  const Scene& scene = scene_of(0);
  JointVector from = JointVector::Zero(5), to = from;
  to.head<3>() << 0.03, -0.04, 0.12;
  const BodyPath path(scene.contact.bodies(), {from, 0.5 * (from + to), to});
  for (std::size_t b = 0; b < 2; ++b) EXPECT_NEAR(path.travelled(2, b), 0.13, 1e-12);
  EXPECT_NEAR(path.travelled(2, 2), 0.03, 1e-12) << "the beam moves along x only";
}

}  // namespace
}  // namespace tactus::test
