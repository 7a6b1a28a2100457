// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "belief/plain_world.hpp"

/// The voxels of phase 1: what is swept goes, and what is too far from a contact goes.
namespace tactus::test {
namespace {

using belief::Bitset;
using belief::VoxelBelief;
using belief::VoxelGrid;
using support::Rng;

// A region large against the target, so that a contact says where the target is not.
const std::shared_ptr<const belief::Model>& model() {
  static const auto made = small_model(belief::Kind::hierarchical, {.position_width = 0.16, .delta = 0});
  return made;
}

const action::Task& task() { return *model()->task; }
const VoxelGrid& grid() { return model()->voxels->grid; }

belief::Trace observed(const PlainWorld& world, const action::Action& action) {
  const belief::Observation seen = world.execute(action);
  return belief::trace_of(task(), action, seen, belief::locate(task(), action, seen));
}

TEST(VoxelModel, TheGridHoldsEveryPointOfTheTarget) {
  Rng rng(1);
  for (int i = 0; i < 300; ++i) {
    const Pose pose = geometry::pose_from(random_pose(task().scene().prior, rng));
    for (const Vector3& p : task().scene().target.mesh.vertices) ASSERT_TRUE(grid().box().contains(pose * p));
  }
}

TEST(VoxelModel, CoverReachesAVoxelCentreInsideTheTargetFromEveryPointOfIt) {
  Rng rng(2);
  const geometry::Mesh& mesh = task().scene().target.mesh;
  for (int i = 0; i < 60; ++i) {
    const Pose pose = geometry::pose_from(random_pose(task().scene().prior, rng));
    const PlainWorld world(task(), pose);
    for (const Vector3& p : mesh.vertices) {
      double nearest = 1e300;
      for (std::size_t v = 0; v < grid().size(); ++v)
        if ((grid().centre(v) - pose * p).norm() < nearest && world.holds(grid().centre(v)))
          nearest = (grid().centre(v) - pose * p).norm();
      ASSERT_LE(nearest, model()->voxels->cover);
    }
  }
}

TEST(VoxelModel, InteriorPointsAreAsDeepAsTheySay) {
  const reference::Shape shape{{socket()}, {}};
  const reference::Placed placed(shape, Pose::Identity());
  ASSERT_FALSE(model()->voxels->interior.empty());
  double last = 1e300;
  for (const auto& interior : model()->voxels->interior) {
    ASSERT_TRUE(reference::holds(shape, interior.point));
    ASSERT_LE(interior.depth, reference::surface_from_point(placed, interior.point) + 1e-9);
    ASSERT_LE(interior.depth, last);
    last = interior.depth;
  }
}

TEST(DistanceTo, IsThatOfTheNearestMember) {
  Rng rng(3);
  const VoxelGrid small({Vector3::Zero(), Vector3(0.07, 0.05, 0.03)}, 0.01);
  for (int i = 0; i < 40; ++i) {
    Bitset from(small.size());
    for (std::uint64_t k = rng.below(12); k > 0; --k) from.set(rng.below(small.size()));
    const std::vector<float> distance = contact::distance_to(from, small);
    for (std::size_t v = 0; v < small.size(); ++v) {
      double nearest = 1e30;
      from.for_each([&](std::size_t m) { nearest = std::min(nearest, (small.centre(m) - small.centre(v)).norm()); });
      ASSERT_NEAR(distance[v], nearest, 1e-6 * std::max(1.0, nearest)) << v;
    }
  }
}

TEST(Voxels, AFreeMotionRemovesJustTheCentresThatTheRobotEntered) {
  Rng rng(4);
  action::ActionLibrary library(task());
  for (int i = 0; i < 6; ++i) {
    const action::Action action = random_action(task(), library, task().scene().start, rng);
    const belief::Observation seen{false, action.path.back()};
    VoxelBelief voxels(model()->voxels);
    voxels.update(task(), belief::trace_of(task(), action, seen, belief::locate(task(), action, seen)));
    Bitset entered(grid().size());
    const reference::Shape tool{tool_pieces(), {}};
    for (const JointVector& q : action.path) {
      const Pose tool_from_base = task().base_from_tool(q).inverse();
      for (std::size_t v = 0; v < grid().size(); ++v)
        if (reference::holds(tool, tool_from_base * grid().centre(v))) entered.set(v);
    }
    for (std::size_t v = 0; v < grid().size(); ++v)
      if (entered.test(v)) {
        ASSERT_FALSE(voxels.possibly_occupied().test(v));
      }
    const std::size_t removed = grid().size() - voxels.possibly_occupied().count();
    EXPECT_GE(removed, entered.count());
    if (action.kind == action::Kind::poke) {  // too shallow for the arm to get there
      EXPECT_EQ(removed, entered.count());
    }
  }
}

TEST(Voxels, AContactRemovesWhatIsFartherThanTheTargetIsLong) {
  Rng rng(5);
  action::ActionLibrary library(task());
  int contacts = 0;
  for (int episode = 0; episode < 12; ++episode) {
    const Pose truth = geometry::pose_from(random_pose(task().scene().prior, rng));
    const PlainWorld world(task(), truth);
    VoxelBelief voxels(model()->voxels);
    for (int i = 0; i < 6; ++i) {
      const belief::Trace trace = observed(world, random_action(task(), library, task().scene().start, rng));
      const std::size_t before = voxels.possibly_occupied().count();
      voxels.update(task(), trace);
      ASSERT_LE(voxels.possibly_occupied().count(), before);
      for (std::size_t v = 0; v < grid().size(); ++v)
        if (!voxels.possibly_occupied().test(v)) {
          ASSERT_FALSE(world.holds(grid().centre(v)));
        }
      contacts += trace.contact;
    }
    const double farthest = model()->voxels->diameter + grid().half_diagonal();
    for (const belief::ContactRecord& record : voxels.contacts()) {
      ASSERT_GT(record.candidates.count(), 0u);
      EXPECT_EQ(record.distance, contact::distance_to(record.candidates, grid()));
      voxels.possibly_occupied().for_each([&](std::size_t v) { EXPECT_LE(record.distance[v], farthest + 2e-6); });
    }
    ASSERT_FALSE(voxels.excludes(truth, 0.0));
    ASSERT_FALSE(voxels.excludes(truth, 0.005));
  }
  EXPECT_GT(contacts, 6);
}

TEST(Voxels, AContactRemovesNothingThatTheRobotEnteredOnlyAtIt) {
  belief::Trace trace;
  trace.contact = true;
  trace.path = {joints({0.43, 0, 0, 0, 0, 0}), joints({0.434, 0, 0, 0, 0, 0}), joints({0.442, 0, 0, 0, 0, 0})};
  trace.touch = 2;
  trace.bodies = contact::BodyPath(task().bodies(), trace.path);
  VoxelBelief voxels(model()->voxels);
  voxels.update(task(), trace);
  const reference::Shape tool{tool_pieces(), {}};
  const auto covers = [&](std::size_t waypoint, std::size_t v) {
    return reference::holds(tool, task().base_from_tool(trace.path[waypoint]).inverse() * grid().centre(v));
  };
  int free = 0, kept = 0;
  for (std::size_t v = 0; v < grid().size(); ++v) {
    const bool before = covers(0, v) || covers(1, v);
    if (before) {
      EXPECT_FALSE(voxels.possibly_occupied().test(v));
    } else if (covers(2, v)) {
      EXPECT_TRUE(voxels.possibly_occupied().test(v));
      ++kept;
    }
    free += before;
  }
  EXPECT_GT(free, 0);
  EXPECT_GT(kept, 0);
}

/// Where the edges of one mesh go through the triangles of another.
void add_piercings(const reference::Placed& edges, const reference::Placed& faces, std::vector<Vector3>& points) {
  for (const auto& e : edges.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      for (const auto& f : faces.triangles) {
        const Vector3 &p = e[i], &q = e[(i + 1) % 3], normal = (f[1] - f[0]).cross(f[2] - f[0]);
        if (!test::segment_meets(p, q, f[0], f[1], f[2])) continue;
        points.push_back(p + normal.dot(f[0] - p) / normal.dot(q - p) * (q - p));
      }
}

TEST(Voxels, TheCandidatesOfEveryContactKeepTheVoxelsThatHoldItsPoints) {
  Rng rng(7);
  action::ActionLibrary library(task());
  const reference::Shape target{{socket()}, {}}, tool{tool_pieces(), {}};
  std::size_t checked = 0;
  for (int episode = 0; episode < 12; ++episode) {
    const Pose truth = geometry::pose_from(random_pose(task().scene().prior, rng));
    const PlainWorld world(task(), truth);
    VoxelBelief voxels(model()->voxels);
    std::vector<std::vector<Vector3>> points;
    for (int i = 0; i < 10; ++i) {
      const action::Action action = random_action(task(), library, task().scene().start, rng);
      const belief::Observation seen = world.execute(action, 0.0009);
      voxels.update(task(), belief::trace_of(task(), action, seen, belief::locate(task(), action, seen)));
      if (seen.contact) {
        const reference::Placed there(target, truth), robot(tool, task().base_from_tool(seen.q));
        points.emplace_back();
        add_piercings(there, robot, points.back());
        add_piercings(robot, there, points.back());
      }
      ASSERT_EQ(voxels.contacts().size(), points.size());
      for (std::size_t c = 0; c < points.size(); ++c)
        for (const Vector3& p : points[c]) {
          const Bitset& candidates = voxels.contacts()[c].candidates;
          const auto voxel = grid().voxel_at(p);
          ASSERT_TRUE(voxel && candidates.test(*voxel)) << "contact " << c << " of " << points.size();
          ++checked;
        }
    }
  }
  EXPECT_GT(checked, 100u);
}

TEST(Voxels, PastContactsRemoveMoreWhenTheirCandidatesGo) {
  VoxelBelief voxels(model()->voxels);
  Bitset both(grid().size()), one(grid().size());
  const std::size_t near = *grid().voxel_at(grid().box().low + Vector3::Constant(0.001));
  const std::size_t far = *grid().voxel_at(grid().box().high - Vector3::Constant(0.001));
  both.set(near), both.set(far), one.set(near);
  voxels.add_contact(both);
  const std::size_t wide = voxels.possibly_occupied().count();
  voxels.add_contact(one);
  EXPECT_LT(voxels.possibly_occupied().count(), wide);
  EXPECT_FALSE(voxels.contacts()[0].candidates.test(far));
  EXPECT_TRUE(voxels.contacts()[0].candidates.test(near));
}

TEST(Voxels, ExcludeAPoseOnlyIfEveryPoseNearItHasAVoxelThatIsFree) {
  Rng rng(6);
  VoxelBelief voxels(model()->voxels);
  std::vector<std::uint32_t> free;
  for (std::size_t v = 0; v < grid().size(); ++v)
    if (grid().centre(v).y() > 0.0) free.push_back(static_cast<std::uint32_t>(v));
  voxels.remove_free(free, free.size());
  int excluded = 0;
  for (int i = 0; i < 400; ++i) {
    const Pose pose = geometry::pose_from(random_pose(task().scene().prior, rng));
    const double radius = rng.uniform(0.0, 0.003);
    if (!voxels.excludes(pose, radius)) continue;
    ++excluded;
    Pose near = pose;
    near.translation() += radius * Vector3(rng.normal(), rng.normal(), rng.normal()).normalized();
    const PlainWorld world(task(), near);
    ASSERT_TRUE(std::any_of(free.begin(), free.end(), [&](std::uint32_t v) { return world.holds(grid().centre(v)); }));
  }
  EXPECT_GT(excluded, 40);
}

/// Up to 2.9 mm into the target by its waypoints, which may be 3 mm off.
TEST(Voxels, ARobotThatMayBeOffItsWaypointsClearsOnlyWhatItHasCertainlyBeenIn) {
  const auto may_err =
      small_model(belief::Kind::hierarchical, {.voxel_size = 0.004, .sensing = {.encoder_error = 0.003}});
  const action::Task& task = *may_err->task;
  const Pose truth = geometry::pose_from({0.45, 0.0, 0.01, 0.1, 0.0, 0.0});
  const auto at = [](double x) { return joints({x, 0.012, 0.01, 0, 0, 0}); };
  for (int i = 1; i <= 20; ++i) {
    belief::Belief belief(may_err, task.scene().start);
    const action::Action action = action_round(task, {at(0.40), at(0.4215 + 0.0029 * i / 20)});
    belief.step(action, {false, action.path.back()});
    ASSERT_TRUE(belief::reproduces(task, belief.history(), truth)) << i;
    EXPECT_TRUE(belief.contains(truth)) << i;
  }
  belief::Belief belief(may_err, task.scene().start);
  const Bitset before = belief.voxels().possibly_occupied();
  const action::Action action = action_round(task, {at(0.40), at(0.46)});
  belief.step(action, {false, action.path.back()});
  Bitset removed = before, entered(before.size());
  removed.and_not(belief.voxels().possibly_occupied());
  const auto swept = contact::swept_voxels(task.bodies(), action.bodies, may_err->voxels->grid);
  for (const std::uint32_t voxel : swept.voxels) entered.set(voxel);
  EXPECT_GT(removed.count(), 20u);
  EXPECT_LT(removed.count(), entered.count());
  removed.and_not(entered);
  EXPECT_TRUE(removed.none());
}

}  // namespace
}  // namespace tactus::test
