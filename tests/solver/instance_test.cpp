// SPDX-License-Identifier: BSD-3-Clause
#include "solver/instance.hpp"

#include <gtest/gtest.h>

#include <iostream>
#include <limits>
#include <set>

#include "solver/evaluation.hpp"
#include "solver/exact.hpp"
#include "solver/random_instance.hpp"
#include "solver/search.hpp"

/// Bounds, policies and the exact solver on random instances.
namespace tactus::test {
namespace {

using solver::ExactSolver;
using solver::Instance;
using solver::InstancePtr;
using solver::InstanceState;
using solver::Search;
using solver::Solver;
using support::Bitset;
using support::Deadline;
using support::Rng;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double exact = 1e-9;
constexpr int instances = 20;

const InstanceState& state_of(const Search& search, int node) {
  return dynamic_cast<const InstanceState&>(search.state(node));
}

solver::PlannerOptions options(Solver solver, std::uint64_t expansions) {
  solver::PlannerOptions made;
  made.solver = solver;
  made.budget_seconds = infinity;
  made.budget_expansions = expansions;
  return made;
}

/// All beliefs that can come about from the start, and value iteration over them: the plainest exact solver.
class PlainSolver {
 public:
  PlainSolver(const Instance& instance, double discount) : instance_(instance) {
    add(0, Bitset(instance.weight.size(), true));
    for (std::size_t i = 0; i < beliefs_.size(); ++i)
      for (const Instance::Results& results : instance.configurations[beliefs_[i].place].results)
        if (!results.empty()) add_motion(i, results);
    for (double change = 1.0; change > 1e-13;) {
      change = 0.0;
      for (Belief& belief : beliefs_) change = std::max(change, back_up(belief, discount));
    }
  }

  template <typename Visit>
  void for_each(Visit&& visit) const {
    for (const Belief& belief : beliefs_) visit(belief.place, belief.poses, belief.value);
  }

 private:
  struct Arrow {
    double probability, cost;
    int to;  ///< a belief; -1: the goal
  };
  struct Belief {
    std::size_t place;
    Bitset poses;
    std::vector<std::vector<Arrow>> motions;
    double value = 0.0;
  };

  int add(std::size_t place, const Bitset& poses) {
    const auto [entry, is_new] = index_.try_emplace({place, poses.words()}, static_cast<int>(beliefs_.size()));
    if (is_new) beliefs_.push_back({place, poses, {}});
    return entry->second;
  }

  void add_motion(std::size_t from, const Instance::Results& results) {
    std::map<int, std::vector<std::size_t>> groups;
    double all = 0.0;
    beliefs_[from].poses.for_each([&](std::size_t pose) {
      groups[results[pose].to].push_back(pose);
      all += instance_.weight[pose];
    });
    std::vector<Arrow> arrows;
    for (const auto& [to, group] : groups) {
      Arrow arrow{0.0, 0.0, -1};
      Bitset poses(instance_.weight.size());
      for (const std::size_t pose : group) {
        arrow.probability += instance_.weight[pose] / all;
        arrow.cost += instance_.weight[pose] / all * results[pose].cost;
        poses.set(pose);
      }
      if (to != Instance::goal) arrow.to = add(static_cast<std::size_t>(to), poses);
      arrows.push_back(arrow);
    }
    if (arrows.size() > 1 || arrows.front().to != static_cast<int>(from)) beliefs_[from].motions.push_back(arrows);
  }

  double back_up(Belief& belief, double discount) {
    double least = infinity;
    for (const std::vector<Arrow>& motion : belief.motions) {
      double q = 0.0;
      for (const Arrow& arrow : motion)
        q += arrow.cost +
             (arrow.to < 0 ? 0.0 : discount * arrow.probability * beliefs_[static_cast<std::size_t>(arrow.to)].value);
      least = std::min(least, q);
    }
    const double change = std::abs(least - belief.value);
    belief.value = least;
    return change;
  }

  const Instance& instance_;
  std::vector<Belief> beliefs_;
  std::map<std::pair<std::size_t, std::vector<std::uint64_t>>, int> index_;
};

TEST(ExactSolver, AgreesWithValueIterationOverAllBeliefs) {
  Rng rng(1);
  for (const double discount : {1.0, 0.999})
    for (int i = 0; i < 4; ++i) {
      const InstancePtr instance =
          random_instance(rng, {.poses = 6, .probes = 4, .configurations = 4, .equal_weights = i % 2 == 0});
      const PlainSolver plain(*instance, discount);
      ExactSolver solver(instance, discount);
      std::size_t checked = 0;
      plain.for_each([&](std::size_t place, const Bitset& poses, double value) {
        ASSERT_NEAR(*solver.value(place, poses), value, exact);
        ASSERT_LE(*solver.lower_bound(place, poses), value + exact);
        ++checked;
      });
      EXPECT_GT(checked, 50u);
    }
}

TEST(ExactSolver, SaysWhenThereAreTooManyBeliefs) {
  Rng rng(2);
  const InstancePtr instance = random_instance(rng);
  ExactSolver solver(instance, 1.0, 10);
  EXPECT_FALSE(solver.value(0, Bitset(instance->weight.size(), true)));
}

/// A solver with bounds: what it says of a belief, and the optimum.
TEST(Search, AdmissibleValuesAreBelowTheOptimumOfInstancesOfThirtyPoses) {
  Rng rng(3);
  double closest = 0.0, executed = 0.0;
  std::size_t met = 0, solved = 0;
  for (int i = 0; i < instances; ++i) {
    const InstancePtr instance = random_instance(rng, {.poses = 30 + rng.below(6), .equal_weights = i % 2 == 0});
    ASSERT_GE(instance->motions.size(), 50u);
    ExactSolver solver(instance, 1.0);
    Search search(InstanceState::start(instance), {0.5, 8});
    Deadline deadline(infinity, 100);
    search.run(deadline);
    for (int node = 0; node < static_cast<int>(search.size()); ++node) {
      const InstanceState& state = state_of(search, node);
      const auto best = solver.value(state.place(), state.poses());
      ASSERT_TRUE(best);
      ASSERT_LE(search.value(node, solver::ValueType::admissible), *best + exact);
      ++met;
    }
    const double best = *solver.value(0, Bitset(instance->weight.size(), true));
    auto undiscounted = *instance;
    undiscounted.discount = 1.0;
    const auto run = evaluate(std::make_shared<const Instance>(undiscounted), options(Solver::rtdp_bel, 100));
    ASSERT_NEAR(run.inserted, 1.0, exact);
    ASSERT_GE(run.expected_cost, best - exact);
    closest += search.value(0, solver::ValueType::admissible) / best / instances;
    executed += run.expected_cost / best / instances;
    solved += solver.beliefs();
  }
  std::cout << met << " beliefs met, " << solved << " solved; lower bound / optimum " << closest
            << ", executed cost / optimum " << executed << "\n";
}

}  // namespace
}  // namespace tactus::test
