// SPDX-License-Identifier: BSD-3-Clause
#include "solver/walk_policy.hpp"

#include <algorithm>

namespace tactus::solver {

using action::MotionPtr;
using geometry::Pose;
using support::Bitset;

WalkPolicy::WalkPolicy(std::shared_ptr<const action::Task> task, std::shared_ptr<const action::Lattice> lattice,
                       Predictions& predictions, RatePolicy& after, const Pose& base_from_tool, int dimensions)
    : predictions_(predictions),
      after_(after),
      dimensions_(dimensions),
      walks_(std::move(task), std::move(lattice), predictions),
      first_(walks_.best_in_time(Bitset(predictions_.poses().size(), true), base_from_tool, thorough)),
      costs_after_(walks_.lattice().size() * action::Lattice::directions) {
  walks_.look_ahead_as_on(first_);
}

/// By pose that it touches, the rest of what it costs from the step's beginning: as if all were still possible that the
/// step touches.
const std::vector<double>& WalkPolicy::after_step(std::size_t place, std::size_t direction) {
  std::vector<double>& known = costs_after_[place * action::Lattice::directions + direction];
  if (!known.empty()) return known;
  const MotionPtr motion = walks_.lattice().step(place, direction, predictions_.cancellation());
  std::vector<double> costs(predictions_.poses().size(), 0.0);
  const Bitset& met = walks_.step(place, direction).touched;
  for (const Group& group : predictions_.split(motion, met, least_group(met.count(), dimensions_))) {
    if (group.first >= motion->path.size()) continue;
    RatePolicy::Members poses;
    for (const std::size_t pose : group.poses)
      if (met.test(pose)) poses.push_back(pose);
    if (poses.empty()) continue;
    const std::vector<double> then = after_.costs(poses, motion->bodies.base_from_body(group.first - 1, 0));
    for (std::size_t i = 0; i < poses.size(); ++i) costs[poses[i]] = motion->cost_to[group.first] + then[i];
  }
  return known = std::move(costs);
}

double WalkPolicy::cost(const Members& members, const Pose& base_from_tool, std::size_t beam) {
  Bitset all(predictions_.poses().size());
  for (const std::size_t member : members) all.set(member);
  const double cost = cost_of(walks_.best(all, base_from_tool, beam), all, base_from_tool);
  const auto rest = walks_.rest(first_, base_from_tool);
  return rest ? std::min(cost, cost_of(*rest, all, base_from_tool)) : cost;
}

/// Of the walk, what follows where it touches, and what is left to do at its end.
double WalkPolicy::cost_of(const Walk& walk, Bitset left, const Pose& base_from_tool) {
  const auto total = static_cast<double>(left.count());
  double spent = walk.entry, sum = 0.0;
  Pose end = base_from_tool;
  for (const auto& [place, direction] : walk.steps) {
    const Walks::Step& step = walks_.step(place, direction);
    Bitset met = left;
    met &= step.touched;
    if (!met.none()) {
      const std::vector<double>& after = after_step(place, direction);
      met.for_each([&](std::size_t pose) { sum += spent + after[pose]; });
      left.and_not(met);
    }
    spent += step.cost;
    end = walks_.lattice().base_from_tool(step.to);
  }
  Members missing;
  left.for_each([&](std::size_t pose) { missing.push_back(pose); });
  if (!missing.empty()) sum += static_cast<double>(missing.size()) * (spent + after_.cost(missing, end));
  return sum / total;
}

}  // namespace tactus::solver
