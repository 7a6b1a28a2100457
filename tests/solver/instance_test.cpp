// SPDX-License-Identifier: BSD-3-Clause
#include "solver/instance.hpp"

#include <gtest/gtest.h>

#include <iostream>
#include <limits>
#include <map>

#include "solver/evaluation.hpp"
#include "solver/exact.hpp"
#include "solver/greedy.hpp"
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
using solver::ValueType;
using support::Bitset;
using support::Deadline;
using support::Rng;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double exact = 1e-9;
constexpr int instances = 20;

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
          random_instance(rng, {.poses = 7, .probes = 5, .configurations = 5, .equal_weights = i % 2 == 0});
      const PlainSolver plain(*instance, discount);
      ExactSolver solver(instance, discount);
      std::size_t checked = 0;
      plain.for_each([&](std::size_t place, const Bitset& poses, double value) {
        ASSERT_NEAR(*solver.value(place, poses), value, exact);
        ASSERT_LE(*solver.lower_bound(place, poses), value + exact);
        ASSERT_LE(solver.informed(place, poses), *solver.lower_bound(place, poses) + exact);
        ++checked;
      });
      EXPECT_GT(checked, 50u);
    }
}

TEST(ExactSolver, SaysWhenThereAreTooManyBeliefs) {
  Rng rng(2);
  const InstancePtr instance = random_instance(rng);
  ExactSolver solver(instance, 1.0, 10);
  const Bitset all(instance->weight.size(), true);
  EXPECT_FALSE(solver.value(0, all));
  EXPECT_FALSE(solver.value(0, all)) << "nor later, from what was left half done";
  EXPECT_FALSE(solver.lower_bound(0, all));
}

Bitset all_poses(const Instance& instance) { return Bitset(instance.weight.size(), true); }

/// Of thirty poses and more, fifty-five motions and more, undiscounted as the search is.
std::vector<InstancePtr> instances_of_thirty_poses() {
  Rng rng(3);
  std::vector<InstancePtr> made;
  for (int i = 0; i < instances; ++i) {
    Instance instance = *random_instance(rng, {.poses = 30 + rng.below(6), .equal_weights = i % 2 == 0});
    instance.discount = 1.0;
    made.push_back(std::make_shared<const Instance>(std::move(instance)));
  }
  return made;
}

/// L <= V* <= U at every belief that a search has met, where `bounds(node)` says what it knows of each.
template <typename Searched, typename Bounds>
std::size_t expect_bounds(const Searched& search, ExactSolver& solver, Bounds&& bounds) {
  for (int node = 0; node < static_cast<int>(search.size()); ++node) {
    const auto& state = dynamic_cast<const InstanceState&>(search.state(node));
    const auto best = solver.value(state.place(), state.poses());
    const auto [lower, upper] = bounds(node);
    EXPECT_TRUE(best);
    EXPECT_LE(lower, best.value_or(infinity) + exact);
    EXPECT_GE(upper, best.value_or(-infinity) - exact);
  }
  return search.size();
}

TEST(Search, AdmissibleValuesAreBelowTheOptimumAtEveryBeliefMet) {
  std::size_t met = 0, solved = 0;
  double closeness = 0.0;
  for (const InstancePtr& instance : instances_of_thirty_poses()) {
    ASSERT_GE(instance->weight.size(), 30u);
    ASSERT_GE(instance->motions.size(), 50u);
    ExactSolver solver(instance, 1.0);
    Search search(InstanceState::start(instance), {0.5, 8});
    Deadline deadline(infinity, 100);
    search.run(deadline);
    met += expect_bounds(search, solver,
                         [&](int node) { return std::pair(search.value(node, ValueType::admissible), infinity); });
    closeness += search.value(0, ValueType::admissible) / *solver.value(0, all_poses(*instance)) / instances;
    solved += solver.beliefs();
  }
  EXPECT_GT(met, 20u * instances);
  std::cout << met << " beliefs met, " << solved << " solved; lower bound / optimum at the start " << closeness << "\n";
}

TEST(BoundedSearch, KeepsTheOptimumBetweenItsBoundsAtEveryBeliefMet) {
  std::size_t met = 0;
  double certificate = 0.0;
  for (const InstancePtr& instance : instances_of_thirty_poses()) {
    ExactSolver solver(instance, 1.0);
    Search search(InstanceState::start(instance, solver::SecondValue::upper_bound),
                  solver::search_options(options(Solver::brtdp_bel, 100)));
    Deadline deadline(infinity, 100);
    search.run(deadline);
    met += expect_bounds(search, solver, [&](int node) {
      return std::pair(search.value(node, ValueType::admissible), search.value(node, ValueType::inadmissible));
    });
    certificate += search.value(0, ValueType::inadmissible) / search.value(0, ValueType::admissible) / instances;
  }
  EXPECT_GT(met, 20u * instances);
  std::cout << met << " beliefs met; upper / lower bound at the start " << certificate << "\n";
}

TEST(Evaluation, NoPolicyBeatsTheOptimum) {
  const std::vector<solver::PlannerOptions> policies{options(Solver::rtdp_bel, 30),   options(Solver::rtdp_bel, 100),
                                                     options(Solver::brtdp_bel, 30),  options(Solver::brtdp_bel, 100),
                                                     options(Solver::rtdp_inad, 100), options(Solver::rate, 1),
                                                     options(Solver::tbl, 1)};
  std::vector<double> ratio(policies.size(), 0.0);
  for (const InstancePtr& instance : instances_of_thirty_poses()) {
    ExactSolver solver(instance, 1.0);
    const double best = *solver.value(0, all_poses(*instance));
    for (std::size_t i = 0; i < policies.size(); ++i) {
      const solver::Evaluation run = evaluate(instance, policies[i]);
      ASSERT_NEAR(run.inserted, 1.0, exact);
      ASSERT_GE(run.expected_cost, best - exact);
      ASSERT_LE(run.lower_bound, best + exact);
      ratio[i] += run.expected_cost / best / instances;
    }
  }
  for (std::size_t i = 0; i < policies.size(); ++i)
    std::cout << name_of(policies[i].solver) << ", " << policies[i].budget_expansions << " expansions: cost / optimum "
              << ratio[i] << "\n";
  EXPECT_LT(ratio[0], 1.05);
  EXPECT_LT(ratio[1], 1.05);
}

/// One pose after the other, by the rule as it stands.
TEST(Evaluation, IsWhatRunningThePolicyAtEachPoseCosts) {
  Rng rng(4);
  const InstancePtr instance = random_instance(rng, {.equal_weights = false});
  double expected = 0.0, worst = 0.0;
  for (std::size_t pose = 0; pose < instance->weight.size(); ++pose) {
    double cost = 0.0, discount = 1.0;
    auto state = InstanceState::start(instance);
    for (int to = 0; to != Instance::goal; discount *= instance->discount) {
      const auto choices = state->choices(support::Deadline::unlimited());
      const auto& choice = choices.at(*solver::greedy_choice(choices, solver::Greedy::rate));
      const auto& results = instance->configurations[state->place()].results[state->motion_of(choice)];
      cost += discount * results[pose].cost;
      to = results[pose].to;
      if (to != Instance::goal) state = state->at(static_cast<std::size_t>(to), split(results, state->poses()).at(to));
    }
    expected += instance->weight[pose] * cost;
    worst = std::max(worst, cost);
  }
  const solver::Evaluation run = evaluate(instance, options(Solver::rate, 1));
  EXPECT_NEAR(run.expected_cost, expected, exact);
  EXPECT_NEAR(run.worst_cost, worst, exact);
}

}  // namespace
}  // namespace tactus::test
