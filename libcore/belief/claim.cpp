// SPDX-License-Identifier: BSD-3-Clause
#include "belief/claim.hpp"

#include <cmath>

namespace tactus::belief {
namespace {

constexpr double least_depth = 0.0005;  // m: less is not told apart from a touch

/// m by which a body is deflated where it touches all poses of a set.
double certain_depth(const Task& task, const Trace& trace, double radius) {
  return radius + task.target_contact().margin() + trace.error;
}

}  // namespace

Claim::Claim(const Trace& trace) : trace_(&trace), from_(trace.bodies.bodies(), 0) {}

/// Where all poses of a box are touched the robot is so deep in the target at its middle that at `base_from_target` it
/// is nearly as deep.
Fit Claim::narrow(const Task& task, const Pose& base_from_target, const Boxes& boxes) {
  if (trace_->contact && !may_touch(task, *trace_, base_from_target, boxes.radius)) return Fit::none;
  double deep = certain_depth(task, *trace_, boxes.own) - boxes.spread;
  if (std::abs(deep) < least_depth) deep = -least_depth;
  bool is_open = false;
  for (std::size_t body = 0; body < from_.size(); ++body) {
    const std::size_t first = task.target_contact().first_possible_contact(trace_->bodies, body, base_from_target, deep,
                                                                           from_[body], trace_->touch);
    from_[body] = static_cast<std::uint32_t>(first);
    is_open = is_open || first < trace_->touch;
  }
  if (!is_open) return trace_->contact ? Fit::some : Fit::all;
  return is_surely_touched(task, base_from_target, boxes.radius) ? Fit::none : Fit::some;
}

bool Claim::may_be_met(const Task& task, const Pose& base_from_target, double radius) const {
  return (!trace_->contact || may_touch(task, *trace_, base_from_target, radius)) &&
         !is_surely_touched(task, base_from_target, radius);
}

bool Claim::is_surely_touched(const Task& task, const Pose& base_from_target, double radius) const {
  const double depth = certain_depth(task, *trace_, radius);
  for (std::size_t body = 0; body < from_.size(); ++body)
    if (task.target_contact().first_certain_contact(trace_->bodies, body, base_from_target, depth, from_[body],
                                                    trace_->touch) < trace_->touch)
      return true;
  return false;
}

}  // namespace tactus::belief
