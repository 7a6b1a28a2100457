// SPDX-License-Identifier: BSD-3-Clause
#include "solver/evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace tactus::solver {
namespace {

using support::Bitset;
using support::Deadline;
using State = std::shared_ptr<const InstanceState>;

constexpr int most_motions = 1000;  // after which a policy that goes in circles is given up

/// What a policy does at a belief: a motion's index.
using Decision = std::optional<std::size_t>;

/// A solver's policy on one instance, and the tally of running it.
class Run {
 public:
  Run(const InstancePtr& instance, const PlannerOptions& options)
      : instance_(*instance),
        options_(options),
        cost_(instance->weight.size(), 0.0),
        inserted_(instance->weight.size()) {
    follow(InstanceState::start(instance, second_value_of(options.solver)), 1.0, 0);
  }

  Evaluation result() {
    for (std::size_t pose = 0; pose < cost_.size(); ++pose)
      result_.expected_cost += instance_.weight[pose] * cost_[pose];
    result_.worst_cost = *std::max_element(cost_.begin(), cost_.end());
    result_.inserted = weight_of(instance_, inserted_);
    return result_;
  }

 private:
  /// The rest of the runs whose target is at one of the belief's poses.
  void follow(const State& state, double discount, int motions) {
    const Decision motion = motions < most_motions ? decide(state) : std::nullopt;
    if (!motion) return;
    const Instance::Results& results = instance_.configurations[state->place()].results[*motion];
    state->poses().for_each([&](std::size_t pose) { cost_[pose] += discount * results[pose].cost; });
    for (const auto& [to, poses] : split(results, state->poses())) {
      if (to == Instance::goal)
        inserted_ |= poses;
      else
        follow(state->at(static_cast<std::size_t>(to), poses), discount * instance_.discount, motions + 1);
    }
  }

  Decision decide(const State& state) {
    const auto [known, is_new] = policy_.try_emplace(state->hash());
    if (!is_new) return known->second;
    const Search search = planned(state);
    if (result_.plans++ == 0) note_bounds(search);
    const auto rule = greedy_of(options_.solver);
    const std::vector<Choice>& choices = search.choices(Search::start);
    const auto choice = rule ? greedy_choice(choices, *rule) : search.best(Search::start);
    if (choice) known->second = state->motion_of(choices[*choice]);
    return known->second;
  }

  void note_bounds(const Search& search) {
    result_.lower_bound = search.value(Search::start, ValueType::admissible);
    result_.value = search.value(Search::start, ValueType::inadmissible);
  }

  Search planned(const State& state) {
    Search search(state, search_options(options_));
    Deadline deadline(options_.budget_seconds,
                      options_.budget_expansions == 0 ? UINT64_MAX : options_.budget_expansions);
    if (greedy_of(options_.solver))
      search.expand_start(deadline);
    else
      search.run(deadline);
    result_.expansions += deadline.expansions();
    return search;
  }

  struct HashOf {
    std::size_t operator()(const support::Hash128& h) const { return h.low; }
  };

  const Instance& instance_;
  const PlannerOptions& options_;
  std::unordered_map<support::Hash128, Decision, HashOf> policy_;
  std::vector<double> cost_;
  Bitset inserted_;
  Evaluation result_;
};

}  // namespace

Evaluation evaluate(const InstancePtr& instance, const PlannerOptions& options) {
  check(options);
  return Run(instance, options).result();
}

}  // namespace tactus::solver
