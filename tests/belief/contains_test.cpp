// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "belief/plain_world.hpp"

/// Which poses a belief holds.
namespace tactus::test {
namespace {

using belief::Belief;
using belief::Kind;
using support::Rng;

constexpr double pi = std::numbers::pi;

/// A belief about such a prior, with the pin going in along the base's x axis however the target's frame stands.
Belief about(const PoseVector& centre, const PoseVector& width) {
  scene::Scene scene = small_scene();
  scene.prior = {centre, width};
  const Eigen::Matrix3d target_from_base = scene.prior.central_pose().linear().transpose();
  scene.target.approach_axis = target_from_base * Vector3::UnitX();
  scene.target.target_from_seated.front().linear() = target_from_base;
  scene.target.target_from_seated.front().translation() = -0.013 * scene.target.approach_axis;
  const auto task = std::make_shared<const action::Task>(scene, action::TaskOptions{});
  return Belief(small_model(task, Kind::particles, {.most_cells = 0}), scene.start);
}

TEST(Contains, ThePriorAndNothingElse) {
  Rng rng(1);
  const auto model = small_model(Kind::particles);
  const Belief belief(model, model->task->scene().start);
  for (int i = 0; i < 200; ++i) {
    PoseVector v = random_pose(model->task->scene().prior, rng);
    EXPECT_TRUE(belief.contains(geometry::pose_from(v)));
    v[3] += 2.0 * pi;
    EXPECT_TRUE(belief.contains(geometry::pose_from(v)));
    const std::size_t d = rng.below(6);
    v[d] += (rng.below(2) == 0 ? 1.0 : -1.0) * (model->task->scene().prior.width[d] + 1e-6);
    EXPECT_FALSE(belief.contains(geometry::pose_from(v))) << "dimension " << d;
  }
}

TEST(Contains, EveryCornerOfThePrior) {
  const auto model = small_model(Kind::particles);
  const scene::Prior& prior = model->task->scene().prior;
  const Belief belief(model, model->task->scene().start);
  for (unsigned corner = 0; corner < 64; ++corner) {
    PoseVector v = prior.centre;
    for (std::size_t d = 0; d < 6; ++d) v[d] += prior.width[d] * ((corner >> d & 1u) != 0 ? 0.5 : -0.5);
    EXPECT_TRUE(belief.contains(geometry::pose_from(v)));
  }
}

TEST(Contains, APoseWhosePitchIsPastAQuarterTurn) {
  Rng rng(2);
  const PoseVector centre{0.45, 0.0, 0.0, 0.1, pi - 0.05, 0.0};
  const Belief belief = about(centre, {0.0, 0.01, 0.0, 0.1, 0.1, 0.0});
  for (int i = 0; i < 100; ++i)
    EXPECT_TRUE(belief.contains(geometry::pose_from(random_pose(belief.task().scene().prior, rng))));
  PoseVector other = centre;
  other[4] += 0.2;
  EXPECT_FALSE(belief.contains(geometry::pose_from(other)));
}

TEST(Contains, APoseAtAQuarterTurnOfPitchHoweverRollAndYawShareTheRest) {
  Rng rng(3);
  for (const double pitch : {0.5 * pi, -0.5 * pi}) {
    const PoseVector centre{0.45, 0.0, 0.0, 0.7, pitch, -0.4}, width{0.0, 0.01, 0.0, 0.1, 0.0, 0.1};
    const Belief belief = about(centre, width);
    for (int i = 0; i < 200; ++i) {
      PoseVector v = random_pose(belief.task().scene().prior, rng);
      EXPECT_TRUE(belief.contains(geometry::pose_from(v)));
      v[3] += pitch > 0.0 ? -0.3 : 0.3;
      EXPECT_FALSE(belief.contains(geometry::pose_from(v)));
    }
    PoseVector corner = centre;
    corner[3] += 0.05, corner[5] += pitch > 0.0 ? -0.05 : 0.05;
    EXPECT_TRUE(belief.contains(geometry::pose_from(corner)));
  }
}

TEST(Contains, AfterAMissTheVoxelPhaseHoldsJustWhatLeavesTheSweptVoxelsFree) {
  const auto model = small_model(Kind::hierarchical, {.delta = 0});
  const action::Task& task = *model->task;
  action::ActionLibrary library(task);
  Rng rng(4);
  Belief belief(model, task.scene().start);
  for (int i = 0; i < 3; ++i) {
    const action::Action action = random_action(task, library, belief.configuration(), rng);
    belief.step(action, {false, action.path.back()});
  }
  const auto& voxels = belief.voxels();
  int held = 0, out = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose pose = geometry::pose_from(random_pose(task.scene().prior, rng));
    const PlainWorld world(task, pose);
    bool fits = true;
    for (std::size_t v = 0; v < voxels.model().grid.size(); ++v)
      fits = fits && (voxels.possibly_occupied().test(v) || !world.holds(voxels.model().grid.centre(v)));
    EXPECT_EQ(belief.contains(pose), fits);
    ++(fits ? held : out);
  }
  EXPECT_GT(held, 10);
  EXPECT_GT(out, 10);
}

TEST(Contains, NoPoseThatIsNotFinite) {
  for (const Kind kind : {Kind::hierarchical, Kind::particles}) {
    const auto model = small_model(kind);
    Pose pose = model->task->scene().prior.central_pose();
    const Belief belief(model, model->task->scene().start);
    ASSERT_TRUE(belief.contains(pose));
    pose.translation().y() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(belief.contains(pose));
  }
}

}  // namespace
}  // namespace tactus::test
