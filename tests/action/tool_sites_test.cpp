// SPDX-License-Identifier: BSD-3-Clause
#include "action/tool_sites.hpp"

#include <gtest/gtest.h>

#include "support/rng.hpp"

namespace tactus::test {
namespace {

using action::ToolSites;
using geometry::Vector3;
using support::Rng;

const ToolSites sites{{0.1, -0.2, 0.3}, {0.001, 0.0007, 0.0015}};

Vector3 random_position(Rng& rng) { return {rng.uniform(), rng.uniform(), rng.uniform()}; }

TEST(ToolSites, TheNearestOneIsASiteAndNoFartherThanHalfAStep) {
  Rng rng(1);
  for (int i = 0; i < 100; ++i) {
    const Vector3 position = random_position(rng), site = sites.nearest(position);
    EXPECT_TRUE(sites.hold(site));
    for (int d = 0; d < 3; ++d) EXPECT_LE(std::abs(site[d] - position[d]), 0.5 * sites.step[d] + 1e-12);
  }
  EXPECT_FALSE(sites.hold(sites.origin + Vector3(0.0, 1e-5, 0.0)));
}

TEST(ToolSites, AWayAlongAnAxisEndsAtOne) {
  Rng rng(2);
  for (int i = 0; i < 100; ++i) {
    const Vector3 from = sites.nearest(random_position(rng));
    const int axis = static_cast<int>(rng.below(3));
    const Vector3 to = from + rng.uniform(-0.3, 0.3) * Vector3::Unit(axis);
    const Vector3 end = sites.end(from, to);
    EXPECT_LE((end - to).norm(), 0.5 * sites.step[axis] + 1e-12);
    EXPECT_NEAR((end - from).norm(), std::abs(end[axis] - from[axis]), 1e-12);
    if ((end - from).norm() > 0.01) {
      EXPECT_EQ(sites.stride(from, end), sites.step[axis]);
    }
  }
}

TEST(ToolSites, OtherWaysAreLeftAsTheyAre) {
  const Vector3 site = sites.origin, across = site + Vector3(0.01, 0.007, 0.0), off = site + Vector3(5e-4, 0.0, 0.0);
  EXPECT_EQ(sites.end(site, across), across);
  EXPECT_EQ(sites.stride(site, across), 0.0);
  EXPECT_EQ(sites.end(off, off + Vector3(0.1, 0.0, 0.0)), Vector3(off + Vector3(0.1, 0.0, 0.0)));
  EXPECT_EQ(sites.stride(site, off), 0.0);
  EXPECT_EQ(sites.stride(site, site), 0.0);
}

}  // namespace
}  // namespace tactus::test
