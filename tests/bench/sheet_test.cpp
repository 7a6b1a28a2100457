// SPDX-License-Identifier: BSD-3-Clause
#include "bench/sheet.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace tactus::bench {
namespace {

void expect_sheet(const geometry::Mesh& mesh, double length) {
  EXPECT_TRUE(geometry::is_closed(mesh));
  EXPECT_EQ(geometry::shells(geometry::merged_vertices(mesh)).size(), 1u);
  EXPECT_GE(mesh.triangles.size(), 1000u);
  EXPECT_NEAR(geometry::signed_volume(mesh) / (length * 0.03 * sheet_thickness), 1.0, 0.01);
  EXPECT_LE(geometry::bounds(mesh).centre().norm(), 1e-12);
}

TEST(SheetTest, HookIsAClosedStrip) { expect_sheet(hook(), 0.08 + 0.025 * 200.0 / 180.0 * std::numbers::pi); }

TEST(SheetTest, RingIsAClosedStrip) { expect_sheet(ring(), 0.045 * 2.0 * std::numbers::pi); }

TEST(SheetTest, BracketIsAClosedStrip) { expect_sheet(bracket(), 0.16 + 0.005 * std::numbers::pi); }

}  // namespace
}  // namespace tactus::bench
