// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "action/primitives.hpp"
#include "action/probes.hpp"
#include "belief/episode.hpp"
#include "scenario/scenario.hpp"
#include "support/error.hpp"

/// Tables of contact tell a grid of cells what asking each cell would, of motions from site to site.
namespace tactus::test {
namespace {

using belief::CellGrid;
using belief::CellShape;
using belief::CellTables;
using belief::Trace;
using support::Rng;

const action::Task& task() {
  static const auto made = small_task({.roll_width = 0.4, .position_width = 0.06});
  return *made;
}

CellShape shape() { return belief::CellBelief::shape(task().scene().prior, {}); }

/// Through the region along an axis of the base, from site to site, with the tool as it is at the prior's middle.
action::Action random_site_action(Rng& rng) {
  for (;;) {
    const scene::SearchFrame& frame = task().frame();
    Vector3 position;
    for (int d = 0; d < 3; ++d) position[d] = rng.uniform(frame.region.low[d] - 0.02, frame.region.high[d] + 0.02);
    Pose from = frame.base_from_tool(position);
    from.translation() = task().options().sites->nearest(from.translation());
    Pose to = from;
    to.translation()[static_cast<int>(rng.below(3))] += rng.below(2) == 0 ? 0.06 : -0.06;
    const auto start = task().posture(from, task().home());
    if (!start) continue;
    const auto path = task().straight_path(*start, task().at_site(from, to), 0.004);
    if (path) return action_along(task(), *path);
  }
}

Trace observed(const action::Action& action, const PoseVector& truth) {
  const belief::Observation seen = PlainWorld(task(), geometry::pose_from(truth)).execute(action);
  return belief::trace_of(task(), action, seen, belief::locate(task(), action, seen));
}

TEST(CellTables, TellWhatEveryCellWouldBeTold) {
  Rng rng(1);
  const CellTables tables(task(), shape());
  const double radius = scene::cell_radius(shape().half, task().target_reach());
  std::size_t dropped = 0, kept = 0, differing = 0;
  for (int i = 0; i < 12; ++i) {
    const Trace trace = observed(random_site_action(rng), random_pose(task().scene().prior, rng));
    CellGrid grid(shape(), task().target_reach());
    grid.sift(task(), {&trace}, {}, &tables);
    for (std::size_t cell = 0; cell < grid.members().size(); ++cell) {
      const Pose pose = geometry::pose_from(grid.centre(cell));
      const bool may = belief::may_reproduce(task(), trace, pose, radius), is_member = grid.members().test(cell);
      ++(is_member ? kept : dropped);
      differing += may != is_member;
      if (is_member || !may) continue;
      for (int draw = 0; draw < 20; ++draw) {
        PoseVector v = grid.centre(cell);
        for (std::size_t d = 0; d < 6; ++d) v[d] += shape().half[d] * rng.uniform(-1.0, 1.0);
        ASSERT_FALSE(belief::reproduces(task(), trace, geometry::pose_from(v)));
      }
    }
  }
  EXPECT_GT(dropped, 2000u);
  EXPECT_GT(kept, 2000u);
  EXPECT_LT(differing, (dropped + kept) / 200);
}

/// Whatever the robot does: from site to site, off them, turned, with links near the target.
TEST(CellTables, NeverDropTheCellOfTheTruth) {
  Rng rng(2);
  const CellTables tables(task(), shape());
  action::ActionLibrary library(task());
  int touched = 0;
  for (int i = 0; i < 90; ++i) {
    const PoseVector truth = random_pose(task().scene().prior, rng);
    const action::Action action =
        i % 3 == 0 ? random_action(task(), library, task().home(), rng) : random_site_action(rng);
    const Trace trace = observed(action, truth);
    if (!belief::reproduces(task(), trace, geometry::pose_from(truth))) continue;  // it set out in the target
    CellGrid grid(shape(), task().target_reach());
    grid.sift(task(), {&trace}, {}, &tables);
    ASSERT_TRUE(grid.holds(geometry::pose_from(truth), 1e-9)) << i;
    touched += trace.contact;
  }
  EXPECT_GT(touched, 5);
}

/// Unless a link may be near the target.
TEST(CellTables, LeaveNothingToAskOfAFreeMotionFromSiteToSite) {
  Rng rng(3);
  const CellTables tables(task(), shape());
  int answered = 0;
  for (int i = 0; i < 20; ++i) {
    Trace trace = observed(random_site_action(rng), random_pose(task().scene().prior, rng));
    const Trace rest = tables.rest(trace);
    EXPECT_EQ(rest.contact, trace.contact);
    EXPECT_EQ(rest.path.size() - rest.touch, trace.path.size() - trace.touch);
    EXPECT_LE(rest.touch, trace.touch);
    answered += rest.path.empty();
  }
  EXPECT_GT(answered, 3);
}

TEST(CellTables, RestoredOnesAreThoseSavedAndNoOthersAreTaken) {
  Rng rng(4);
  const CellTables saved(task(), shape()), restored(task(), shape());
  const Trace trace = observed(random_site_action(rng), random_pose(task().scene().prior, rng));
  CellGrid grid(shape(), task().target_reach());
  grid.sift(task(), {&trace}, {}, &saved);
  const std::vector<std::uint8_t> bytes = saved.save();
  restored.restore(bytes.data(), bytes.size());
  EXPECT_EQ(restored.save(), bytes);
  EXPECT_GT(restored.bytes(), 0u);
  const CellTables other(task(), belief::cell_shape(task().scene().prior, 0.005, 0.1, 1u << 20));
  EXPECT_THROW(other.restore(bytes.data(), bytes.size()), support::Error);
}

/// Of the shelf: what is planned with goes from site to site.
TEST(CellTables, KnowMostMotionsOfALibrary) {
  const auto shelf = scenario::load(TACTUS_SOURCE_DIR "/examples/scenarios/shelf_3d.yaml");
  const action::Task& on_shelf = *shelf->task;
  const CellTables& tables = *shelf->model->options.cells.tables;
  int known = 0, all = 0;
  const auto count = [&](const std::vector<action::MotionPtr>& motions) {
    for (const action::MotionPtr& motion : motions) {
      Trace trace;
      trace.path = motion->path;
      trace.touch = motion->path.size();
      trace.bodies = motion->bodies;
      known += tables.rest(trace).path.empty();
      ++all;
    }
  };
  const std::vector<action::MotionPtr> probes = action::probes(on_shelf, on_shelf.frame().region, on_shelf.home());
  count(probes);
  count(action::primitives(on_shelf, probes.front()->path[probes.front()->path.size() / 2]));
  RecordProperty("motions", all);
  RecordProperty("known", known);
  EXPECT_GT(all, 30);
  EXPECT_GT(known, all * 4 / 5);
}

/// Up to 5 mm into the target by its waypoints, which may be 6 mm off: on sites, and just beside them.
TEST(CellTables, AreNotAskedForARobotThatMayBeFartherOffThanTheyWereMadeFor) {
  const auto model = small_model(belief::Kind::particles);
  const action::Task& task = *model->task;
  const Vector3 end = task.options().sites->nearest({0.4266, 0.012, 0.01});
  for (const double beside : {0.0, 0.00004})
    for (int i = -10; i < 10; ++i) {
      const Pose truth = geometry::pose_from({0.45, 0.0005 * i, 0.01, 0.1, 0.0, 0.0});
      std::vector<JointVector> path;
      for (int k = 8; k >= 0; --k) path.push_back(joints({end.x() - 0.004 * k, end.y() + beside, end.z(), 0.1, 0, 0}));
      action::Action action = action_along(task, path);
      action.sensing.encoder_error = 0.006;
      belief::Belief belief(model, task.scene().start);
      belief.step(action, {false, action.path.back()});
      ASSERT_TRUE(belief::reproduces(task, belief.history(), truth)) << i;
      EXPECT_TRUE(belief.contains(truth)) << i << " beside its sites by " << beside;
    }
}

}  // namespace
}  // namespace tactus::test
