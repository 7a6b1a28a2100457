// SPDX-License-Identifier: BSD-3-Clause
#include "solver/walk_policy.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::solver {
namespace {

using action::MotionPtr;
using geometry::Pose;
using support::Bitset;

constexpr double blocked = 1e300;
constexpr std::size_t beam = 24;
constexpr double near_by = 0.08;        // m to the nearest place, which a walk may begin at then
constexpr int longest_walk = 160;       // steps
constexpr double least_missing = 0.02;  // share of the poses for which a walk does not go on
constexpr double given_up = 2.0;        // m that it is worth to walk rather than leave a pose untouched

}  // namespace

WalkPolicy::WalkPolicy(std::shared_ptr<const action::Task> task, std::shared_ptr<const action::Lattice> lattice,
                       Predictions& predictions, RatePolicy& after, const Pose& base_from_tool, int dimensions)
    : task_(std::move(task)),
      lattice_(std::move(lattice)),
      predictions_(predictions),
      after_(after),
      dimensions_(dimensions),
      touched_(lattice_->size() * action::Lattice::directions),
      costs_after_(touched_.size()),
      step_costs_(touched_.size()) {
  const Bitset all(predictions_.poses().size(), true);
  const Walk first = best_walk(all, base_from_tool, to_go_);
  double length = 0.0, found = 0.0;
  Bitset left = all;
  for (const auto& [place, direction] : first.steps) {
    const std::size_t before = left.count();
    left.and_not(touched(place, direction));
    length += *step_cost(place, direction);
    found += static_cast<double>(before - left.count()) * length;
  }
  const std::size_t count = all.count() - left.count();
  if (count > 0) to_go_ = found / static_cast<double>(count);
}

/// What a way costs that is gone in the longest small moves.
double WalkPolicy::with_actions(double way) const {
  const action::TaskOptions& options = task_->options();
  const std::vector<double>& lengths = options.actions.primitive_lengths;
  const double longest = lengths.empty() ? 0.0 : options.cost.metre * *std::max_element(lengths.begin(), lengths.end());
  return longest > 0.0 ? way * (1.0 + options.cost.action / longest) : way;
}

/// None where it is blocked. On the retreat plane no way is looked for, and nothing touched.
std::optional<double> WalkPolicy::step_cost(std::size_t place, std::size_t direction) const {
  std::optional<double>& cost = step_costs_[place * action::Lattice::directions + direction];
  if (!cost) {
    const auto next = lattice_->neighbour(place, direction);
    const bool is_across = next && lattice_->is_on_plane(place) && lattice_->is_on_plane(*next);
    const MotionPtr step = next && !is_across ? lattice_->step(place, direction) : nullptr;
    cost = is_across ? with_actions(task_->options().cost.metre * lattice_->pitch())
           : step    ? with_actions(step->cost_to.back())
                     : blocked;
  }
  return *cost < blocked ? cost : std::nullopt;
}

const Bitset& WalkPolicy::touched(std::size_t place, std::size_t direction) const {
  Bitset& set = touched_[place * action::Lattice::directions + direction];
  if (set.size() == 0) {
    set = Bitset(predictions_.poses().size());
    if (lattice_->is_on_plane(place) && lattice_->is_on_plane(*lattice_->neighbour(place, direction))) return set;
    const MotionPtr step = lattice_->step(place, direction);
    const std::vector<std::int32_t>& first_contacts = predictions_.first_contacts(step);
    for (std::size_t pose = 0; pose < first_contacts.size(); ++pose)
      if (first_contacts[pose] < static_cast<std::int32_t>(step->path.size())) set.set(pose);
  }
  return set;
}

/// By pose that it touches, the rest of what it costs from the step's beginning: as if all were still possible that the
/// step touches.
const std::vector<double>& WalkPolicy::after_step(std::size_t place, std::size_t direction) {
  std::vector<double>& costs = costs_after_[place * action::Lattice::directions + direction];
  if (!costs.empty()) return costs;
  const MotionPtr step = lattice_->step(place, direction);
  costs.assign(predictions_.poses().size(), 0.0);
  const Bitset& met = touched(place, direction);
  for (const Group& group : predictions_.split(step, met, least_group(met.count(), dimensions_))) {
    if (group.first >= step->path.size()) continue;
    RatePolicy::Members poses;
    for (const std::size_t pose : group.poses)
      if (met.test(pose)) poses.push_back(pose);
    if (poses.empty()) continue;
    const std::vector<double> then = after_.costs(poses, step->bodies.base_from_body(group.first - 1, 0));
    for (std::size_t i = 0; i < poses.size(); ++i) costs[poses[i]] = step->cost_to[group.first] + then[i];
  }
  return costs;
}

