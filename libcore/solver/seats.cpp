// SPDX-License-Identifier: BSD-3-Clause
#include "solver/seats.hpp"

#include <algorithm>

#include "action/action.hpp"
#include "action/insertion.hpp"

namespace tactus::solver {

using action::MotionPtr;
using geometry::Pose;
using geometry::Vector3;
using robot::JointVector;
using support::Bitset;

namespace {

constexpr std::size_t both_ways = 2;  // groups that are attempted from where the tool is and by the plane
constexpr double same_seat = 0.0015;  // m between seats that one attempt may serve
constexpr double lever = 0.02;        // m by which a turn counts as a shift there

}  // namespace

Seats::Seats(std::shared_ptr<const action::Task> task, std::vector<Pose> poses, double plane,
             support::Cancellation cancellation)
    : task_(std::move(task)), poses_(std::move(poses)), plane_(plane), cancellation_(std::move(cancellation)) {
  for (const Pose& pose : poses_)
    for (std::size_t seat = 0; seat < each(); ++seat) base_from_seated_.push_back(task_->scene().seated(pose, seat));
  find_neighbours();
}

void Seats::find_neighbours() {
  neighbours_.assign(base_from_seated_.size(), Bitset(base_from_seated_.size()));
  for (std::size_t a = 0; a < base_from_seated_.size(); ++a) {
    cancellation_.check();
    for (std::size_t b = 0; b <= a; ++b) {
      const Pose &one = base_from_seated_[a], &other = base_from_seated_[b];
      const double shift = (one.translation() - other.translation()).norm();
      if (shift >= same_seat || shift + lever * geometry::angle_between(one, other) >= same_seat) continue;
      neighbours_[a].set(b);
      neighbours_[b].set(a);
    }
  }
}

double Seats::direct_cost(const Pose& base_from_tool, std::size_t pose) const {
  double least = direct_cost_to(base_from_tool, pose * each());
  for (std::size_t seat = 1; seat < each(); ++seat)
    least = std::min(least, direct_cost_to(base_from_tool, pose * each() + seat));
  return least;
}

double Seats::direct_cost_to(const Pose& base_from_tool, std::size_t seat) const {
  const action::CostWeights& weights = task_->options().cost;
  const scene::Target& target = task_->scene().target;
  const double metres = (base_from_seated_[seat].translation() - base_from_tool.translation()).norm();
  const double radians = geometry::angle_between(base_from_tool, base_from_seated_[seat]);
  const double tilted = target.angle_tolerance * target.target_from_seated[seat % each()].translation().norm();
  const double tolerance = target.position_tolerance + tilted;
  return weights.metre * std::max(0.0, metres - tolerance) +
         weights.radian * std::max(0.0, radians - target.angle_tolerance) + weights.action;
}

std::vector<MotionPtr> Seats::attempts(const Bitset& members, const JointVector& q, std::size_t most, bool nears) {
  const std::vector<std::size_t> order = nearest_first(members, q);
  Bitset left(base_from_seated_.size());
  for (const std::size_t seat : order) left.set(seat);
  std::vector<MotionPtr> found;
  std::size_t groups = 0;
  for (std::size_t tries = 0; tries < most * each() && groups < most && !left.none(); ++tries) {
    cancellation_.check();
    const std::size_t best = densest(order, left);
    const Bitset group = served(best, left);
    left.and_not(group);
    const MotionPtr near = nears ? near_insertion_at(best, q) : nullptr;
    const MotionPtr motion = !near || groups < both_ways ? insertion_at(best, q) : nullptr;
    if (!motion && !near) continue;
    ++groups;
    for (const MotionPtr& attempt : {near, motion})
      if (attempt) found.push_back(attempt);
    group.for_each([&](std::size_t seat) { left.reset_in(seat - seat % each(), seat - seat % each() + each()); });
    if (group.count() <= 1) break;
  }
  return found;
}

/// The seats of some poses, those of each the nearest to the tool first.
std::vector<std::size_t> Seats::nearest_first(const Bitset& members, const JointVector& q) const {
  const Pose base_from_tool = task_->base_from_tool(q);
  std::vector<std::size_t> order;
  members.for_each([&](std::size_t pose) {
    const auto first = static_cast<std::ptrdiff_t>(order.size());
    for (std::size_t seat = 0; seat < each(); ++seat) order.push_back(pose * each() + seat);
    std::stable_sort(order.begin() + first, order.end(), [&](std::size_t a, std::size_t b) {
      return direct_cost_to(base_from_tool, a) < direct_cost_to(base_from_tool, b);
    });
  });
  return order;
}

/// The first seat that is left and has the most near by that are.
std::size_t Seats::densest(const std::vector<std::size_t>& order, const Bitset& left) const {
  std::size_t best = 0, most = 0;
  for (const std::size_t seat : order) {
    if (!left.test(seat)) continue;
    const std::size_t size = served(seat, left).count();
    if (size > most) most = size, best = seat;
  }
  return best;
}

Bitset Seats::served(std::size_t seat, const Bitset& left) const {
  Bitset group = neighbours_[seat];
  return group &= left;
}

MotionPtr Seats::insertion_at(std::size_t seat, const JointVector& near) {
  if (const auto found = insertions_.find(seat); found != insertions_.end()) return found->second;
  return insertions_[seat] =
             action::insertion(*task_, poses_[seat / each()], near, seat % each(), plane_, cancellation_);
}

MotionPtr Seats::near_insertion_at(std::size_t seat, const JointVector& q) {
  const auto at = std::pair(action::path_id({q}), seat);
  if (const auto found = near_insertions_.find(at); found != near_insertions_.end()) return found->second;
  return near_insertions_[at] = action::near_insertion(*task_, poses_[seat / each()], q, seat % each(), cancellation_);
}

std::vector<Attempt> Seats::first_attempts() const {
  std::vector<Attempt> attempts;
  for (std::size_t pose = 0; pose < poses_.size(); ++pose) attempts.push_back(attempt_at(pose * each()));
  return attempts;
}

Attempt Seats::attempt_at(std::size_t seat) const {
  const scene::Scene& scene = task_->scene();
  const Pose& seated = base_from_seated_[seat];
  const Vector3 axis = poses_[seat / each()].linear() * scene.target.approach_axis;
  const Pose search_from_base = task_->frame().base_from_search.inverse();
  const double past_plane = (search_from_base * seated.translation()).z() - plane_;
  const double to_plane = std::max(scene.target.approach_depth, past_plane / (search_from_base.linear() * axis).z());
  Attempt attempt{seated, seated, task_->options().cost.metre * to_plane};
  attempt.base_from_start.translation() -= to_plane * axis;
  return attempt;
}

std::vector<Bitset> Seats::served_at_first() const {
  std::vector<Bitset> served(poses_.size(), Bitset(poses_.size()));
  for (std::size_t pose = 0; pose < poses_.size(); ++pose)
    neighbours_[pose * each()].for_each([&](std::size_t seat) {
      if (seat % each() == 0) served[pose].set(seat / each());
    });
  return served;
}

}  // namespace tactus::solver
