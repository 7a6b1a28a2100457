// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scene.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "belief/small_task.hpp"

namespace tactus::test {
namespace {

using scene::Scene;
using support::Rng;

constexpr double pi = std::numbers::pi;

/// A scene whose prior is free in some dimensions, about anywhere, with an approach axis anyhow.
Scene random_scene(Rng& rng) {
  Scene scene = small_scene();
  for (std::size_t d = 0; d < 6; ++d) {
    scene.prior.centre[d] = rng.uniform(-1.0, 1.0);
    scene.prior.width[d] = rng.below(2) == 0 ? 0.0 : rng.uniform(0.0, d < 3 ? 0.2 : rng.below(4) == 0 ? 2.0 * pi : 0.6);
  }
  scene.target.approach_axis = Vector3(rng.normal(), rng.normal(), rng.normal()).normalized();
  scene.target.target_from_seated = {
      geometry::pose_from({0.01, 0.02, -0.03, rng.uniform(-3, 3), rng.uniform(-1, 1), rng.uniform(-3, 3)})};
  return scene;
}

TEST(TargetRegion, HoldsEveryPointOfTheTargetAtEveryPoseOfThePrior) {
  Rng rng(1);
  for (int i = 0; i < 25; ++i) {
    const Scene scene = random_scene(rng);
    const Pose frame_from_base =
        geometry::pose_from({0.1, 0.2, 0.3, rng.uniform(-3, 3), rng.uniform(-1, 1), rng.uniform(-3, 3)});
    const geometry::Box region = scene::target_region(scene, frame_from_base).inflated(1e-9);
    for (int k = 0; k < 400; ++k) {
      const Pose frame_from_target = frame_from_base * geometry::pose_from(random_pose(scene.prior, rng));
      for (const Vector3& p : scene.target.mesh.vertices) ASSERT_TRUE(region.contains(frame_from_target * p));
    }
  }
}

TEST(TargetRegion, IsTightWithoutTurns) {
  Scene scene = small_scene({.roll_width = 0.0});
  scene.prior.centre[3] = 0.0;
  const geometry::Box region = scene::target_region(scene, Pose::Identity());
  EXPECT_TRUE(region.low.isApprox(Vector3(0.438, -0.058, -0.048), 1e-9));
  EXPECT_TRUE(region.high.isApprox(Vector3(0.462, 0.058, 0.068), 1e-9));
}

TEST(SearchFrame, HasItsAxisAlongTheApproachAndItsOriginAtTheCentralTarget) {
  Rng rng(2);
  for (int i = 0; i < 25; ++i) {
    const Scene scene = random_scene(rng);
    const scene::SearchFrame frame = scene::search_frame(scene, 0.03);
    const Pose target = scene.prior.central_pose();
    EXPECT_TRUE(frame.base_from_search.linear().isUnitary(1e-9));
    EXPECT_NEAR(frame.base_from_search.linear().determinant(), 1.0, 1e-9);
    EXPECT_TRUE(frame.base_from_search.translation().isApprox(target.translation()));
    EXPECT_TRUE(frame.base_from_search.linear().col(2).isApprox(target.linear() * scene.target.approach_axis));
    const Pose placed = frame.base_from_tool({0.0, 0.0, frame.standoff});
    EXPECT_LT(geometry::angle_between(placed, scene.seated(target)), 1e-6);
    EXPECT_LT(geometry::angle_between(frame.base_from_tool({0, 0, 0}, 0.4), placed) - 0.4, 1e-6);
  }
}

TEST(SearchFrame, TheToolAtStandoffIsClearOfTheRegion) {
  Rng rng(3);
  for (int i = 0; i < 25; ++i) {
    const Scene scene = random_scene(rng);
    const scene::SearchFrame frame = scene::search_frame(scene, 0.03);
    const Pose search_from_tool =
        frame.base_from_search.inverse() * frame.base_from_tool({0.01, -0.02, frame.standoff});
    double nearest = 1e300;
    for (const Vector3& p : scene.tool.vertices)
      nearest = std::min(nearest, frame.region.low.z() - (search_from_tool * p).z());
    EXPECT_NEAR(nearest, 0.03, 1e-9);
    for (const Vector3& p : scene.tool.vertices)
      EXPECT_TRUE(frame.tool_extent.inflated(1e-9).contains(frame.search_from_tool * p));
  }
}

TEST(Seated, IsWithinTheToleranceAndNotBeyond) {
  Rng rng(4);
  const Scene scene = small_scene();
  for (int i = 0; i < 50; ++i) {
    const Pose target = scene.prior.sample(rng), seated = scene.seated(target);
    EXPECT_TRUE(scene.is_seated(seated, target));
    const Vector3 direction = Vector3(rng.normal(), rng.normal(), rng.normal()).normalized();
    Pose off = seated;
    off.translation() += 0.99 * scene.target.position_tolerance * direction;
    EXPECT_TRUE(scene.is_seated(off, target));
    off.translation() += 0.02 * scene.target.position_tolerance * direction;
    EXPECT_FALSE(scene.is_seated(off, target));
    EXPECT_TRUE(scene.is_seated(seated * Eigen::AngleAxisd(0.99 * scene.target.angle_tolerance, direction), target));
    EXPECT_FALSE(scene.is_seated(seated * Eigen::AngleAxisd(1.01 * scene.target.angle_tolerance, direction), target));
  }
}

TEST(Seated, IsAtAnyOfTheSeats) {
  Rng rng(5);
  Scene scene = small_scene();
  const Pose first = scene.target.target_from_seated.front();
  const Pose second = geometry::pose_from({0, 0, 0, pi, 0, 0}) * first;
  for (int i = 0; i < 20; ++i) {
    const Pose target = scene.prior.sample(rng);
    scene.target.target_from_seated = {first};
    EXPECT_FALSE(scene.is_seated(target * second, target));
    scene.target.target_from_seated = {first, second};
    EXPECT_TRUE(scene.is_seated(scene.seated(target, 0), target));
    EXPECT_TRUE(scene.is_seated(scene.seated(target, 1), target));
    EXPECT_FALSE(scene.is_seated(target * geometry::pose_from({0, 0, 0, 0.5 * pi, 0, 0}) * first, target));
  }
}

TEST(Seated, IsAtOneSeatForAllOfACell) {
  Scene scene = small_scene();
  const Pose first = scene.target.target_from_seated.front(), target = scene.prior.central_pose();
  const double apart = 1.5 * scene.target.angle_tolerance;
  scene.target.target_from_seated = {first, geometry::pose_from({0, 0, 0, apart, 0, 0}) * first};
  const Pose between = target * geometry::pose_from({0, 0, 0, 0.5 * apart, 0, 0}) * first;
  EXPECT_TRUE(scene.is_seated(between, target));
  EXPECT_TRUE(scene.is_seated(between, target, {0, 0, 0, 0.2 * scene.target.angle_tolerance, 0, 0}));
  EXPECT_FALSE(scene.is_seated(between, target, {0, 0, 0, 0.3 * scene.target.angle_tolerance, 0, 0}));
  EXPECT_TRUE(scene.is_seated(scene.seated(target, 1), target, {0, 0, 0, 0.9 * scene.target.angle_tolerance, 0, 0}));
}

}  // namespace
}  // namespace tactus::test
