// SPDX-License-Identifier: BSD-3-Clause
#include "solver/instance.hpp"

#include <cmath>
#include <limits>

namespace tactus::solver {

using support::Bitset;

namespace {

constexpr double settled = 1e-13;
constexpr double least_cost_per_bit = 0.035;
constexpr double least_bits = 1e-9;

/// A motion with the target at one pose, and what it costs to the end by it; none where the goal can't be reached.
struct Step {
  std::optional<std::size_t> motion;
  double cost = std::numeric_limits<double>::infinity();
};

/// The best of those that take the robot elsewhere.
Step best_step(const Instance& instance, std::size_t place, std::size_t pose, double discount,
               const std::vector<std::vector<double>>& informed) {
  Step best;
  const std::vector<Instance::Results>& motions = instance.configurations[place].results;
  for (std::size_t motion = 0; motion < motions.size(); ++motion) {
    if (motions[motion].empty() || motions[motion][pose].to == static_cast<int>(place)) continue;
    const auto& [to, cost] = motions[motion][pose];
    const double to_goal = to == Instance::goal ? 0.0 : informed[static_cast<std::size_t>(to)][pose];
    if (cost + discount * to_goal < best.cost) best = {motion, cost + discount * to_goal};
  }
  return best;
}

}  // namespace

std::map<int, Bitset> split(const Instance::Results& results, const Bitset& poses) {
  std::map<int, Bitset> outcomes;
  poses.for_each(
      [&](std::size_t pose) { outcomes.try_emplace(results[pose].to, poses.size()).first->second.set(pose); });
  return outcomes;
}

bool is_idle(const std::map<int, Bitset>& outcomes, std::size_t configuration) {
  return outcomes.size() == 1 && outcomes.begin()->first == static_cast<int>(configuration);
}

double weight_of(const Instance& instance, const Bitset& poses) {
  double sum = 0.0;
  poses.for_each([&](std::size_t pose) { sum += instance.weight[pose]; });
  return sum;
}

std::vector<std::vector<double>> informed_costs(const Instance& instance, double discount) {
  const std::size_t places = instance.configurations.size(), poses = instance.weight.size();
  std::vector<std::vector<double>> cost(places, std::vector<double>(poses, std::numeric_limits<double>::infinity()));
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t place = 0; place < places; ++place)
      for (std::size_t pose = 0; pose < poses; ++pose) {
        const double best = best_step(instance, place, pose, discount, cost).cost;
        if (!(best < cost[place][pose] - settled)) continue;
        cost[place][pose] = best;
        changed = true;
      }
  }
  return cost;
}

std::shared_ptr<const InstanceState> InstanceState::start(InstancePtr instance, SecondValue second) {
  const Bitset all(instance->weight.size(), true);
  auto shared =
      std::make_shared<Shared>(Shared{instance, informed_costs(*instance, 1.0), second, least_cost_per_bit, {}});
  auto state = std::make_shared<const InstanceState>(shared, 0, all);
  std::vector<double> cost, gained;
  for (const Choice& choice : state->choices(support::Deadline::unlimited())) {
    cost.push_back(choice.expected_cost());
    gained.push_back(choice.information());
  }
  shared->cost_per_bit = greedy_cost_per_bit(cost, gained, least_cost_per_bit);
  return state;
}

std::vector<Choice> InstanceState::choices(const support::Deadline&) const {
  std::vector<Choice> result;
  const Instance::Configuration& here = instance().configurations[place_];
  for (std::size_t motion = 0; motion < here.results.size(); ++motion) {
    if (here.results[motion].empty()) continue;
    const auto outcomes = split(here.results[motion], poses_);
    if (is_idle(outcomes, place_)) continue;
    result.emplace_back();
    for (const auto& [to, poses] : outcomes) result.back().outcomes.push_back(outcome(motion, to, poses));
  }
  return result;
}

