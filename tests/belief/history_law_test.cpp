// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "belief/plain_world.hpp"

/// A correct observation never removes the true pose: random actions at random true poses, seen by a world that shares
/// no contact code with the library.
namespace tactus::test {
namespace {

using belief::Belief;
using belief::Kind;
using belief::Phase;
using support::Rng;

struct Case {
  const char* name;
  Kind kind;
  SmallTask small;
  int episodes;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

class HistoryLaw : public ::testing::TestWithParam<Case> {};

/// Every voxel centre inside the target is possibly occupied.
void expect_voxels_of(const Belief& belief, const PlainWorld& world) {
  const auto& grid = belief.voxels().model().grid;
  for (std::size_t v = 0; v < grid.size(); ++v) {
    if (belief.voxels().possibly_occupied().test(v)) continue;
    ASSERT_FALSE(world.holds(grid.centre(v))) << "voxel " << v << " was removed";
  }
}

/// Roll, pitch and yaw being those that the pose was made from, comparing the numbers will do.
bool is_in_a_cell(const Belief& belief, const PoseVector& truth) {
  const auto& cells = belief.cells().cells();
  return std::any_of(cells.begin(), cells.end(), [&](const belief::Cell& cell) {
    const PoseVector half = belief.cells().half_width(cell);
    for (std::size_t d = 0; d < 6; ++d)
      if (std::abs(truth[d] - cell.centre[d]) > half[d] + 1e-9) return false;
    return true;
  });
}

void expect_holds(const Belief& belief, const PlainWorld& world, const PoseVector& truth) {
  ASSERT_EQ(belief.health(), belief::Health::good);
  if (belief.phase() == Phase::voxels) {
    ASSERT_NO_FATAL_FAILURE(expect_voxels_of(belief, world));
  } else {
    ASSERT_TRUE(is_in_a_cell(belief, truth)) << belief.cells().cells().size() << " cells";
  }
  ASSERT_TRUE(belief.contains(geometry::pose_from(truth)));
}

/// The history, and only what was possible in it.
void expect_reproduced(const Belief& belief, const Pose& truth) {
  for (const belief::Trace& trace : belief.history()) {
    ASSERT_TRUE(belief::reproduces(belief.task(), trace, truth));
    for (const double radius : {0.0, 1e-4, 0.002, 0.01})
      ASSERT_TRUE(belief::may_reproduce(belief.task(), trace, truth, radius)) << radius;
  }
}

action::Action choose(const Belief& belief, action::ActionLibrary& library, const Pose& truth, Rng& rng) {
  if (rng.below(8) == 0) return insertion_at(belief.task(), library, belief.configuration(), truth);
  return random_action(belief.task(), library, belief.configuration(), rng);
}

TEST_P(HistoryLaw, ACorrectObservationNeverRemovesTheTruth) {
  const auto model = small_model(GetParam().kind, GetParam().small);
  const action::Task& task = *model->task;
  action::ActionLibrary library(task);
  Rng rng(7);
  int contacts = 0, misses = 0, in_voxels = 0, in_poses = 0;
  for (int episode = 0; episode < GetParam().episodes; ++episode) {
    const PoseVector truth = random_pose(task.scene().prior, rng);
    const Pose base_from_target = geometry::pose_from(truth);
    const PlainWorld world(task, base_from_target);
    Belief belief(model, task.scene().start);
    for (int i = 0; i < 12; ++i) {
      const action::Action action = choose(belief, library, base_from_target, rng);
      const double overshoot = rng.below(2) == 0 ? 0.0 : rng.uniform(0.0, 0.0009),
                   halt = rng.below(4) == 0 ? rng.uniform() : 1.0;
      const belief::Observation seen = world.execute(action, overshoot, halt);
      belief.step(action, seen);
      ASSERT_NO_FATAL_FAILURE(expect_holds(belief, world, truth))
          << "episode " << episode << ", action " << i << ", contact " << seen.contact;
      ++(seen.contact ? contacts : misses);
      ++(belief.phase() == Phase::voxels ? in_voxels : in_poses);
    }
    ASSERT_EQ(belief.history().size(), 12u);
    ASSERT_NO_FATAL_FAILURE(expect_reproduced(belief, base_from_target)) << "episode " << episode;
  }
  EXPECT_GT(contacts, 2 * GetParam().episodes);
  EXPECT_GT(misses, 2 * GetParam().episodes);
  if (GetParam().kind == Kind::hierarchical) {
    EXPECT_GT(in_voxels, 0);
  }
  if (GetParam().small.delta > 0) {
    EXPECT_GT(in_poses, GetParam().episodes);
  }
}

INSTANTIATE_TEST_SUITE_P(
    EveryKind, HistoryLaw,
    ::testing::Values(
        Case{"voxels", Kind::hierarchical, {.delta = 0}, 12},
        Case{"coarse_voxels", Kind::hierarchical, {.voxel_size = 0.009, .delta = 0}, 8},
        Case{"hand_over",
             Kind::hierarchical,
             {.roll_width = 0.6, .position_width = 0.06, .delta = 1900, .most_cells = 200},
             6},
        Case{"cells", Kind::particles, {.roll_width = 0.6, .position_width = 0.06, .most_cells = 300}, 3},
        Case{"fine_cells", Kind::particles, {.roll_width = 0.2, .position_width = 0.02, .most_cells = 150}, 3}),
    [](const auto& chosen) { return chosen.param.name; });

}  // namespace
}  // namespace tactus::test
