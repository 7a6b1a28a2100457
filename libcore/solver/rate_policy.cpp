// SPDX-License-Identifier: BSD-3-Clause
#include "solver/rate_policy.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "action/insertion.hpp"
#include "action/near_pokes.hpp"
#include "support/rng.hpp"

namespace tactus::solver {
namespace {

using action::MotionPtr;
using geometry::Pose;
using support::Bitset;

constexpr double least_rate = 1e-9;
constexpr double fixed_cost = 0.02;       // m, of the rate rule
constexpr std::size_t few_members = 12;   // that may be tried one after another
constexpr std::size_t many_members = 30;  // for which the way to a motion counts in its choice
constexpr double place_pitch = 0.001;     // m

/// To tell apart where the tool is.
std::uint64_t place_of(const Pose& base_from_tool) {
  std::uint64_t place = 1;
  for (int d = 0; d < 3; ++d)
    place =
        support::mix(place ^ static_cast<std::uint64_t>(std::llround(base_from_tool.translation()[d] / place_pitch)));
  return place;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

RatePolicy::RatePolicy(std::shared_ptr<const action::Task> task, Predictions& predictions,
                       std::vector<MotionPtr> motions, std::vector<Attempt> attempts, std::vector<Bitset> served,
                       int dimensions)
    : task_(std::move(task)),
      motions_(std::move(motions)),
      attempts_(std::move(attempts)),
      served_(std::move(served)),
      dimensions_(dimensions),
      cancellation_(predictions.cancellation()) {
  for (const MotionPtr& motion : motions_) {
    first_contacts_.push_back(&predictions.first_contacts(motion));
    first_nears_.push_back(&predictions.first_nears(motion));
  }
}

double RatePolicy::cost(const Members& members, const Pose& base_from_tool) {
  const Plan& first = plan(members, base_from_tool);
  return first_cost(base_from_tool, first) + first.cost;
}

std::vector<double> RatePolicy::costs(const Members& members, const Pose& base_from_tool) {
  const Plan& first = plan(members, base_from_tool);
  std::vector<double> costs = first.costs;
  const double until_then = first_cost(base_from_tool, first);
  for (double& cost : costs) cost += until_then;
  return costs;
}

std::vector<MotionPtr> RatePolicy::promising(const Members& members, const Pose& base_from_tool, std::size_t most) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t motion = 0; motion < motions_.size(); ++motion)
    if (const double rate = rate_of(motion, members, &base_from_tool); rate > least_rate)
      order.emplace_back(-rate, motion);
  std::sort(order.begin(), order.end());
  order.resize(std::min(order.size(), most));
  std::vector<MotionPtr> found;
  for (const auto& [rate, motion] : order) found.push_back(motions_[motion]);
  return found;
}

double RatePolicy::lead(const Pose& base_from_tool, const Pose& base_from_start) const {
  return task_->options().cost.action + action::transit_cost(*task_, base_from_tool, base_from_start);
}

/// Of getting to the first motion, or to the end of the first attempt. Where a motion begins where the tool is, rather
/// than on the retreat plane, its first part is saved.
double RatePolicy::first_cost(const Pose& base_from_tool, const Plan& plan) const {
  if (plan.attempt) return attempt_cost(base_from_tool, *plan.attempt);
  return std::min(lead(base_from_tool, plan.base_from_start),
                  near_cost(base_from_tool, plan.base_from_near) - plan.until_near);
}

/// As for a near poke: back, and straight across.
double RatePolicy::near_cost(const Pose& base_from_tool, const Pose& base_from_near) const {
  const action::CostWeights& weights = task_->options().cost;
  const double across = (base_from_near.translation() - base_from_tool.translation()).norm();
  return weights.action + weights.metre * (action::near_back + across) +
         weights.radian * geometry::angle_between(base_from_tool, base_from_near);
}

/// Over the retreat plane or near by, whichever is cheaper.
double RatePolicy::attempt_cost(const Pose& base_from_tool, const Attempt& attempt) const {
  const double near = action::near_insertion_cost(*task_, base_from_tool, attempt.base_from_seated, attempt.axis());
  return std::min(lead(base_from_tool, attempt.base_from_start) + attempt.cost, task_->options().cost.action + near);
}

const RatePolicy::Plan& RatePolicy::plan(const Members& members, const Pose& base_from_tool) {
  cancellation_.check();
  Bitset set(attempts_.size());
  for (const std::size_t member : members) set.set(member);
  const bool regards_lead = members.size() >= many_members;
  const support::Hash128 key = set.hash(regards_lead ? place_of(base_from_tool) : 0);
  auto known = plans_.find(key);
  if (known == plans_.end()) {
    Plans made;
    if (members.size() > 1) made.probing = probing(members, regards_lead ? &base_from_tool : nullptr);
    if (members.size() <= few_members || made.probing.cost >= 1e300) made.attempts = attempts_at(members);
    known = plans_.try_emplace(key, std::move(made)).first;
  }
  const auto& [probing, attempts] = known->second;
  const auto cost = [&](const Plan& plan) { return first_cost(base_from_tool, plan) + plan.cost; };
  return cost(attempts) < cost(probing) ? attempts : probing;
}

/// One after another, those that serve the most first.
RatePolicy::Plan RatePolicy::attempts_at(const Members& members) const {
  Bitset left(attempts_.size());
  for (const std::size_t member : members) left.set(member);
  Plan plan;
  plan.costs.resize(members.size());
  double spent = 0.0;
  const Attempt* last = nullptr;
  for (std::size_t count = members.size(); count > 0;) {
    std::size_t best = 0, most = 0;
    for (const std::size_t member : members) {
      if (!left.test(member)) continue;
      Bitset serves = served_[member];
      const std::size_t size = (serves &= left).count();
      if (size > most) most = size, best = member;
    }
    const Attempt& next = attempts_[best];
    if (last)
      spent += attempt_cost(last->base_from_seated, next);
    else
      plan.attempt = &next;
    for (std::size_t i = 0; i < members.size(); ++i)
      if (left.test(members[i]) && served_[best].test(members[i])) plan.costs[i] = spent;
    left.and_not(served_[best]);
    count -= most;
    last = &next;
  }
  plan.cost = mean(plan.costs);
  return plan;
}

template <typename Entry>
bool RatePolicy::are_mostly_near(std::size_t motion, Entry begin, Entry end, std::int32_t waypoint) const {
  const std::vector<std::int32_t>& first_near = *first_nears_[motion];
  return 2 * std::count_if(begin, end, [&](const auto& entry) { return first_near[entry.second] <= waypoint; }) >
         end - begin;
}

/// Calls `visit(waypoint, begin, end)` for each group that a motion's outcome tells apart, as `Predictions::split`
/// does.
template <typename Visit>
void RatePolicy::for_each_group(std::size_t motion, const Members& members, Visit&& visit) {
  sorted_.clear();
  for (const std::size_t member : members) sorted_.emplace_back((*first_contacts_[motion])[member], member);
  std::sort(sorted_.begin(), sorted_.end());
  const auto untouched = static_cast<std::int32_t>(motions_[motion]->path.size());
  const auto touched =
      std::partition_point(sorted_.begin(), sorted_.end(), [&](const auto& entry) { return entry.first < untouched; });
  const auto count = static_cast<std::size_t>(touched - sorted_.begin());
  const auto least = static_cast<std::ptrdiff_t>(least_group(count, dimensions_));
  for (auto begin = sorted_.begin(); begin != sorted_.end();) {
    const auto differs = [](std::int32_t at) { return [at](const auto& entry) { return entry.first != at; }; };
    auto end = std::find_if(begin, sorted_.end(), differs(begin->first));
    while (end != sorted_.end() && end->first != untouched) {
      const auto next = std::find_if(end, sorted_.end(), differs(end->first));
      if (end - begin >= least && !are_mostly_near(motion, end, next, begin->first)) break;
      end = next;
    }
    visit(static_cast<std::size_t>(begin->first), begin, end);
    begin = end;
  }
}

/// The last waypoint from which a motion still has `action::near_back` to go to another one; the first if there is
/// none.
std::size_t RatePolicy::place_before(std::size_t motion, std::size_t waypoint) const {
  const std::vector<double>& cost = motions_[motion]->cost_to;
  const double least = cost_to(motion, waypoint) - action::near_back * task_->options().cost.metre;
  const auto after = std::upper_bound(cost.begin(), cost.end(), least);
  return after == cost.begin() ? 0 : static_cast<std::size_t>(after - cost.begin()) - 1;
}

double RatePolicy::cost_to(std::size_t motion, std::size_t waypoint) const {
  const std::vector<double>& cost = motions_[motion]->cost_to;
  return cost[std::min(waypoint, cost.size() - 1)];
}

/// Bits per cost.
double RatePolicy::rate_of(std::size_t motion, const Members& members, const Pose* base_from_tool) {
  const auto total = static_cast<double>(members.size());
  double bits = 0.0, cost = fixed_cost;
  if (base_from_tool) cost += lead(*base_from_tool, motions_[motion]->base_from_start);
  for_each_group(motion, members, [&](std::size_t waypoint, auto begin, auto end) {
    const double share = static_cast<double>(end - begin) / total;
    bits -= share * std::log2(share);
    cost += share * cost_to(motion, waypoint);
  });
  return bits / cost;
}

/// The motion with the best rate, and whatever is best then.
RatePolicy::Plan RatePolicy::probing(const Members& members, const Pose* base_from_tool) {
  std::size_t best = motions_.size();
  double highest = least_rate;
  for (std::size_t motion = 0; motion < motions_.size(); ++motion)
    if (const double rate = rate_of(motion, members, base_from_tool); rate > highest) highest = rate, best = motion;
  if (best == motions_.size()) return {};
  std::vector<std::pair<std::size_t, Members>> groups;
  for_each_group(best, members, [&](std::size_t waypoint, auto begin, auto end) {
    Members& group = groups.emplace_back(waypoint, Members{}).second;
    std::transform(begin, end, std::back_inserter(group), [](const auto& entry) { return entry.second; });
    std::sort(group.begin(), group.end());
  });
  const std::size_t near = place_before(best, groups.front().first);
  Plan plan{.base_from_start = motions_[best]->base_from_start,
            .base_from_near = motions_[best]->bodies.base_from_body(near, 0),
            .until_near = cost_to(best, near),
            .costs = std::vector<double>(members.size()),
            .cost = 0.0};
  for (const auto& [waypoint, group] : groups) {
    const std::vector<double> then = costs(group, motions_[best]->bodies.base_from_body(waypoint - 1, 0));
    auto member = members.begin();
    for (std::size_t i = 0; i < group.size(); ++i) {
      member = std::lower_bound(member, members.end(), group[i]);
      plan.costs[static_cast<std::size_t>(member - members.begin())] = cost_to(best, waypoint) + then[i];
    }
  }
  plan.cost = mean(plan.costs);
  return plan;
}

}  // namespace tactus::solver
