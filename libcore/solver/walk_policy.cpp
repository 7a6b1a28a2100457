// SPDX-License-Identifier: BSD-3-Clause
#include "solver/walk_policy.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus::solver {
namespace {

using action::MotionPtr;
using geometry::Pose;
using support::Bitset;

constexpr double blocked = 1e300;
constexpr double near_by = 0.08;        // m to the nearest place, which a walk may begin at then
constexpr int longest_walk = 160;       // steps
constexpr double least_missing = 0.02;  // share of the poses for which a walk does not go on
constexpr double given_up = 2.0;        // m that it is worth to walk rather than leave a pose untouched

std::size_t count_without(const Bitset& set, const Bitset& other) {
  std::size_t count = 0;
  for (std::size_t w = 0; w < set.words().size(); ++w)
    count += static_cast<std::size_t>(std::popcount(set.words()[w] & ~other.words()[w]));
  return count;
}

}  // namespace

WalkPolicy::WalkPolicy(std::shared_ptr<const action::Task> task, std::shared_ptr<const action::Lattice> lattice,
                       Predictions& predictions, RatePolicy& after, const Pose& base_from_tool, int dimensions)
    : task_(std::move(task)),
      lattice_(std::move(lattice)),
      predictions_(predictions),
      after_(after),
      dimensions_(dimensions),
      steps_(lattice_->size() * action::Lattice::directions),
      costs_after_(steps_.size()) {
  const Bitset all(predictions_.poses().size(), true);
  first_ = best_walk(all, base_from_tool, careful);
  double length = 0.0, found = 0.0;
  Bitset left = all;
  for (const auto& [place, direction] : first_.steps) {
    const std::size_t before = left.count();
    left.and_not(step(place, direction).touched);
    length += step(place, direction).cost;
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

const WalkPolicy::Step& WalkPolicy::step(std::size_t place, std::size_t direction) const {
  std::optional<Step>& kept = steps_[place * action::Lattice::directions + direction];
  if (!kept) kept = made_step(place, direction);
  return *kept;
}

/// On the retreat plane no way is looked for, and nothing touched.
WalkPolicy::Step WalkPolicy::made_step(std::size_t place, std::size_t direction) const {
  Step made{0, blocked, Bitset(predictions_.poses().size())};
  const auto next = lattice_->neighbour(place, direction);
  if (!next) return made;
  made.to = *next;
  if (lattice_->is_on_plane(place) && lattice_->is_on_plane(*next)) {
    made.cost = with_actions(task_->options().cost.metre * lattice_->pitch());
    return made;
  }
  const MotionPtr motion = lattice_->step(place, direction);
  if (!motion) return made;
  made.cost = with_actions(motion->cost_to.back());
  const std::vector<std::int32_t>& first_contacts = predictions_.first_contacts(motion);
  for (std::size_t pose = 0; pose < first_contacts.size(); ++pose)
    if (first_contacts[pose] < static_cast<std::int32_t>(motion->path.size())) made.touched.set(pose);
  return made;
}

/// By pose that it touches, the rest of what it costs from the step's beginning: as if all were still possible that the
/// step touches.
const std::vector<double>& WalkPolicy::after_step(std::size_t place, std::size_t direction) {
  std::vector<double>& costs = costs_after_[place * action::Lattice::directions + direction];
  if (!costs.empty()) return costs;
  const MotionPtr motion = lattice_->step(place, direction);
  costs.assign(predictions_.poses().size(), 0.0);
  const Bitset& met = step(place, direction).touched;
  for (const Group& group : predictions_.split(motion, met, least_group(met.count(), dimensions_))) {
    if (group.first >= motion->path.size()) continue;
    RatePolicy::Members poses;
    for (const std::size_t pose : group.poses)
      if (met.test(pose)) poses.push_back(pose);
    if (poses.empty()) continue;
    const std::vector<double> then = after_.costs(poses, motion->bodies.base_from_body(group.first - 1, 0));
    for (std::size_t i = 0; i < poses.size(); ++i) costs[poses[i]] = motion->cost_to[group.first] + then[i];
  }
  return costs;
}

/// Over the retreat plane to any place on it; where the tool is past it, also to the places next to it.
std::vector<WalkPolicy::Stand> WalkPolicy::entries(const Bitset& members, const Pose& base_from_tool) const {
  const std::size_t count = members.count();
  std::vector<Stand> stands;
  const auto enter = [&](std::size_t place, double spent) {
    stands.push_back({place, 0, -1, count, spent, spent, members});
  };
  std::size_t nearest = lattice_->size();
  double least = near_by;
  for (std::size_t place = 0; place < lattice_->size(); ++place) {
    if (lattice_->is_on_plane(place)) {
      enter(place, entry_cost(base_from_tool, place));
      continue;
    }
    const double distance = (lattice_->base_from_tool(place).translation() - base_from_tool.translation()).norm();
    if (distance < least) least = distance, nearest = place;
  }
  if (nearest < lattice_->size()) enter(nearest, entry_cost(base_from_tool, nearest));
  return stands;
}

/// Over the retreat plane to a place on it, straight to one next to the tool; to any other there is no way.
double WalkPolicy::entry_cost(const Pose& base_from_tool, std::size_t place) const {
  const Pose& there = lattice_->base_from_tool(place);
  if (lattice_->is_on_plane(place)) return with_actions(action::transit_cost(*task_, base_from_tool, there));
  const double distance = (there.translation() - base_from_tool.translation()).norm();
  const action::CostWeights& weights = task_->options().cost;
  return distance < near_by ? weights.metre * distance + weights.radian * geometry::angle_between(base_from_tool, there)
                            : blocked;
}

WalkPolicy::Walk WalkPolicy::best_walk(const Bitset& members, const Pose& base_from_tool, std::size_t beam) const {
  const auto total = static_cast<double>(members.count());
  const auto key = [&](const Stand& stand) {
    const double missing = static_cast<double>(stand.count) / total;
    return stand.expected + to_go_ * missing * missing * total / static_cast<double>(members.size());
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
        const Step& taken = step(from.place, direction);
        if (taken.cost >= blocked) continue;
        Stand to{taken.to, direction, at};
        to.count = count_without(from.left, taken.touched);
        to.spent = from.spent + taken.cost;
        to.expected = from.expected + taken.cost * 0.5 * static_cast<double>(from.count + to.count) / total;
        if (to.expected < least) next.push_back(std::move(to));
      }
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < next.size(); ++i) order.emplace_back(key(next[i]), i);
    std::sort(order.begin(), order.end());
    current.clear();
    for (const auto& [value, i] : order) {
      if (current.size() >= beam || value >= least) break;
      Stand& stand = next[i];
      const Stand& from = stands[static_cast<std::size_t>(stand.before)];
      stand.left = from.left;
      if (stand.count < from.count) stand.left.and_not(step(from.place, stand.direction).touched);
      const auto is_same = [&](int at) {
        const Stand& kept = stands[static_cast<std::size_t>(at)];
        return kept.place == stand.place && kept.count == stand.count && kept.left == stand.left;
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

/// From the place on it that is the cheapest to get to, of several the last; none if there is no way to any.
WalkPolicy::Walk WalkPolicy::rest_of_first(const Pose& base_from_tool) const {
  Walk rest{blocked, {}};
  for (auto from = first_.steps.begin(); from != first_.steps.end(); ++from) {
    const double entry = entry_cost(base_from_tool, from->first);
    if (entry < blocked && entry <= rest.entry) rest = {entry, {from, first_.steps.end()}};
  }
  return rest;
}

double WalkPolicy::cost(const Members& members, const Pose& base_from_tool, std::size_t beam) {
  Bitset all(predictions_.poses().size());
  for (const std::size_t member : members) all.set(member);
  const double cost = cost_of(best_walk(all, base_from_tool, beam), all, base_from_tool);
  const Walk rest = rest_of_first(base_from_tool);
  return rest.entry < blocked ? std::min(cost, cost_of(rest, all, base_from_tool)) : cost;
}

/// Of the walk, what follows where it touches, and what is left to do at its end.
double WalkPolicy::cost_of(const Walk& walk, Bitset left, const Pose& base_from_tool) {
  const auto total = static_cast<double>(left.count());
  double spent = walk.entry, sum = 0.0;
  Pose end = base_from_tool;
  for (const auto& [place, direction] : walk.steps) {
    Bitset met = left;
    met &= step(place, direction).touched;
    if (!met.none()) {
      const std::vector<double>& after = after_step(place, direction);
      met.for_each([&](std::size_t pose) { sum += spent + after[pose]; });
      left.and_not(met);
    }
    spent += step(place, direction).cost;
    end = lattice_->base_from_tool(step(place, direction).to);
  }
  Members missing;
  left.for_each([&](std::size_t pose) { missing.push_back(pose); });
  if (!missing.empty()) sum += static_cast<double>(missing.size()) * (spent + after_.cost(missing, end));
  return sum / total;
}

}  // namespace tactus::solver
