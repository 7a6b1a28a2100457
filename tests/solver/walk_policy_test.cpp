// SPDX-License-Identifier: BSD-3-Clause
#include "solver/walk_policy.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "solver/policy_setting.hpp"

/// What it costs to look for the target by walking.
namespace tactus::test {
namespace {

using solver::WalkPolicy;

/// A walk from the arm's posture for the search, on a fine lattice.
struct Walking : Setting {
  Walking(std::size_t count, Rng& rng, std::shared_ptr<const action::Task> of = task())
      : Setting(count, rng, of),
        rate(policy()),
        walk(on, std::make_shared<const action::Lattice>(*on, on->home(), 0.02), predictions, rate,
             on->base_from_tool(on->home()), dimensions) {}
  RatePolicy rate;
  WalkPolicy walk;
};

TEST(WalkPolicy, NeverCostsLessThanGoingStraightToEachPose) {
  Rng rng(1);
  Walking setting(60, rng);
  for (int i = 0; i < 60; ++i) {
    const Members members = random_members(60, rng);
    const Pose at = random_place(rng);
    double sum = 0.0;
    for (const std::size_t member : members) sum += setting.straight(at, member);
    ASSERT_GE(setting.walk.cost(members, at), sum / static_cast<double>(members.size()) - 1e-9);
  }
}

/// What is kept of one set of poses does not change what another costs.
TEST(WalkPolicy, CostsTheSameWhateverWasAskedBefore) {
  Rng rng(2), again(2);
  Walking used(60, rng), fresh(60, again);
  for (int i = 0; i < 20; ++i) used.walk.cost(random_members(60, rng), random_place(rng));
  for (int i = 0; i < 10; ++i) {
    const Members members = random_members(60, rng);
    const Pose at = random_place(rng);
    EXPECT_EQ(used.walk.cost(members, at), fresh.walk.cost(members, at));
  }
}

/// Where the target may be far away, going on where the tool is pays: that is what the walk is for.
TEST(WalkPolicy, CostsLessThanSweepsWhereThePriorIsWide) {
  const auto wide = small_task({.roll_width = 0.2, .position_width = 0.3});
  for (const std::uint64_t seed : {3u, 4u, 5u}) {
    Rng rng(seed);
    Walking setting(60, rng, wide);
    Members all(60);
    std::iota(all.begin(), all.end(), std::size_t{0});
    const Pose home = wide->base_from_tool(wide->home());
    EXPECT_LT(setting.walk.cost(all, home), 0.95 * setting.rate.cost(all, home)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace tactus::test
