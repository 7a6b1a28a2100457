// SPDX-License-Identifier: BSD-3-Clause
#include "contact/swept_voxels.hpp"

#include <gtest/gtest.h>

#include <set>

#include "contact/contact_cases.hpp"

/// What a motion sweeps, against the plain inside test of every voxel.
namespace tactus::test {
namespace {

using contact::SweptVoxels;
using geometry::VoxelGrid;
using support::Bitset;

/// Around the tool's way, at a place that no face of a shape is aligned with.
VoxelGrid grid_around(const Motion& motion, double pitch) {
  geometry::Box box;
  for (const std::vector<Placed>& robot : motion.track) box.add(robot.front().ball.centre);
  return VoxelGrid(box.inflated(0.0611), pitch);
}

TEST(SweptVoxels, AreThoseWhoseCentreSomeBodyHolds) {
  Rng rng(4);
  std::size_t total = 0;
  for (const std::size_t s : {0U, 2U, 3U, 7U}) {
    const Scene& scene = scene_of(s);
    for (int m = 0; m < 2; ++m) {
      std::vector<JointVector> waypoints = random_waypoints(rng);
      if (waypoints.size() > 10) waypoints.resize(10);
      const Motion motion(scene, waypoints);
      const VoxelGrid grid = grid_around(motion, 0.0073);
      const SweptVoxels swept = contact::swept_voxels(scene.contact.bodies(), motion.path, grid);
      ASSERT_EQ(swept.entered.size(), waypoints.size());

      std::set<std::size_t> plain;
      for (std::size_t i = 0; i < waypoints.size(); ++i) {
        for (std::size_t v = 0; v < grid.size(); ++v)
          for (const Placed& part : motion.track[i])
            if (holds(*part.shape, part.pose.inverse() * grid.centre(v))) plain.insert(v);
        ASSERT_EQ(swept.entered_by(i), plain.size()) << "waypoint " << i;
        const std::set<std::size_t> found(swept.voxels.begin(),
                                          swept.voxels.begin() + static_cast<std::ptrdiff_t>(swept.entered_by(i)));
        ASSERT_EQ(found, plain) << "waypoint " << i;
      }
      EXPECT_EQ(swept.voxels.size(), plain.size());
      total += plain.size();
    }
  }
  EXPECT_GT(total, 500U);
}

std::vector<const contact::kernel::VoxelKernel*> kernels_of_machine() {
  std::vector<const contact::kernel::VoxelKernel*> kernels;
  for (const contact::kernel::VoxelKernel* const* kernel = contact::kernel::voxel_kernels(); *kernel; ++kernel)
    if ((*kernel)->supported()) kernels.push_back(*kernel);
  return kernels;
}

Bitset random_members(std::size_t size, double density, Rng& rng) {
  Bitset members(size);
  for (std::size_t i = 0; i < size; ++i)
    if (rng.uniform() < density) members.set(i);
  return members;
}

/// The machine may have the portable one alone.
TEST(SweptVoxels, AreTheSameByEveryKernelInTheSameOrder) {
  Rng rng(8);
  for (int m = 0; m < 24; ++m) {
    const Scene& scene = scene_of(static_cast<std::size_t>(m) % pairings().size());
    const Motion motion(scene, random_waypoints(rng));
    const VoxelGrid grid = grid_around(motion, rng.uniform(0.003, 0.02));
    const auto by = [&](const contact::kernel::VoxelKernel& kernel) {
      return contact::swept_voxels(scene.contact.bodies(), motion.path, grid, kernel);
    };
    const SweptVoxels portable = by(contact::kernel::voxels_portable);
    for (const contact::kernel::VoxelKernel* kernel : kernels_of_machine()) {
      const SweptVoxels swept = by(*kernel);
      ASSERT_EQ(swept.voxels, portable.voxels) << kernel->name;
      ASSERT_EQ(swept.entered, portable.entered) << kernel->name;
      ASSERT_EQ(swept.word, portable.word) << kernel->name;
      ASSERT_EQ(swept.mask, portable.mask) << kernel->name;
    }
  }
}

TEST(SweptVoxels, AreTheSameWhereWaypointsClearOfTheRegionArePassedOver) {
  Rng rng(9);
  std::size_t total = 0;
  for (int m = 0; m < 12; ++m) {
    const std::size_t s = static_cast<std::size_t>(m) % pairings().size();
    const Scene& scene = scene_of(s);
    const std::vector<JointVector> waypoints = random_waypoints(rng);
    const Motion motion(scene, waypoints);
    const Vector3 corner = motion.track.front().front().ball.centre;
    const VoxelGrid grid({corner, corner + Vector3(0.05, 0.04, 0.03)}, 0.005);
    const contact::RobotBodies near_grid(scene.arm.model, scene.arm.tip, pairings()[s].tool.mesh(), grid.box());
    const SweptVoxels swept = contact::swept_voxels(near_grid, BodyPath(near_grid, waypoints), grid);
    const SweptVoxels all = contact::swept_voxels(scene.contact.bodies(), motion.path, grid);
    ASSERT_EQ(swept.voxels, all.voxels);
    ASSERT_EQ(swept.entered, all.entered);
    total += all.voxels.size();
  }
  EXPECT_GT(total, 500U);
}

TEST(EnteredOf, CountsTheMembersAmongTheVoxelsThatEachWaypointEnters) {
  Rng rng(10);
  for (int m = 0; m < 24; ++m) {
    const Scene& scene = scene_of(static_cast<std::size_t>(m) % pairings().size());
    const Motion motion(scene, random_waypoints(rng));
    const VoxelGrid grid = grid_around(motion, rng.uniform(0.004, 0.02));
    const SweptVoxels swept = contact::swept_voxels(scene.contact.bodies(), motion.path, grid);
    const Bitset members = random_members(grid.size(), rng.uniform(), rng);
    std::vector<std::uint32_t> plain(motion.path.size(), 0);
    for (std::size_t i = 0, k = 0; i < plain.size(); ++i)
      for (; k < swept.entered_by(i); ++k) plain[i] += members.test(swept.voxels[k]) ? 1U : 0U;
    for (const contact::kernel::SetKernel* const* kernel = contact::kernel::set_kernels(); *kernel; ++kernel) {
      if (!(*kernel)->supported()) continue;
      ASSERT_EQ(contact::entered_of(swept, members, **kernel), plain) << (*kernel)->name;
    }
  }
}

/// All that belongs there, and little more: the look-up of distances may err by a few millimetres.
TEST(ContactCandidates, AreTheVoxelsAroundTheSurfaceThatTheRobotHasNotFilledBefore) {
  constexpr double slack = 0.001, error = 0.008;
  Rng rng(5);
  const Scene& scene = scene_of(2);
  for (int m = 0; m < 6; ++m) {
    const Motion motion(scene, random_waypoints(rng));
    const VoxelGrid grid = grid_around(motion, 0.006);
    const std::size_t stop = 1 + rng.below(motion.path.size() - 1);
    const Bitset found = contact::contact_candidates(scene.contact.bodies(), motion.path, stop, grid, slack);
    const double near = grid.half_diagonal() + slack;
    for (std::size_t v = 0; v < grid.size(); ++v) {
      bool belongs = false, may = false;
      for (std::size_t b = 0; b < scene.arm.parts.size(); ++b) {
        const Placed &part = motion.track[stop][b], &before = motion.track[stop - 1][b];
        const Vector3 p = grid.centre(v);
        if (reference::gap(part.ball, {p, 0.0}) > near + error) continue;
        const double away = surface_from_point(part, p);
        const double depth = holds(*before.shape, before.pose.inverse() * p) ? surface_from_point(before, p) : 0.0;
        belongs = belongs || (away <= near && depth <= near);
        may = may || (away <= near + error && depth <= near + error);
      }
      ASSERT_TRUE(found.test(v) || !belongs);
      ASSERT_TRUE(!found.test(v) || may);
    }
    EXPECT_GT(found.count(), 0U);
  }
}

TEST(DistanceTo, IsTheNearestMemberOfAll) {
  Rng rng(6);
  for (const std::array<int, 3> shape :
       {std::array{17, 9, 13}, std::array{1, 21, 8}, std::array{11, 1, 1}, std::array{1, 1, 1}, std::array{5, 4, 40}})
    for (const double density : {0.0, 0.002, 0.05, 0.6, 1.0}) {
      const double pitch = 0.004;
      const VoxelGrid grid({Vector3::Zero(), pitch * Vector3(shape[0], shape[1], shape[2])}, pitch);
      ASSERT_EQ(grid.shape(), shape);
      const Bitset members = random_members(grid.size(), density, rng);
      const std::vector<float> found = contact::distance_to(members, grid);
      ASSERT_EQ(found.size(), grid.size());
      for (const contact::kernel::VoxelKernel* kernel : kernels_of_machine())
        ASSERT_EQ(contact::distance_to(members, grid, *kernel), found) << kernel->name;
      for (std::size_t v = 0; v < grid.size(); ++v) {
        double nearest = 1e30;
        members.for_each([&](std::size_t m) { nearest = std::min(nearest, (grid.centre(m) - grid.centre(v)).norm()); });
        ASSERT_NEAR(found[v], nearest, 1e-6 * nearest) << "voxel " << v << ", density " << density;
      }
    }
}

}  // namespace
}  // namespace tactus::test
