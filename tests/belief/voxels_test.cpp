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

}  // namespace
}  // namespace tactus::test
