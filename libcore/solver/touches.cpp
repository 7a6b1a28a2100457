// SPDX-License-Identifier: BSD-3-Clause
#include "solver/touches.hpp"

#include <algorithm>

namespace tactus::solver {
namespace {

using geometry::Pose;
using Shift = Eigen::Matrix<double, 6, 1>;

constexpr double lever = 0.05;        // m: a turn shifts the tool's surface by about this times it
constexpr double same_place = 0.002;  // m
constexpr double same_way = 0.9;      // cosine
constexpr double least_step = 1e-6;   // m

/// What takes one pose to another: the shift, and the turn times the lever, both in the base frame.
Shift shift_between(const Pose& from, const Pose& to) {
  const Eigen::AngleAxisd turn(to.linear() * from.linear().transpose());
  Shift shift;
  shift << to.translation() - from.translation(), lever * turn.angle() * turn.axis();
  return shift;
}

/// Both of an outcome's ends: one that lasts long is no single touch.
bool is_like_one(const Choice& choice, const Outcome& outcome, const std::vector<Touch>& touches) {
  const auto is_met = [&](std::size_t waypoint) {
    const auto touch = touch_between(choice.motion->bodies, waypoint - 1, waypoint);
    return touch && std::any_of(touches.begin(), touches.end(), [&](const Touch& met) { return alike(*touch, met); });
  };
  return outcome.waypoint > 0 && outcome.last < choice.motion->path.size() && is_met(outcome.waypoint) &&
         is_met(outcome.last);
}

}  // namespace

std::optional<Touch> touch_between(const contact::BodyPath& bodies, std::size_t from, std::size_t to) {
  const Pose& at = bodies.base_from_body(to, 0);
  const Shift way = shift_between(bodies.base_from_body(from, 0), at);
  if (way.norm() < least_step) return std::nullopt;
  return Touch{at, way.normalized()};
}

std::optional<Touch> touch_of(const belief::Trace& trace) {
  if (!trace.contact || trace.touch == 0) return std::nullopt;
  return touch_between(trace.bodies, trace.touch - 1, trace.bodies.size() - 1);
}

bool alike(const Touch& a, const Touch& b) {
  return shift_between(a.base_from_tool, b.base_from_tool).norm() < same_place && a.way.dot(b.way) > same_way;
}

double share_alike(const Choice& choice, const std::vector<Touch>& touches) {
  double share = 0.0;
  for (const Outcome& outcome : choice.outcomes)
    if (is_like_one(choice, outcome, touches)) share += outcome.probability;
  return share;
}

}  // namespace tactus::solver
