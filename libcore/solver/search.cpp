// SPDX-License-Identifier: BSD-3-Clause
#include "solver/search.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::solver {
namespace {

constexpr double value_change = 1e-9;
constexpr int most_idle = 1000;  // trials without an expansion: values may climb for ever where no goal can be reached

std::size_t most_likely(const Choice& choice) {
  const auto found = std::max_element(choice.outcomes.begin(), choice.outcomes.end(),
                                      [](const Outcome& a, const Outcome& b) { return a.probability < b.probability; });
  return static_cast<std::size_t>(found - choice.outcomes.begin());
}

}  // namespace

double Choice::expected_total() const {
  double sum = expected_cost();
  for (const Outcome& outcome : outcomes)
    sum += outcome.probability * outcome.heuristic[static_cast<int>(ValueType::inadmissible)];
  return sum;
}

Choice charged(Choice choice, double more) {
  for (Outcome& outcome : choice.outcomes) outcome.cost += more;
  return choice;
}

Choice BeliefState::realised(const Choice& choice, const action::Action& /*made*/, double more,
                             const support::Deadline& /*deadline*/) const {
  return charged(choice, more);
}

double Choice::expected_cost() const {
  double sum = 0.0;
  for (const Outcome& outcome : outcomes) sum += outcome.probability * outcome.cost;
  return sum;
}

double Choice::contact_probability() const {
  double sum = 0.0;
  for (const Outcome& outcome : outcomes)
    if (outcome.waypoint < motion->path.size()) sum += outcome.probability;
  return std::min(1.0, sum);
}

double Choice::goal_probability() const {
  double sum = 0.0;
  for (const Outcome& outcome : outcomes)
    if (outcome.goal) sum += outcome.probability;
  return std::min(1.0, sum);
}

double Choice::information() const {
  double bits = 0.0;
  for (const Outcome& outcome : outcomes)
    if (outcome.probability > 0.0)
      bits -= outcome.probability * std::log2(outcome.possible > 0.0 ? outcome.possible : outcome.probability);
  return bits;
}

double greedy_cost_per_bit(const std::vector<double>& expected_cost, const std::vector<double>& expected_bits,
                           double least) {
  constexpr double overestimate = 1.5;
  double lowest = 1e300;
  for (std::size_t i = 0; i < expected_cost.size(); ++i)
    if (expected_bits[i] > 1e-9) lowest = std::min(lowest, expected_cost[i] / expected_bits[i]);
  return lowest < 1e300 ? std::max(least, overestimate * lowest) : least;
}

void price_bits(std::vector<Choice>& choices, double cost_per_bit) {
  for (Choice& choice : choices)
    for (Outcome& outcome : choice.outcomes)
      outcome.heuristic[1] = outcome.heuristic[0] + cost_per_bit * (outcome.heuristic[1] - outcome.heuristic[0]);
}

Search::Search(BeliefStatePtr start_state, const SearchOptions& options) : options_(options) {
  intern(std::move(start_state));
}

void Search::run(support::Deadline& deadline) {
  if (!nodes_[start].expanded) expand(start, deadline);
  try {
    trials(deadline);
  } catch (const support::OutOfTime&) {
    // What was to be found out is not known; all else is as it was.
  }
}

void Search::trials(support::Deadline& deadline) {
  bool admissible_done = options_.epsilon <= 0.0;
  int idle = 0;
  while (!deadline.spent() && !converged()) {
    const bool explore = !admissible_done && deadline.used_fraction() < options_.epsilon;
    const std::uint64_t before = deadline.expansions();
    const bool changed = trial(deadline, explore ? ValueType::admissible : ValueType::inadmissible);
    idle = deadline.expansions() == before ? idle + 1 : 0;
    if (changed && idle < most_idle) continue;
    idle = 0;
    if (!explore) break;
    admissible_done = true;
    if (options_.epsilon >= 1.0) break;
  }
}

/// U - L at the start is small enough.
bool Search::converged() const {
  const Values& at_start = nodes_[start].value;
  return options_.bounded && at_start[1] - at_start[0] <= options_.gap * at_start[0];
}

/// One trial; says whether it changed anything.
bool Search::trial(support::Deadline& deadline, ValueType guide) {
  bool changed = false;
  std::vector<int> passed;
  int node = start;
  for (int depth = 0; depth < options_.horizon && !deadline.spent(); ++depth) {
    if (!nodes_[node].expanded) {
      if (!expand(node, deadline)) break;
      changed = true;
    }
    changed = update(node) || changed;
    passed.push_back(node);
    const auto choice = best_by(node, guide);
    if (!choice) break;
    const auto outcome = outcome_to_follow(node, *choice);
    if (!outcome) break;
    node = follow(node, *choice, *outcome);
  }
  if (options_.bounded)
    for (std::size_t i = passed.size(); i-- > 0;) changed = update(passed[i]) || changed;
  return changed;
}

