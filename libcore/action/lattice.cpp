// SPDX-License-Identifier: BSD-3-Clause
#include "action/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "action/probes.hpp"

namespace tactus::action {
namespace {

constexpr double same_turn = 0.01;  // rad

/// `pitch` apart over a range, as if one were at `through`.
std::vector<double> rows(double low, double high, double pitch, double through) {
  std::vector<double> at;
  for (double next = low + std::fmod(std::fmod(through - low, pitch) + pitch, pitch); next <= high; next += pitch)
    at.push_back(next);
  if (at.empty()) at.push_back(0.5 * (low + high));
  return at;
}

bool holds(const std::vector<double>& heights, double at) {
  return std::any_of(heights.begin(), heights.end(),
                     [&](double height) { return std::abs(height - at) < Lattice::same_place; });
}

/// Of the tool frame's origin, ascending: on the retreat plane, with the tip in each layer past it, and where the tool
/// is, if that is between them.
std::vector<double> heights(const Task& task, double through) {
  const scene::SearchFrame& frame = task.frame();
  std::vector<double> at{frame.standoff};
  for (const double first : task.options().actions.probe_depth)
    for (const double depth : layers(task, frame.region, first))
      at.push_back(std::min(frame.region.low.z() + depth, frame.region.high.z()) - frame.tool_extent.high.z());
  at.erase(std::remove_if(at.begin() + 1, at.end(), [&](double layer) { return layer <= frame.standoff; }), at.end());
  std::sort(at.begin(), at.end());
  if (!holds(at, through) && through > at.front() && through < at.back())
    at.insert(std::upper_bound(at.begin(), at.end(), through), through);
  return at;
}

/// Of the tool about the approach axis, from how it is seated at the central pose.
double turn_of(const scene::SearchFrame& frame, const Pose& base_from_tool) {
  const Eigen::Matrix3d turned = frame.base_from_search.linear().transpose() * base_from_tool.linear() *
                                 frame.search_from_tool.linear().transpose();
  return std::atan2(turned(1, 0) - turned(0, 1), turned(0, 0) + turned(1, 1));
}

bool goes_back(std::size_t direction) { return direction % 2 != 0; }
std::size_t opposite(std::size_t direction) { return direction ^ 1; }

MotionPtr reversed(const Task& task, const Motion& move) {
  Motion back;
  back.path.assign(move.path.rbegin(), move.path.rend());
  return finished(task, std::move(back));
}

}  // namespace

Lattice::Lattice(const Task& task, const JointVector& q, double pitch)
    : task_(task),
      q_(q),
      pitch_(pitch),
      through_(task.frame().base_from_search.inverse() * task.base_from_tool(q).translation()),
      turn_(turn_of(task.frame(), task.base_from_tool(q))),
      heights_(heights(task, through_.z())) {
  const geometry::Box& region = task.frame().region;
  const std::vector<double> x = rows(region.low.x(), region.high.x(), pitch, through_.x());
  const std::vector<double> y = rows(region.low.y(), region.high.y(), pitch, through_.y());
  across_ = {x.size(), y.size(), heights_.size()};
  for (const double height : heights_)
    for (const double along : x)
      for (const double beside : y) places_.push_back(task.frame().base_from_tool({along, beside, height}, turn_));
  if (task.options().sites)
    for (Pose& place : places_) place.translation() = task.options().sites->nearest(place.translation());
  steps_.resize(places_.size() * directions);
}

bool Lattice::passes(const JointVector& q) const {
  const Pose base_from_tool = task_.base_from_tool(q);
  const Vector3 at = task_.frame().base_from_search.inverse() * base_from_tool.translation();
  for (int axis = 0; axis < 2; ++axis)
    if (std::abs(std::remainder(at[axis] - through_[axis], pitch_)) > same_place) return false;
  const std::vector<double> wanted = heights(task_, at.z());
  const double turned = turn_of(task_.frame(), base_from_tool) - turn_;
  return std::all_of(wanted.begin(), wanted.end(), [&](double height) { return holds(heights_, height); }) &&
         std::abs(std::remainder(turned, 2.0 * std::numbers::pi)) < same_turn && in_same_posture(q, q_);
}

std::optional<std::size_t> Lattice::neighbour(std::size_t place, std::size_t direction) const {
  const std::size_t axis = direction / 2;
  const std::array<std::size_t, 3> strides{across_[1], 1, across_[0] * across_[1]};
  const std::size_t at = place / strides[axis] % across_[axis];
  if (goes_back(direction) ? at == 0 : at + 1 >= across_[axis]) return std::nullopt;
  return goes_back(direction) ? place - strides[axis] : place + strides[axis];
}

MotionPtr Lattice::step(std::size_t place, std::size_t direction, const support::Cancellation& cancellation) const {
  const std::lock_guard lock(mutex_);
  return kept_step(place, direction, cancellation);
}

const MotionPtr& Lattice::kept_step(std::size_t place, std::size_t direction,
                                    const support::Cancellation& cancellation) const {
  std::optional<MotionPtr>& kept = steps_[place * directions + direction];
  if (!kept) kept = made(place, direction, cancellation);
  return *kept;
}

/// Those that go back along an axis are the way back of those that go forth, whichever is asked for first.
MotionPtr Lattice::made(std::size_t place, std::size_t direction, const support::Cancellation& cancellation) const {
  const auto next = neighbour(place, direction);
  if (!next) return nullptr;
  if (goes_back(direction)) {
    const MotionPtr& forth = kept_step(*next, opposite(direction), cancellation);
    return forth ? reversed(task_, *forth) : nullptr;
  }
  const auto start = task_.posture(places_[place], q_);
  if (!start) return nullptr;
  auto path = task_.straight_path(*start, places_[*next], task_.options().motion.step, cancellation);
  if (!path || path->size() < 2) return nullptr;
  Motion motion;
  motion.path = std::move(*path);
  return finished(task_, std::move(motion));
}

}  // namespace tactus::action