Outcome InstanceState::outcome(std::size_t motion, int to, const Bitset& poses) const {
  const Instance::Results& results = instance().configurations[place_].results[motion];
  const double weight = weight_of(instance(), poses);
  Outcome made;
  made.waypoint = made.last = motion * ends() + static_cast<std::size_t>(to + 1);
  made.probability = weight / weight_of(instance(), poses_);
  poses.for_each([&](std::size_t pose) { made.cost += instance().weight[pose] / weight * results[pose].cost; });
  made.goal = to == Instance::goal;
  if (!made.goal) made.heuristic = values(static_cast<std::size_t>(to), poses);
  return made;
}

BeliefStatePtr InstanceState::successor(const Choice& choice, const Outcome& outcome) const {
  const int to = static_cast<int>(outcome.waypoint % ends()) - 1;
  const auto outcomes = split(instance().configurations[place_].results[motion_of(choice)], poses_);
  return at(static_cast<std::size_t>(to), outcomes.at(to));
}

std::size_t InstanceState::motion_of(const Choice& choice) const { return choice.outcomes.front().waypoint / ends(); }

/// h_ad is the mean cost with the pose known; h_inad adds what the missing bits are worth, or is an upper bound.
Values InstanceState::values(std::size_t place, const Bitset& poses) const {
  const double weight = weight_of(instance(), poses);
  double informed = 0.0, bits = 0.0;
  poses.for_each([&](std::size_t pose) {
    const double share = instance().weight[pose] / weight;
    informed += share * shared_->informed[place][pose];
    bits -= share * std::log2(share);
  });
  if (shared_->second == SecondValue::upper_bound) return {informed, upper_bound(place, poses)};
  return {informed, informed + shared_->cost_per_bit * bits};
}

/// The better of two steps, and so on to the end: the motion with the best rate of bits to cost, and the first on the
/// way to the goal were the target at the nearest pose. The one leaves fewer poses, the other brings that one nearer.
double InstanceState::upper_bound(std::size_t place, const Bitset& poses) const {
  const auto key = std::pair(place, poses.words());
  if (const auto known = shared_->upper.find(key); known != shared_->upper.end()) return known->second;
  double least = cost_of(motion_towards_nearest(place, poses), place, poses);
  if (const auto motion = motion_of_best_rate(place, poses)) least = std::min(least, cost_of(*motion, place, poses));
  return shared_->upper.try_emplace(key, least).first->second;
}

double InstanceState::cost_of(std::size_t motion, std::size_t place, const Bitset& poses) const {
  const Instance::Results& results = instance().configurations[place].results[motion];
  double sum = 0.0;
  poses.for_each([&](std::size_t pose) { sum += instance().weight[pose] * results[pose].cost; });
  for (const auto& [to, left] : split(results, poses))
    if (to != Instance::goal) sum += weight_of(instance(), left) * upper_bound(static_cast<std::size_t>(to), left);
  return sum / weight_of(instance(), poses);
}

std::size_t InstanceState::motion_towards_nearest(std::size_t place, const Bitset& poses) const {
  std::size_t nearest = poses.size();
  poses.for_each([&](std::size_t pose) {
    if (nearest == poses.size() || shared_->informed[place][pose] < shared_->informed[place][nearest]) nearest = pose;
  });
  return *best_step(instance(), place, nearest, 1.0, shared_->informed).motion;
}

std::optional<std::size_t> InstanceState::motion_of_best_rate(std::size_t place, const Bitset& poses) const {
  std::optional<std::size_t> best;
  double highest = 0.0;
  const double total = weight_of(instance(), poses);
  const std::vector<Instance::Results>& motions = instance().configurations[place].results;
  for (std::size_t motion = 0; motion < motions.size(); ++motion) {
    if (motions[motion].empty()) continue;
    double bits = 0.0, cost = 0.0;
    for (const auto& [to, left] : split(motions[motion], poses)) {
      const double share = weight_of(instance(), left) / total;
      bits -= share * std::log2(share);
      left.for_each([&](std::size_t pose) { cost += instance().weight[pose] / total * motions[motion][pose].cost; });
    }
    if (bits > least_bits && bits / cost > highest) highest = bits / cost, best = motion;
  }
  return best;
}

}  // namespace tactus::solver