/// The most likely one, or the one with the largest P (U - L); none if that leads to the goal, or nowhere.
std::optional<std::size_t> Search::outcome_to_follow(int node, std::size_t choice) const {
  const Choice& taken = nodes_[node].choices[choice];
  if (!options_.bounded) {
    const std::size_t outcome = most_likely(taken);
    return taken.outcomes[outcome].goal ? std::nullopt : std::optional(outcome);
  }
  std::optional<std::size_t> widest;
  double most = value_change;
  for (std::size_t z = 0; z < taken.outcomes.size(); ++z) {
    if (taken.outcomes[z].goal) continue;
    const double gap = ahead(node, choice, z, ValueType::inadmissible) - ahead(node, choice, z, ValueType::admissible);
    if (taken.outcomes[z].probability * gap > most) most = taken.outcomes[z].probability * gap, widest = z;
  }
  return widest;
}

/// What there was not time for is left undone. At the start what was weighed is kept, and if it may not be all, says
/// nothing of what is the least possible.
bool Search::expand(int index, support::Deadline& deadline) {
  Node& node = nodes_[index];
  std::vector<Choice> choices = node.state->choices(deadline);
  const bool is_cut_short = deadline.spent();
  if (is_cut_short && index != start) return false;
  node.choices = std::move(choices);
  for (const Choice& choice : node.choices) node.children.emplace_back(choice.outcomes.size(), -1);
  node.expanded = true;
  deadline.count_expansion();
  const double least = node.value[static_cast<int>(ValueType::admissible)];
  update(index);
  if (is_cut_short) node.value[static_cast<int>(ValueType::admissible)] = least;
  return true;
}

/// V(b) := min over a of Q(b, a), for both types.
bool Search::update(int index) {
  bool changed = false;
  for (const ValueType type : {ValueType::admissible, ValueType::inadmissible}) {
    const auto choice = best_by(index, type);
    if (!choice) continue;
    double& stored = nodes_[index].value[static_cast<int>(type)];
    double value = q_value(index, *choice, type);
    if (options_.bounded) value = type == ValueType::admissible ? std::max(value, stored) : std::min(value, stored);
    changed = changed || std::abs(value - stored) > value_change;
    stored = value;
  }
  return changed;
}

/// V(b_a^z), or the heuristic where no value is known.
double Search::ahead(int index, std::size_t choice, std::size_t outcome, ValueType type) const {
  const Node& node = nodes_[index];
  const int child_index = node.children[choice][outcome];
  return child_index >= 0 ? value(child_index, type)
                          : node.choices[choice].outcomes[outcome].heuristic[static_cast<int>(type)];
}

/// Q(b, a) = C(b, a) + sum over z of P(z | b, a) V(b_a^z).
double Search::q_value(int index, std::size_t choice, ValueType type) const {
  const std::vector<Outcome>& outcomes = nodes_[index].choices[choice].outcomes;
  double sum = 0.0;
  for (std::size_t z = 0; z < outcomes.size(); ++z)
    sum += outcomes[z].probability * (outcomes[z].cost + ahead(index, choice, z, type));
  return sum;
}

std::optional<std::size_t> Search::best_by(int index, ValueType type, const std::vector<bool>& banned) const {
  std::optional<std::size_t> best;
  double lowest = 1e300;
  for (std::size_t choice = 0; choice < nodes_[index].choices.size(); ++choice) {
    if (choice < banned.size() && banned[choice]) continue;
    const double q = q_value(index, choice, type);
    if (q < lowest) lowest = q, best = choice;
  }
  return best;
}

std::optional<std::size_t> Search::best(int node, const std::vector<bool>& banned) const {
  return best_by(node, executed_by(), banned);
}

void Search::reweigh(int node, std::size_t choice, Choice weighed) {
  Choice& known = nodes_[node].choices[choice];
  if (weighed.motion != known.motion) nodes_[node].children[choice].assign(weighed.outcomes.size(), -1);
  known = std::move(weighed);
}

int Search::follow(int index, std::size_t choice, std::size_t outcome) {
  const int known = nodes_[index].children[choice][outcome];
  if (known >= 0) return known;
  const Choice& taken = nodes_[index].choices[choice];
  const int next = intern(nodes_[index].state->successor(taken, taken.outcomes[outcome]));
  nodes_[index].children[choice][outcome] = next;
  return next;
}

int Search::intern(BeliefStatePtr state) {
  const support::Hash128 hash = state->hash();
  if (const auto known = index_.find(hash); known != index_.end()) return known->second;
  Node node;
  node.value = state->heuristic();
  node.state = std::move(state);
  nodes_.push_back(std::move(node));
  return index_.emplace(hash, static_cast<int>(nodes_.size()) - 1).first->second;
}

}  // namespace tactus::solver
