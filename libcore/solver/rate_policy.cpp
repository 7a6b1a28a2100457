// SPDX-License-Identifier: BSD-3-Clause
#include "solver/rate_policy.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::solver {
namespace {

using action::MotionPtr;
using geometry::Pose;
using support::Bitset;

constexpr double fixed_cost = 0.02;      // m, of the rate rule
constexpr std::size_t few_members = 12;  // that may be tried one after another

/// Calls `visit(first, last)` for each run of equal first contacts.
template <typename Pairs, typename Visit>
void for_each_group(const Pairs& sorted, Visit&& visit) {
  for (auto first = sorted.begin(); first != sorted.end();) {
    const auto last = std::find_if(first, sorted.end(), [&](const auto& entry) { return entry.first != first->first; });
    visit(first, last);
    first = last;
  }
}

}  // namespace

RatePolicy::RatePolicy(std::shared_ptr<const action::Task> task, Predictions& predictions,
                       std::vector<MotionPtr> motions, std::vector<Attempt> attempts, std::vector<Bitset> served)
    : task_(std::move(task)), motions_(std::move(motions)), attempts_(std::move(attempts)), served_(std::move(served)) {
  for (const MotionPtr& motion : motions_) first_contacts_.push_back(&predictions.first_contacts(motion));
}

double RatePolicy::cost(const Members& members, const Pose& base_from_tool) {
  const Plan& first = plan(members);
  return lead(base_from_tool, first.base_from_start) + first.cost;
}

double RatePolicy::lead(const Pose& base_from_tool, const Pose& base_from_start) const {
  return task_->options().cost.action + action::transit_cost(*task_, base_from_tool, base_from_start);
}

const RatePolicy::Plan& RatePolicy::plan(const Members& members) {
  Bitset set(attempts_.size());
  for (const std::size_t member : members) set.set(member);
  const support::Hash128 key = set.hash(0);
  if (const auto known = plans_.find(key); known != plans_.end()) return known->second;
  Plan best;
  if (members.size() > 1) best = probing(members);
  if (members.size() <= few_members || best.cost >= 1e300) {
    const Plan attempts = attempts_at(members);
    if (attempts.cost < best.cost) best = attempts;
  }
  return plans_.try_emplace(key, best).first->second;
}

/// One after another, those that serve the most first.
RatePolicy::Plan RatePolicy::attempts_at(const Members& members) const {
  Bitset left(attempts_.size());
  for (const std::size_t member : members) left.set(member);
  const auto total = static_cast<double>(members.size());
  Plan plan{Pose::Identity(), 0.0};
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
    const double still = static_cast<double>(count) / total;
    if (last)
      plan.cost += still * lead(last->base_from_seated, next.base_from_start);
    else
      plan.base_from_start = next.base_from_start;
    plan.cost += still * next.cost;
    left.and_not(served_[best]);
    count -= most;
    last = &next;
  }
  return plan;
}

/// The members in the order of their first contacts.
void RatePolicy::split(const std::vector<std::int32_t>& first_contact, const Members& members) {
  sorted_.clear();
  for (const std::size_t member : members) sorted_.emplace_back(first_contact[member], member);
  std::sort(sorted_.begin(), sorted_.end());
}

/// The motion with the best rate, and whatever is best then.
RatePolicy::Plan RatePolicy::probing(const Members& members) {
  const auto total = static_cast<double>(members.size());
  std::size_t best = motions_.size();
  double highest = 0.0;
  for (std::size_t m = 0; m < motions_.size(); ++m) {
    split(*first_contacts_[m], members);
    if (sorted_.front().first == sorted_.back().first) continue;
    const std::vector<double>& cost_to = motions_[m]->cost_to;
    double bits = 0.0, cost = fixed_cost;
    for_each_group(sorted_, [&](auto first, auto last) {
      const double share = static_cast<double>(last - first) / total;
      bits -= share * std::log2(share);
      cost += share * cost_to[std::min<std::size_t>(static_cast<std::size_t>(first->first), cost_to.size() - 1)];
    });
    if (bits / cost > highest) highest = bits / cost, best = m;
  }
  if (best == motions_.size()) return {};
  const action::Motion& motion = *motions_[best];
  split(*first_contacts_[best], members);
  std::vector<std::pair<std::size_t, Members>> groups;
  for_each_group(sorted_, [&](auto first, auto last) {
    groups.emplace_back(static_cast<std::size_t>(first->first), Members{});
    for (auto entry = first; entry != last; ++entry) groups.back().second.push_back(entry->second);
  });
  Plan plan{motion.base_from_start, 0.0};
  for (const auto& [waypoint, group] : groups) {
    const double share = static_cast<double>(group.size()) / total;
    plan.cost += share * (motion.cost_to[std::min(waypoint, motion.cost_to.size() - 1)] +
                          cost(group, motion.bodies.base_from_body(waypoint - 1, 0)));
  }
  return plan;
}

}  // namespace tactus::solver
