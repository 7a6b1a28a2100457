// SPDX-License-Identifier: BSD-3-Clause
#include "support/rng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace tactus::support {
namespace {

/// xoshiro256++ and splitmix64 as their authors publish them.
TEST(Rng, IsTheSameOnEveryMachine) {
  EXPECT_EQ(mix(0), 0xe220a8397b1dcdafULL);
  EXPECT_EQ(mix(0x9e3779b97f4a7c15ULL), 0x6e789e6aa1b965f4ULL);
  Rng rng(0);
  rng.restore({1, 2, 3, 4});
  EXPECT_EQ(rng.next(), 41943041u);
  EXPECT_EQ(rng.next(), 58720359u);
  EXPECT_EQ(rng.next(), 3588806011781223u);
  EXPECT_EQ(rng.next(), 3591011842654386u);
}

TEST(Rng, GoesOnFromARestoredState) {
  Rng rng(7);
  rng.next();
  const auto state = rng.state();
  const std::vector<std::uint64_t> then{rng.next(), rng.next(), rng.next()};
  Rng other(99);
  other.restore(state);
  for (const std::uint64_t word : then) EXPECT_EQ(other.next(), word);
}

TEST(Rng, SeedsAndForksGiveSequencesOfTheirOwn) {
  std::set<std::uint64_t> first;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) first.insert(Rng(seed).next());
  EXPECT_EQ(first.size(), 1000u);
  Rng rng(3), same(3);
  Rng fork = rng.fork(), twin = same.fork();
  EXPECT_EQ(fork.next(), twin.next());
  EXPECT_EQ(rng.next(), same.next());
  EXPECT_NE(fork.next(), rng.next());
}

TEST(Rng, UniformStaysInsideAndFillsItsRange) {
  Rng rng(1);
  double low = 1e300, high = -1e300, sum = 0.0;
  constexpr int count = 100000;
  for (int i = 0; i < count; ++i) {
    const double x = rng.uniform(-2.0, 3.0);
    low = std::min(low, x), high = std::max(high, x), sum += x;
  }
  EXPECT_GE(low, -2.0);
  EXPECT_LT(high, 3.0);
  EXPECT_LT(low, -1.999);
  EXPECT_GT(high, 2.999);
  EXPECT_NEAR(sum / count, 0.5, 0.02);
  EXPECT_EQ(rng.uniform(4.0, 4.0), 4.0);
}

TEST(Rng, BelowIsEvenOverItsRange) {
  Rng rng(2);
  std::array<int, 7> seen{};
  for (int i = 0; i < 70000; ++i) ++seen[rng.below(7)];
  for (const int times : seen) EXPECT_NEAR(times, 10000, 400);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(rng.below(1), 0u);
  for (int i = 0; i < 100; ++i) EXPECT_LT(rng.below(UINT64_MAX), UINT64_MAX);
}

TEST(Rng, NormalHasMeanZeroAndVarianceOne) {
  Rng rng(3);
  double sum = 0.0, squares = 0.0;
  constexpr int count = 100000;
  for (int i = 0; i < count; ++i) {
    const double x = rng.normal();
    ASSERT_TRUE(std::isfinite(x));
    sum += x, squares += x * x;
  }
  EXPECT_NEAR(sum / count, 0.0, 0.02);
  EXPECT_NEAR(squares / count, 1.0, 0.03);
}

}  // namespace
}  // namespace tactus::support
