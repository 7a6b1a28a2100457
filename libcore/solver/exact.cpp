// SPDX-License-Identifier: BSD-3-Clause
#include "solver/exact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::solver {

using support::Bitset;

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double settled = 1e-13;

}  // namespace

ExactSolver::ExactSolver(InstancePtr instance, double discount, std::size_t most_beliefs)
    : instance_(std::move(instance)),
      discount_(discount),
      most_beliefs_(most_beliefs),
      informed_(informed_costs(*instance_, discount)),
      pairs_(instance_->weight.size() * instance_->weight.size()) {}

std::optional<double> ExactSolver::value(std::size_t place, const Bitset& poses) {
  return within_limit([&] { return solved(place, poses); });
}

std::optional<double> ExactSolver::lower_bound(std::size_t place, const Bitset& poses) {
  return within_limit([&] { return bound(place, poses); });
}

double ExactSolver::informed(std::size_t place, const Bitset& poses) const {
  double sum = 0.0;
  poses.for_each([&](std::size_t pose) { sum += instance_->weight[pose] * informed_[place][pose]; });
  return sum / weight_of(*instance_, poses);
}

/// What was being solved when the limit was passed is half done, and not to be trusted.
template <typename Solve>
std::optional<double> ExactSolver::within_limit(Solve&& solve) {
  if (beliefs_ > most_beliefs_) return std::nullopt;
  try {
    return solve();
  } catch (const TooMany&) {
    return std::nullopt;
  }
}

double ExactSolver::solved(std::size_t place, const Bitset& poses) {
  const std::size_t count = poses.count();
  if (count == 1) return informed(place, poses);
  Layer& layer = count == 2 ? pairs_[poses.member(1) * poses.size() + poses.member(0)] : layers_[poses.hash()];
  if (layer.empty()) layer.assign(instance_->configurations.size(), unknown);
  if (std::isnan(layer[place])) solve(layer, place, poses);
  return layer[place];
}

/// The value at `place` and at wherever it may pay to move to first.
void ExactSolver::solve(Layer& layer, std::size_t place, const Bitset& poses) {
  const Layer known = layer;
  std::vector<std::size_t> places{place};
  std::vector<Move> moves;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (++beliefs_ > most_beliefs_) throw TooMany{};
    const std::size_t from = places[i];
    layer[from] = best_split(from, poses);
    for (const Move& move : moves_from(from, poses)) {
      const bool is_known = !std::isnan(known[move.to]);
      if (move.cost + discount_ * (is_known ? known[move.to] : quick_bound(move.to, poses)) >= layer[from]) continue;
      moves.push_back(move);
      if (!is_known && std::find(places.begin(), places.end(), move.to) == places.end()) places.push_back(move.to);
    }
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [from, to, cost] : moves)
      if (cost + discount_ * layer[to] < layer[from] - settled) {
        layer[from] = cost + discount_ * layer[to];
        changed = true;
      }
  }
}

std::vector<ExactSolver::Move> ExactSolver::moves_from(std::size_t place, const Bitset& poses) const {
  std::vector<Move> moves;
  for (const Instance::Results& results : instance_->configurations[place].results) {
    if (results.empty()) continue;
    const int to = results[poses.member(0)].to;
    const bool tells = !poses.all_of([&](std::size_t pose) { return results[pose].to == to; });
    if (tells || to == Instance::goal || to == static_cast<int>(place)) continue;
    moves.push_back({place, static_cast<std::size_t>(to), expected_cost(results, poses)});
  }
  return moves;
}

/// The least Q of the motions that part the poses or reach the goal with all of them.
double ExactSolver::best_split(std::size_t place, const Bitset& poses) {
  std::vector<std::pair<double, const Instance::Results*>> motions;
  for (const Instance::Results& results : instance_->configurations[place].results)
    if (!results.empty()) motions.emplace_back(informed_cost(results, poses), &results);
  std::stable_sort(motions.begin(), motions.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  double best = infinity;
  for (const auto& [least, results] : motions) {
    if (least >= best) break;
    auto outcomes = split(*results, poses);
    if (outcomes.size() == 1 && outcomes.begin()->first != Instance::goal) continue;
    const Weighed motion = weigh(*results, std::move(outcomes), poses);
    double q = motion.bound;
    for (const Child& child : motion.children) {
      if (q >= best) break;
      q += child.weight * (solved(child.place, *child.poses) - child.bound);
    }
    best = std::min(best, q);
  }
  return best;
}

/// Of a motion and what comes after it if the pose were known then.
double ExactSolver::informed_cost(const Instance::Results& results, const Bitset& poses) const {
  double sum = 0.0;
  poses.for_each([&](std::size_t pose) {
    const auto& [to, cost] = results[pose];
    const double ahead = to == Instance::goal ? 0.0 : informed_[static_cast<std::size_t>(to)][pose];
    sum += instance_->weight[pose] * (cost + discount_ * ahead);
  });
  return sum / weight_of(*instance_, poses);
}

ExactSolver::Weighed ExactSolver::weigh(const Instance::Results& results, std::map<int, Bitset> outcomes,
                                        const Bitset& poses) {
  Weighed motion{expected_cost(results, poses), {}, std::move(outcomes)};
  const double all = weight_of(*instance_, poses);
  for (const auto& [to, part] : motion.outcomes) {
    if (to == Instance::goal) continue;
    const auto there = static_cast<std::size_t>(to);
    motion.children.push_back({there, &part, discount_ * weight_of(*instance_, part) / all, bound(there, part)});
    motion.bound += motion.children.back().weight * motion.children.back().bound;
  }
  return motion;
}

double ExactSolver::expected_cost(const Instance::Results& results, const Bitset& poses) const {
  double sum = 0.0;
  poses.for_each([&](std::size_t pose) { sum += instance_->weight[pose] * results[pose].cost; });
  return sum / weight_of(*instance_, poses);
}

/// A belief is a mixture of pairs of its poses, each weighted by what the two weigh, and of the one that is left over.
double ExactSolver::bound(std::size_t place, const Bitset& poses) {
  constexpr std::size_t none = SIZE_MAX;
  double sum = 0.0;
  std::size_t first = none;
  poses.for_each([&](std::size_t pose) {
    if (first == none) {
      first = pose;
    } else {
      sum += (instance_->weight[first] + instance_->weight[pose]) * pair_value(place, pose, first);
      first = none;
    }
  });
  if (first != none) sum += instance_->weight[first] * informed_[place][first];
  return sum / weight_of(*instance_, poses);
}

/// A bound that does not ask for the values of pairs where these are what is being solved.
double ExactSolver::quick_bound(std::size_t place, const Bitset& poses) {
  return poses.count() == 2 ? informed(place, poses) : bound(place, poses);
}

double ExactSolver::pair_value(std::size_t place, std::size_t a, std::size_t b) {
  const Layer& layer = pairs_[a * instance_->weight.size() + b];
  if (!layer.empty() && !std::isnan(layer[place])) return layer[place];
  Bitset pair(instance_->weight.size());
  pair.set(a);
  pair.set(b);
  return solved(place, pair);
}

}  // namespace tactus::solver
