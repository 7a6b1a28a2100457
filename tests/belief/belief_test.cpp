// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>

#include "belief/plain_world.hpp"
#include "support/error.hpp"

/// A belief from its making to the goal.
namespace tactus::test {
namespace {

using belief::Belief;
using belief::Health;
using belief::Kind;
using belief::Phase;
using support::Status;

const std::shared_ptr<const action::Task>& task() {
  static const auto made = small_task({.roll_width = 0.1, .position_width = 0.02});
  return made;
}

std::shared_ptr<const belief::Model> model(Kind kind, std::size_t delta = 1500) {
  return small_model(task(), kind, {.roll_width = 0.1, .position_width = 0.02, .delta = delta, .most_cells = 300});
}

Status status_of(const std::shared_ptr<const belief::Model>& model, const JointVector& q) {
  try {
    Belief belief(model, q);
  } catch (const support::Error& error) {
    EXPECT_NE(std::string(error.what()).find("q"), std::string::npos);
    return error.status();
  }
  return Status::ok;
}

/// A contact in mid-air, far in front of anything.
void touch_nothing(Belief& belief) {
  const action::Action action =
      action_along(*task(), {belief.configuration(), belief.configuration() - joints({0.004, 0, 0, 0, 0, 0}),
                             belief.configuration() - joints({0.008, 0, 0, 0, 0, 0})});
  belief.step(action, {true, action.path.back()});
}

TEST(Belief, StandsAtFreeConfigurationsOnly) {
  const auto m = model(Kind::hierarchical);
  JointVector q = task()->scene().start;
  EXPECT_EQ(status_of(m, q), Status::ok);
  EXPECT_EQ(status_of(m, joints({0, 0})), Status::invalid_argument);
  q[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(status_of(m, q), Status::invalid_argument);
  EXPECT_EQ(status_of(m, joints({0.46, 0.125, 0, 0, 0, 0})), Status::start_in_collision);
  EXPECT_EQ(status_of(m, joints({9, 0, 0, 0, 0, 0})), Status::start_in_collision);
}

TEST(Belief, FollowsAJogAndStaysPutForABadOne) {
  Belief belief(model(Kind::hierarchical), task()->scene().start);
  const JointVector q = joints({0.33, 0.0, 0.0, 0.2, 0.0, 0.0});
  belief.set_configuration(q);
  EXPECT_EQ(belief.configuration(), q);
  EXPECT_THROW(belief.set_configuration(joints({0.46, 0.125, 0, 0, 0, 0})), support::Error);
  EXPECT_EQ(belief.configuration(), q);
}

TEST(Belief, CopiesAreIndependent) {
  const Belief first(model(Kind::particles), task()->scene().start);
  Belief second = first;
  const auto before = first.save();
  touch_nothing(second);
  EXPECT_EQ(first.save(), before);
}

TEST(Belief, AContactInEmptyAirSetsTheHealthAndIsDoubted) {
  for (const Kind kind : {Kind::hierarchical, Kind::particles}) {
    Belief belief(model(kind), task()->scene().start);
    action::ActionLibrary library(*task());
    const PlainWorld world(*task(), task()->scene().prior.central_pose());
    support::Rng rng(5);
    const action::Action action = random_action(*task(), library, belief.configuration(), rng);
    belief.step(action, world.execute(action));
    ASSERT_EQ(belief.health(), Health::good);
    belief.set_configuration(task()->scene().start);
    const belief::Summary before = belief.summary();
    touch_nothing(belief);
    const belief::Summary after = belief.summary();
    EXPECT_EQ(belief.health(), Health::contradicted);
    EXPECT_EQ(after.phase, belief::Phase::poses);
    EXPECT_EQ(after.observations, before.observations + 1);
    EXPECT_FALSE(belief.history().front().doubted);
    EXPECT_TRUE(belief.history().back().doubted);
    EXPECT_GT(after.cells, 0u);
    EXPECT_NEAR(after.bits, before.bits, 2.0);
    for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(after.mean[d], before.mean[d], 0.01);
    EXPECT_TRUE(belief.contains(task()->scene().prior.central_pose()));
  }
}

/// A contact that was none, among others that were: the belief loses the truth, notices, and finds it again. Which one
/// it was can be told in most cases.
TEST(Belief, DoubtsTheOneObservationThatContradictsTheRest) {
  support::Rng rng(21);
  int noticed = 0, right = 0;
  for (int episode = 0; episode < 12; ++episode) {
    const Kind kind = episode % 2 == 0 ? Kind::hierarchical : Kind::particles;
    Belief belief(model(kind), task()->scene().start);
    action::ActionLibrary library(*task());
    const PoseVector truth = random_pose(task()->scene().prior, rng);
    const PlainWorld world(*task(), geometry::pose_from(truth));
    for (int i = 0; i < 12; ++i) {
      const action::Action action = random_action(*task(), library, belief.configuration(), rng);
      belief::Observation seen = world.execute(action, 0.0, i == 3 ? 0.7 : 1.0);
      if (i == 3) seen.contact = true;
      belief.step(action, seen);
      ASSERT_GT(belief.summary().cells + belief.summary().possibly_occupied, 0u);
    }
    ASSERT_EQ(belief.history().size(), 12u);
    if (belief.health() == Health::good) continue;
    ++noticed;
    EXPECT_TRUE(belief.contains(geometry::pose_from(truth)));
    right += belief.history()[3].doubted;
  }
  EXPECT_GE(noticed, 4);
  EXPECT_GE(4 * right, 3 * noticed);
}

TEST(Belief, ATargetThatIsNowhereIsAContradiction) {
  Belief belief(model(Kind::particles), task()->scene().start);
  const geometry::Box region = task()->frame().region;
  for (int i = 0; i < 60 && belief.health() == Health::good;
       ++i) {  // rake through all of the region in rows, feeling nothing
    const double z = region.low.y() + i / 10 * 0.02;
    const double deep = 0.46, y = (i / 2 % 5 - 2) * 0.02;
    const action::Action action =
        action_along(*task(), {joints({deep, y, z, 0, 0, 0}), joints({deep, y + 0.004, z, 0, 0, 0})});
    belief.step(action, {false, action.path.back()});
  }
  EXPECT_EQ(belief.health(), Health::contradicted);
  EXPECT_GT(belief.cells().size(), 0u);
}

TEST(Goal, IsNotReachedAtFullDepthInEmptyAir) {
  for (const Kind kind : {Kind::hierarchical, Kind::particles}) {
    Belief belief(model(kind, 0), task()->scene().start);
    action::ActionLibrary library(*task());
    EXPECT_FALSE(belief.is_goal());
    PoseVector aside = task()->scene().prior.centre;
    aside[1] += 0.055;  // where no target of the prior is
    const action::Action action = insertion_at(*task(), library, belief.configuration(), geometry::pose_from(aside));
    belief.step(action, {false, action.path.back()});
    EXPECT_EQ(belief.health(), Health::good);
    EXPECT_FALSE(belief.is_goal());
  }
}

TEST(Goal, IsReachedSeatedAndNotBefore) {
  support::Rng rng(6);
  for (const Kind kind : {Kind::hierarchical, Kind::particles})
    for (int episode = 0; episode < 2; ++episode) {
      const Pose truth = geometry::pose_from(random_pose(task()->scene().prior, rng));
      const PlainWorld world(*task(), truth);
      Belief belief(model(kind, 100000), task()->scene().start);
      action::ActionLibrary library(*task());
      EXPECT_FALSE(belief.is_goal());
      const action::Action action = insertion_at(*task(), library, belief.configuration(), truth);
      const belief::Observation seen = world.execute(action);
      ASSERT_FALSE(seen.contact);
      belief.step(action, seen);
      EXPECT_EQ(belief.phase(), Phase::poses);
      ASSERT_EQ(belief.health(), Health::good);
      EXPECT_TRUE(belief.is_goal());
      const JointVector q = belief.configuration();
      belief.set_configuration(task()->scene().start);
      EXPECT_FALSE(belief.is_goal());
      belief.set_configuration(q);
      EXPECT_TRUE(belief.is_goal());
    }
}

TEST(Goal, NeedsEveryPoseOfEveryCellSeated) {
  Belief belief(small_model(task(), Kind::particles, {.most_cells = 0}), task()->scene().start);
  action::ActionLibrary library(*task());
  const Pose central = task()->scene().prior.central_pose();
  const action::Action action = insertion_at(*task(), library, belief.configuration(), central);
  belief.set_configuration(action.path.back());
  EXPECT_FALSE(belief.is_goal()) << "the cells' centres are seated, but nothing has been felt yet";
}

TEST(Goal, ABoxOfPosesIsSeatedOnlyIfEachPoseInItIs) {
  support::Rng rng(7);
  const scene::Scene& scene = task()->scene();
  const Pose base_from_tool = scene.seated(scene.prior.central_pose());
  int seated = 0;
  for (int i = 0; i < 400; ++i) {
    PoseVector centre = scene.prior.centre, half{};
    for (std::size_t d = 0; d < 6; ++d) {
      centre[d] += rng.uniform(-1.0, 1.0) * (d < 3 ? 0.002 : 0.05);
      half[d] = rng.uniform() * (d < 3 ? 0.002 : 0.05);
    }
    if (!scene.is_seated(base_from_tool, geometry::pose_from(centre), half)) continue;
    ++seated;
    for (std::size_t d = 0; d < 6; ++d) centre[d] += half[d] * rng.uniform(-1.0, 1.0);
    EXPECT_TRUE(scene.is_seated(base_from_tool, geometry::pose_from(centre)));
  }
  EXPECT_GT(seated, 5);
}

TEST(HandOver, IsDoneAtCreationWhereThePriorIsSmall) {
  const Belief belief(model(Kind::hierarchical, 100000), task()->scene().start);
  EXPECT_EQ(belief.phase(), Phase::poses);
  EXPECT_TRUE(belief.contains(task()->scene().prior.central_pose()));
  EXPECT_EQ(Belief(model(Kind::hierarchical, 0), task()->scene().start).phase(), Phase::voxels);
}

TEST(Summary, SaysWhatIsLeft) {
  const belief::Summary voxels = Belief(model(Kind::hierarchical, 0), task()->scene().start).summary();
  EXPECT_EQ(voxels.phase, Phase::voxels);
  EXPECT_GT(voxels.possibly_occupied, 0u);
  EXPECT_NEAR(voxels.volume, static_cast<double>(voxels.possibly_occupied) * 0.005 * 0.005 * 0.005, 1e-12);
  EXPECT_EQ(voxels.cells, 0u);

  const belief::Summary cells = Belief(model(Kind::particles), task()->scene().start).summary();
  EXPECT_EQ(cells.phase, Phase::poses);
  EXPECT_GT(cells.cells, 0u);
  EXPECT_EQ(cells.possibly_occupied, 0u);
  const scene::Prior& prior = task()->scene().prior;
  for (std::size_t d = 0; d < 6; ++d) {
    EXPECT_NEAR(cells.mean[d], prior.centre[d], 1e-9);
    EXPECT_NEAR(cells.extent[d], prior.width[d], 1e-9);
    EXPECT_NEAR(cells.covariance[7 * d], prior.width[d] * prior.width[d] / 12.0, 1e-9);
  }
}

}  // namespace
}  // namespace tactus::test
