// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "contact/contact_cases.hpp"

/// The point of the robot that is deepest in the target, or nearest to it.
namespace tactus::test {
namespace {

using contact::Nearest;
using NearestLaw = ContactLaw;

constexpr double spacing = 0.002;  // m, of points on a triangle
constexpr double hardly = 0.0003;  // m
constexpr double exact = 0.01;     // m, below which its distance is

double signed_distance(const Placed& target, const Vector3& p) {
  const double distance = reference::surface_from_point(target, p);
  return reference::holds(*target.shape, target.pose.inverse() * p) ? -distance : distance;
}

/// Over points all over the robot: the least signed distance.
double plain_distance(const std::vector<Placed>& robot, const Placed& target) {
  double least = 1e300;
  for (const Placed& part : robot)
    for (const reference::Corners& t : part.triangles) {
      const double longest = std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
      const int count = static_cast<int>(std::ceil(longest / spacing));
      for (int i = 0; i <= count; ++i)
        for (int j = 0; i + j <= count; ++j) {
          const Vector3 p = t[0] + (t[1] - t[0]) * i / count + (t[2] - t[0]) * j / count;
          if ((p - target.ball.centre).norm() - target.ball.radius < std::max(0.0, least))
            least = std::min(least, signed_distance(target, p));
        }
    }
  return least;
}

TEST_P(NearestLaw, IsAPointOfTheRobotAndFewAreNearer) {
  int looked_at = 0, nearer = 0;
  for (int m = 0; m < 12; ++m) {
    const Motion motion(scene(), random_waypoints(rng));
    const Pose pose = pose_near_touching(scene(), motion, rng);
    const Placed target(scene().target, pose);
    for (std::size_t i = 0; i < motion.path.size(); ++i) {
      if (!reference::touches(motion.track[i], target, 0.003)) continue;
      const Nearest found = scene().contact.nearest(motion.path, i, pose);
      const Vector3 point = pose * found.point;
      double off = 1e300;
      for (const Placed& part : motion.track[i]) off = std::min(off, reference::surface_from_point(part, point));
      EXPECT_LT(off, 1e-6);
      if (found.distance < exact) {
        EXPECT_NEAR(found.distance, signed_distance(target, point), 1e-6);
      }
      nearer += plain_distance(motion.track[i], target) < found.distance - hardly;
      ++looked_at;
    }
  }
  RecordProperty("nearer", std::to_string(nearer) + " of " + std::to_string(looked_at));
  EXPECT_GT(looked_at, 15);
  EXPECT_LE(6 * nearer, looked_at);
}

INSTANTIATE_TEST_SUITE_P(, NearestLaw, testing::Range(0, 11),
                         [](const auto& scene) { return name_of_pairing(scene.param); });

}  // namespace
}  // namespace tactus::test
