// SPDX-License-Identifier: BSD-3-Clause
#include "solver/walk_policy.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "solver/policy_setting.hpp"

/// What it costs to look for the target by walking.
namespace tactus::test {
namespace {

using solver::WalkPolicy;

/// Walks on a fine lattice through the arm's posture for the search.
struct Walking : Setting {
  Walking(std::size_t count, Rng& rng, std::shared_ptr<const action::Task> of = task())
      : Setting(count, rng, of),
        rate(policy()),
        lattice(std::make_shared<const action::Lattice>(*on, on->home(), 0.02)),
        walk(from(on->base_from_tool(on->home()))) {}

  WalkPolicy from(const Pose& base_from_tool) { return {on, lattice, predictions, rate, base_from_tool, dimensions}; }

  /// What a step costs, and the policies from there on, if the target is at one of these poses.
  double after(WalkPolicy& policy, const action::MotionPtr& step, const Members& members) {
    Bitset all(predictions.poses().size());
    for (const std::size_t member : members) all.set(member);
    const std::size_t untouched = step->path.size();
    const Bitset met = predictions.subset(step, all, 0, untouched - 1);
    double sum = 0.0;
    for (const solver::Group& group : predictions.split(step, all, solver::least_group(met.count(), dimensions))) {
      const Pose& there = step->bodies.base_from_body(group.first - 1, 0);
      const double then =
          group.first == untouched ? policy.cost(group.poses, there, WalkPolicy::quick) : rate.cost(group.poses, there);
      sum += static_cast<double>(group.poses.size()) * (step->cost_to[std::min(group.first, untouched - 1)] + then);
    }
    return sum / static_cast<double>(members.size());
  }

  RatePolicy rate;
  std::shared_ptr<const action::Lattice> lattice;
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

/// Who goes along the walk with which planning begins is worth what it promised: otherwise a robot would rather stay,
/// or turn about, than go.
TEST(WalkPolicy, CostsNoLessThanItsBestFirstStepAndWhatFollows) {
  const auto wide = small_task({.roll_width = 0.2, .position_width = 0.2});
  for (const std::uint64_t seed : {6u, 7u, 8u}) {
    Rng rng(seed);
    Walking setting(60, rng, wide);
    const action::Lattice& lattice = *setting.lattice;
    Members all(60);
    std::iota(all.begin(), all.end(), std::size_t{0});
    std::size_t place = 0;
    while (lattice.is_on_plane(place)) place = rng.below(lattice.size());
    const Pose& here = lattice.base_from_tool(place);
    WalkPolicy policy = setting.from(here);
    double best = 1e300;
    for (std::size_t direction = 0; direction < action::Lattice::directions; ++direction)
      if (const action::MotionPtr step = lattice.step(place, direction))
        best = std::min(best, setting.after(policy, step, all));
    for (std::size_t other = 0; other < lattice.size(); ++other)
      if (lattice.is_on_plane(other))
        best = std::min(best, action::transit_cost(*wide, here, lattice.base_from_tool(other)) +
                                  policy.cost(all, lattice.base_from_tool(other), WalkPolicy::quick));
    EXPECT_LT(best, policy.cost(all, here) + 1e-9);
  }
}

/// Where the target may be far away, going on where the tool is pays: that is what the walk is for.
TEST(WalkPolicy, CostsLessThanSweepsWhereThePriorIsWide) {
  const auto wide = small_task({.roll_width = 0.2, .position_width = 0.4});
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