/// Over the retreat plane to any place on it; where the tool is past it, also to the places next to it.
std::vector<WalkPolicy::Stand> WalkPolicy::entries(const Bitset& members, const Pose& base_from_tool) const {
  const std::size_t count = members.count();
  std::vector<Stand> stands;
  const auto enter = [&](std::size_t place, double spent) {
    stands.push_back({place, 0, -1, members, count, spent, spent});
  };
  std::size_t nearest = 0;
  double least = 1e300;
  for (std::size_t place = 0; place < lattice_->size(); ++place) {
    const Pose& there = lattice_->base_from_tool(place);
    if (lattice_->is_on_plane(place)) {
      enter(place, with_actions(action::transit_cost(*task_, base_from_tool, there)));
      continue;
    }
    const double distance = (there.translation() - base_from_tool.translation()).norm();
    if (distance < least) least = distance, nearest = place;
  }
  if (least < near_by)
    enter(nearest, task_->options().cost.metre * least +
                       task_->options().cost.radian *
                           geometry::angle_between(base_from_tool, lattice_->base_from_tool(nearest)));
  return stands;
}

WalkPolicy::Walk WalkPolicy::best_walk(const Bitset& members, const Pose& base_from_tool, double to_go) const {
  const auto total = static_cast<double>(members.count());
  const auto key = [&](const Stand& stand) {
    const double missing = static_cast<double>(stand.count) / total;
    return stand.expected + to_go * missing * missing * total / static_cast<double>(members.size());
  };
  std::vector<Stand> stands = entries(members, base_from_tool);
  std::vector<int> current(stands.size());
  for (std::size_t i = 0; i < stands.size(); ++i) current[i] = static_cast<int>(i);
  int best = -1;
  double least = 1e300;
  for (int length = 0; length < longest_walk && !current.empty(); ++length) {
    std::vector<Stand> next;
    for (const int at : current)
      for (std::size_t direction = 0; direction < action::Lattice::directions; ++direction) {
        const Stand& from = stands[static_cast<std::size_t>(at)];
        const auto cost = step_cost(from.place, direction);
        if (!cost) continue;
        Stand to{*lattice_->neighbour(from.place, direction), direction, at, from.left, 0, 0.0, 0.0};
        to.left.and_not(touched(from.place, direction));
        to.count = to.left.count();
        to.spent = from.spent + *cost;
        to.expected = from.expected + *cost * 0.5 * static_cast<double>(from.count + to.count) / total;
        next.push_back(std::move(to));
      }
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < next.size(); ++i) order.emplace_back(key(next[i]), i);
    std::sort(order.begin(), order.end());
    current.clear();
    for (const auto& [value, i] : order) {
      if (current.size() >= beam || value >= least) break;
      Stand& stand = next[i];
      const auto is_same = [&](int at) {
        const Stand& kept = stands[static_cast<std::size_t>(at)];
        return kept.place == stand.place && kept.left == stand.left;
      };
      if (std::any_of(current.begin(), current.end(), is_same)) continue;
      const bool done = static_cast<double>(stand.count) <= least_missing * total;
      if (done) least = value, best = static_cast<int>(stands.size());
      if (!done) current.push_back(static_cast<int>(stands.size()));
      stands.push_back(std::move(stand));
    }
  }
  if (best < 0)  // what is left can't be walked to
    for (std::size_t i = 0; i < stands.size(); ++i) {
      const double value = stands[i].expected + given_up * static_cast<double>(stands[i].count) / total;
      if (value < least) least = value, best = static_cast<int>(i);
    }
  Walk walk;
  for (; stands[static_cast<std::size_t>(best)].before >= 0; best = stands[static_cast<std::size_t>(best)].before) {
    const Stand& stand = stands[static_cast<std::size_t>(best)];
    walk.steps.emplace_back(stands[static_cast<std::size_t>(stand.before)].place, stand.direction);
  }
  walk.entry = stands[static_cast<std::size_t>(best)].spent;
  std::reverse(walk.steps.begin(), walk.steps.end());
  return walk;
}

double WalkPolicy::cost(const Members& members, const Pose& base_from_tool) {
  Bitset left(predictions_.poses().size());
  for (const std::size_t member : members) left.set(member);
  const Walk walk = best_walk(left, base_from_tool, to_go_);
  double spent = walk.entry, sum = 0.0;
  Pose end = base_from_tool;
  for (const auto& [place, direction] : walk.steps) {
    Bitset met = left;
    met &= touched(place, direction);
    if (!met.none()) {
      const std::vector<double>& after = after_step(place, direction);
      met.for_each([&](std::size_t pose) { sum += spent + after[pose]; });
      left.and_not(met);
    }
    spent += *step_cost(place, direction);
    end = lattice_->base_from_tool(*lattice_->neighbour(place, direction));
  }
  Members missing;
  left.for_each([&](std::size_t pose) { missing.push_back(pose); });
  if (!missing.empty()) sum += static_cast<double>(missing.size()) * (spent + after_.cost(missing, end));
  return sum / static_cast<double>(members.size());
}

}  // namespace tactus::solver
