// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/voxel_grid.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "support/error.hpp"
#include "support/rng.hpp"

namespace tactus::geometry {
namespace {

using support::Rng;

const VoxelGrid grid({{-0.02, 0.1, 0.3}, {0.05, 0.145, 0.33}}, 0.01);

TEST(VoxelGrid, CoversItsBoxAndNoMoreThanItMust) {
  EXPECT_EQ(grid.shape(), (std::array<int, 3>{7, 5, 3}));
  EXPECT_EQ(grid.size(), 105u);
  EXPECT_TRUE(grid.box().inflated(1e-12).contains({0.05, 0.145, 0.33}));
  EXPECT_NEAR(grid.half_diagonal(), 0.00866, 1e-5);
  const VoxelGrid flat({{0, 0, 0}, {0.03, 0.0, 0.0}}, 0.01);
  EXPECT_EQ(flat.shape(), (std::array<int, 3>{3, 1, 1}));
}

TEST(VoxelGrid, NumbersItsVoxelsXFastest) {
  std::size_t index = 0;
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 7; ++x, ++index) {
        EXPECT_EQ(grid.index(x, y, z), index);
        EXPECT_EQ(grid.coordinates(index), (std::array<int, 3>{x, y, z}));
        EXPECT_TRUE(grid.centre(index).isApprox(grid.centre(x, y, z)));
        EXPECT_EQ(grid.voxel_at(grid.centre(index)), index);
      }
  EXPECT_TRUE(grid.centre(0).isApprox(Vector3(-0.015, 0.105, 0.305)));
}

TEST(VoxelGrid, FindsTheCubeThatHoldsAPoint) {
  Rng rng(1);
  for (int i = 0; i < 2000; ++i) {
    Vector3 p;
    for (int d = 0; d < 3; ++d) p[d] = rng.uniform(grid.box().low[d] - 0.01, grid.box().high[d] + 0.01);
    const auto voxel = grid.voxel_at(p);
    ASSERT_EQ(voxel.has_value(), grid.box().contains(p));
    if (voxel) {
      ASSERT_LE((grid.centre(*voxel) - p).cwiseAbs().maxCoeff(), 0.005 + 1e-12);
    }
  }
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e300, 1e300})
    EXPECT_FALSE(grid.voxel_at({0.0, bad, 0.31}));
}

TEST(VoxelGrid, VisitsEveryCentreInABoxOnceAndFewOthers) {
  Rng rng(2);
  for (int i = 0; i < 500; ++i) {
    Box box;
    for (int k = 0; k < 2; ++k) {
      Vector3 p;
      for (int d = 0; d < 3; ++d) p[d] = rng.uniform(grid.box().low[d] - 0.03, grid.box().high[d] + 0.03);
      box.add(p);
    }
    std::set<std::size_t> visited;
    grid.for_each_in(box, [&](std::size_t voxel, const Vector3& centre) {
      EXPECT_TRUE(visited.insert(voxel).second);
      EXPECT_TRUE(centre.isApprox(grid.centre(voxel)));
      EXPECT_TRUE(box.inflated(1e-9).contains(centre));
    });
    for (std::size_t v = 0; v < grid.size(); ++v) EXPECT_EQ(visited.count(v), box.contains(grid.centre(v)) ? 1u : 0u);
  }
}

TEST(VoxelGrid, VisitsNothingInAnEmptyBoxOrFarAway) {
  int visits = 0;
  const auto count = [&](std::size_t, const Vector3&) { ++visits; };
  grid.for_each_in(Box{}, count);
  grid.for_each_in({{1, 1, 1}, {2, 2, 2}}, count);
  grid.for_each_in({{-1e300, -1e300, -1e300}, {-1e200, -1e200, -1e200}}, count);
  EXPECT_EQ(visits, 0);
  grid.for_each_in({Vector3::Constant(-1e300), Vector3::Constant(1e300)}, count);
  EXPECT_EQ(visits, 105);
}

TEST(VoxelGrid, TooFineAPitchIsAnErrorAndNoHugeGrid) {
  try {
    VoxelGrid({{0, 0, 0}, {1, 1, 1}}, 0.001, 1000);
    FAIL();
  } catch (const support::Error& error) {
    EXPECT_EQ(error.status(), support::Status::invalid_argument);
    EXPECT_NE(std::string(error.what()).find("1000"), std::string::npos);
  }
  EXPECT_THROW(VoxelGrid({{0, 0, 0}, {1, 1, 1}}, 1e-30), support::Error);
}

}  // namespace
}  // namespace tactus::geometry
