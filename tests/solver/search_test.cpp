// SPDX-License-Identifier: BSD-3-Clause
#include "solver/search.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <set>

#include "solver/toy.hpp"

/// The search on finite problems whose optimum is known.
namespace tactus::test {
namespace {

using solver::Search;
using support::Deadline;
using support::Rng;

constexpr int states = 200;
constexpr double exact = 1e-6;

Deadline expansions(std::uint64_t count) { return {std::numeric_limits<double>::infinity(), count}; }

/// Heuristics from the optimum: `low` times it and `high` times it, each factor drawn anew for every state.
void guess(Toy& toy, Rng& rng, std::array<double, 2> low, std::array<double, 2> high) {
  const std::vector<double> best = optimum(toy);
  for (std::size_t s = 0; s < best.size(); ++s)
    toy.heuristic[s] = {best[s] * rng.uniform(low[0], low[1]), best[s] * rng.uniform(high[0], high[1])};
}

std::shared_ptr<const Toy> guessed(Rng& rng, std::size_t outcomes, std::array<double, 2> low = {0.0, 1.0},
                                   std::array<double, 2> high = {1.0, 3.0}) {
  auto toy = std::make_shared<Toy>(random_toy(rng, states, outcomes));
  guess(*toy, rng, low, high);
  return toy;
}

std::vector<double> lower(const Toy& toy) {
  std::vector<double> values;
  for (const Values& h : toy.heuristic) values.push_back(h[0]);
  return values;
}

Search search(const std::shared_ptr<const Toy>& toy, double epsilon, int horizon = states) {
  return {std::make_shared<ToyState>(toy, 0), {epsilon, horizon}};
}

std::size_t state_of(const Search& search, int node) {
  return static_cast<std::size_t>(search.state(node).configuration()[0]);
}

int nodes(const Search& search) { return static_cast<int>(search.size()); }

/// What a node's choices are worth, added up plainly.
std::vector<double> q_values(const Search& search, int node, ValueType type) {
  std::vector<double> result;
  for (std::size_t a = 0; a < search.choices(node).size(); ++a) {
    double sum = 0.0;
    const auto& outcomes = search.choices(node)[a].outcomes;
    for (std::size_t z = 0; z < outcomes.size(); ++z) {
      const int child = search.child(node, a, z);
      const double next = outcomes[z].goal ? 0.0
                          : child >= 0     ? search.value(child, type)
                                           : outcomes[z].heuristic[static_cast<std::size_t>(type)];
      sum += outcomes[z].probability * (outcomes[z].cost + next);
    }
    result.push_back(sum);
  }
  return result;
}

/// Steps from the start to each node, by the motions that trials have taken; of the others a great number.
std::vector<int> depths(const Search& search) {
  std::vector<int> depth(search.size(), 1 << 20);
  depth[Search::start] = 0;
  for (int round = 0; round < nodes(search); ++round)
    for (int node = 0; node < nodes(search); ++node)
      for (std::size_t a = 0; a < search.choices(node).size(); ++a)
        for (std::size_t z = 0; z < search.choices(node)[a].outcomes.size(); ++z)
          if (const int child = search.child(node, a, z); child >= 0)
            depth[static_cast<std::size_t>(child)] =
                std::min(depth[static_cast<std::size_t>(child)], depth[static_cast<std::size_t>(node)] + 1);
  return depth;
}

TEST(Search, AdmissibleValuesNeverExceedTheOptimum) {
  Rng rng(1);
  for (int i = 0; i < 20; ++i) {
    const auto toy = guessed(rng, 4);
    const std::vector<double> best = optimum(*toy);
    Search tried = search(toy, rng.uniform());
    for (int part = 0; part < 12; ++part) {
      Deadline deadline = expansions(1 + rng.below(20));
      tried.run(deadline);
      for (int node = 0; node < nodes(tried); ++node)
        ASSERT_LE(tried.value(node, ValueType::admissible), best[state_of(tried, node)] + exact);
    }
  }
}

TEST(Search, KeepsWhatFollowsAMotionThatTurnsOutDearerButNotWhatFollowedAnother) {
  constexpr double more = 0.3;
  Rng rng(21);
  int followed = 0;
  for (int i = 0; i < 10; ++i) {
    Search tried = search(guessed(rng, 4), 0.5);
    Deadline deadline = expansions(30);
    tried.run(deadline);
    for (std::size_t a = 0; a < tried.choices(Search::start).size(); ++a) {
      const auto children = [&] {
        std::vector<int> found;
        for (std::size_t z = 0; z < tried.choices(Search::start)[a].outcomes.size(); ++z)
          found.push_back(tried.child(Search::start, a, z));
        return found;
      };
      const std::vector<int> before = children();
      const double q = tried.q_value(Search::start, a, ValueType::inadmissible);
      tried.reweigh(Search::start, a, solver::charged(tried.choices(Search::start)[a], more));
      EXPECT_NEAR(tried.q_value(Search::start, a, ValueType::inadmissible), q + more, exact);
      EXPECT_EQ(children(), before);
      followed += std::count_if(before.begin(), before.end(), [](int child) { return child >= 0; }) > 0;

      solver::Choice another = tried.choices(Search::start)[a];
      another.motion = std::make_shared<const action::Motion>();
      tried.reweigh(Search::start, a, another);
      for (const int child : children()) EXPECT_EQ(child, -1);
    }
  }
  EXPECT_GT(followed, 5);
}

TEST(Search, ValuesOnlyRiseFromAConsistentHeuristic) {
  Rng rng(2);
  for (int i = 0; i < 20; ++i) {
    const double factor = rng.uniform();  // one for all states
    const auto toy = guessed(rng, 4, {factor, factor}, {factor, factor});
    Search tried = search(toy, 1.0);
    std::vector<double> before;
    for (std::uint64_t budget = 1; budget < 40; ++budget) {
      Deadline deadline = expansions(budget);
      tried.run(deadline);
      for (std::size_t node = 0; node < before.size(); ++node)
        ASSERT_GE(tried.value(static_cast<int>(node), ValueType::admissible), before[node] - 1e-9);
      before.resize(tried.size());
      for (int node = 0; node < nodes(tried); ++node)
        before[static_cast<std::size_t>(node)] = tried.value(node, ValueType::admissible);
    }
  }
}

TEST(Search, ConvergesToTheOptimumWhereMotionsHaveOneOutcome) {
  Rng rng(3);
  for (int i = 0; i < 30; ++i) {
    const auto toy = guessed(rng, 1);
    Search tried = search(toy, 1.0);
    Deadline unlimited = Deadline::unlimited();
    tried.run(unlimited);
    const double best = optimum(*toy)[0];
    EXPECT_NEAR(tried.value(Search::start, ValueType::admissible), best, exact);
    EXPECT_NEAR(tried.q_value(Search::start, *tried.best(Search::start), ValueType::admissible), best, exact);
  }
}

TEST(Search, ConvergesToTheOptimumWithHeuristicsForTheOutcomesThatTrialsPassBy) {
  Rng rng(4);
  for (int i = 0; i < 30; ++i) {
    const double factor = rng.uniform();
    const auto toy = guessed(rng, 4, {factor, factor});
    const std::vector<double> heuristic = lower(*toy);
    Search tried = search(toy, 1.0);
    Deadline unlimited = Deadline::unlimited();
    tried.run(unlimited);
    const double followed = optimum(*toy, &heuristic)[0];
    EXPECT_NEAR(tried.value(Search::start, ValueType::admissible), followed, exact);
    EXPECT_LE(followed, optimum(*toy)[0] + exact);
  }
}

TEST(Search, KeepsToItsExpansionsAndCountsThem) {
  Rng rng(5);
  for (std::uint64_t budget = 0; budget < 60; ++budget) {
    const auto toy = guessed(rng, 3);
    Search tried = search(toy, 0.5);
    Deadline deadline = expansions(budget);
    tried.run(deadline);
    EXPECT_LE(deadline.expansions(), std::max<std::uint64_t>(1, budget)) << "the start is always expanded";
    EXPECT_EQ(deadline.expansions(), toy->expansions);
    std::size_t expanded = 0;
    for (int node = 0; node < nodes(tried); ++node) {
      expanded += tried.expanded(node);
      EXPECT_EQ(tried.expanded(node), !tried.choices(node).empty());
    }
    EXPECT_EQ(expanded, toy->expansions);
  }
}

/// Cancelled in the middle of one expansion: that is undone, or if it was the first says nothing of the least possible.
TEST(Search, HasLowerBoundsOnlyWhereThereWasTimeToWeighAll) {
  Rng rng(12);
  for (std::size_t last = 1; last < 30; ++last) {
    Toy toy = random_toy(rng, 40, 3);
    const std::vector<double> least = optimum(toy);
    for (std::size_t s = 0; s < least.size(); ++s) toy.heuristic[s] = {least[s], 2.0 * least[s]};
    std::atomic<bool> cancelled{false};
    std::size_t asked = 0;
    toy.when_asked = [&] { cancelled = ++asked == last; };
    Search tried = search(std::make_shared<const Toy>(toy), 0.5);
    Deadline deadline(std::numeric_limits<double>::infinity(), UINT64_MAX, &cancelled);
    tried.run(deadline);
    EXPECT_TRUE(tried.best(Search::start));
    EXPECT_EQ(deadline.expansions(), cancelled ? std::max<std::size_t>(1, last - 1) : asked);
    for (int node = 0; node < nodes(tried); ++node) {
      EXPECT_LE(tried.value(node, ValueType::admissible), least[state_of(tried, node)] + exact);
    }
  }
}

/// What took too long is left undone, and whoever has more time comes to the optimum all the same.
TEST(Search, EndsWhereABeliefIsOutOfTimeAndMayGoOn) {
  Rng rng(13);
  int interrupted = 0;
  for (std::size_t last = 2; last < 40; ++last) {
    Toy toy = *guessed(rng, 1, {0.0, 1.0}, {0.0, 1.0});
    const double least = optimum(toy)[0];
    std::size_t asked = 0;
    toy.when_asked = [&] {
      if (++asked == last) throw support::OutOfTime{};
    };
    Search tried = search(std::make_shared<const Toy>(toy), 1.0);
    Deadline deadline = Deadline::unlimited();
    tried.run(deadline);
    if (asked < last) continue;
    ++interrupted;
    EXPECT_EQ(deadline.expansions(), last - 1);
    EXPECT_TRUE(tried.best(Search::start));
    for (int node = 0; node < nodes(tried); ++node) EXPECT_EQ(tried.expanded(node), !tried.choices(node).empty());
    tried.run(deadline);
    EXPECT_NEAR(tried.value(Search::start, ValueType::admissible), least, exact);
  }
  EXPECT_GT(interrupted, 10);
}

TEST(Search, GivesTheSameForTheSameBudget) {
  Rng rng(6);
  for (int i = 0; i < 20; ++i) {
    const auto toy = guessed(rng, 4);
    const std::uint64_t budget = 1 + rng.below(60);
    Search first = search(toy, 0.5), second = search(toy, 0.5);
    for (Search* tried : {&first, &second}) {
      Deadline deadline = expansions(budget);
      tried->run(deadline);
    }
    EXPECT_EQ(first.best(Search::start), second.best(Search::start));
    ASSERT_EQ(first.size(), second.size());
    for (int node = 0; node < nodes(first); ++node)
      for (const ValueType type : {ValueType::admissible, ValueType::inadmissible})
        EXPECT_EQ(first.value(node, type), second.value(node, type));
  }
}

TEST(Search, ExpandsNothingBeyondTheHorizon) {
  Rng rng(7);
  for (int horizon = 1; horizon < 12; ++horizon) {
    const auto toy = guessed(rng, 3);
    Search tried = search(toy, 0.5, horizon);
    Deadline deadline = expansions(150);
    tried.run(deadline);
    const std::vector<int> depth = depths(tried);
    for (int node = 0; node < nodes(tried); ++node) {
      EXPECT_LE(depth[static_cast<std::size_t>(node)], horizon);
      EXPECT_FALSE(tried.expanded(node) && depth[static_cast<std::size_t>(node)] == horizon);
    }
  }
}

TEST(Search, BestIsTheLeastValueOfWhatIsNotBanned) {
  Rng rng(8);
  for (const double epsilon : {0.0, 0.5, 1.0}) {
    const auto toy = guessed(rng, 4);
    Search tried = search(toy, epsilon);
    Deadline deadline = expansions(50);
    tried.run(deadline);
    for (int node = 0; node < nodes(tried); ++node) {
      for (const ValueType type : {ValueType::admissible, ValueType::inadmissible}) {
        const std::vector<double> plain = q_values(tried, node, type);
        for (std::size_t a = 0; a < plain.size(); ++a) EXPECT_NEAR(tried.q_value(node, a, type), plain[a], 1e-12);
      }
      const ValueType guide = epsilon == 1.0 ? ValueType::admissible : ValueType::inadmissible;
      const std::vector<double> q = q_values(tried, node, guide);
      for (std::size_t mask = 0; mask < std::size_t{1} << q.size(); ++mask) {
        std::vector<bool> banned;
        for (std::size_t a = 0; a < q.size(); ++a) banned.push_back(mask >> a & 1);
        const auto best = tried.best(node, banned);
        ASSERT_EQ(best.has_value(), !std::all_of(banned.begin(), banned.end(), [](bool b) { return b; }));
        if (!best) continue;
        EXPECT_FALSE(banned[*best]);
        for (std::size_t a = 0; a < q.size(); ++a) EXPECT_TRUE(banned[a] || q[*best] <= q[a] + 1e-12);
      }
    }
  }
}

TEST(Search, ChildrenAreWhatTheOutcomesLeadTo) {
  Rng rng(9);
  for (int i = 0; i < 10; ++i) {
    const auto toy = guessed(rng, 4);
    Search tried = search(toy, 0.5);
    Deadline deadline = expansions(80);
    tried.run(deadline);
    std::set<std::size_t> seen;
    for (int node = 0; node < nodes(tried); ++node) {
      EXPECT_TRUE(seen.insert(state_of(tried, node)).second) << "one node a belief";
      if (!tried.expanded(node)) continue;
      const auto& moves = toy->moves[state_of(tried, node)];
      for (std::size_t a = 0; a < moves.size(); ++a)
        for (std::size_t z = 0; z < moves[a].size(); ++z) {
          const int child = tried.child(node, a, z);
          if (child < 0) continue;
          EXPECT_EQ(z, likeliest(moves[a]));
          ASSERT_NE(moves[a][z].to, Toy::goal);
          EXPECT_EQ(state_of(tried, child), static_cast<std::size_t>(moves[a][z].to));
        }
    }
  }
}

TEST(Search, AConvergedPolicyLeadsToTheGoalByLikeliestOutcomes) {
  Rng rng(10);
  for (const double epsilon : {0.0, 0.5, 1.0}) {
    const auto toy = guessed(rng, 1);
    Search tried = search(toy, epsilon);
    Deadline deadline = expansions(100000);
    tried.run(deadline);
    int node = Search::start;
    for (int depth = 0; depth < states && node >= 0; ++depth) {
      ASSERT_TRUE(tried.expanded(node));
      node = tried.child(node, *tried.best(node), 0);
    }
    EXPECT_EQ(node, -1) << "the goal has no node";
  }
}

TEST(Search, EndsWhereNoGoalCanBeReached) {
  auto toy = std::make_shared<Toy>();
  toy->moves = {{{{1.0, 0.1, 1}}}, {{{1.0, 0.1, 0}}}};
  toy->heuristic.assign(2, Values{});
  Search search(std::make_shared<ToyState>(toy, 0), {1.0, 8});
  Deadline deadline = expansions(1000);
  search.run(deadline);
  EXPECT_EQ(deadline.expansions(), 2u);
}

}  // namespace
}  // namespace tactus::test
