// SPDX-License-Identifier: BSD-3-Clause
#include "belief/trace.hpp"

#include <algorithm>
#include <cmath>

#include "support/error.hpp"
#include "support/rng.hpp"

namespace tactus::belief {
namespace {

using support::Error;
using support::Status;

constexpr double tie = 1e-9;              // rad or m: passes of one path through the same configuration
constexpr double touch_spacing = 0.0001;  // m
constexpr int thirds = 50;                // of a search that leaves two thirds each time

void check(const Task& task, const Observation& observation) {
  const int dof = task.scene().robot->dof();
  if (observation.q.size() != dof)
    throw Error(Status::invalid_argument, "observation.joints: found " + std::to_string(observation.q.size()) +
                                              " values, expected " + std::to_string(dof));
  for (int j = 0; j < dof; ++j)
    if (!std::isfinite(observation.q[j]))
      throw Error(Status::invalid_argument, "observation.joints[" + std::to_string(j) + "] (" +
                                                task.scene().robot->joints[j].name +
                                                "): found a value that is not finite, expected a joint position");
}

double bound(const Task& task, const JointVector& a, const JointVector& b) {
  return task.known_world().displacement(a, b);
}

JointVector between(const JointVector& from, const JointVector& to, double fraction) {
  return from + fraction * (to - from);
}

/// A point of a segment, and how far it is from where a robot says that it is.
struct Nearest {
  double fraction = 0.0;
  double away = 0.0;
};

Nearest nearest_in_joints(const JointVector& from, const JointVector& to, const JointVector& q) {
  const JointVector along = to - from;
  const double length = along.squaredNorm();
  const double fraction = length > 0.0 ? std::clamp(along.dot(q - from) / length, 0.0, 1.0) : 1.0;
  return {fraction, (between(from, to, fraction) - q).norm()};
}

/// By how far a point of the robot may be off, which is convex along a segment. Where that is more than `enough`
/// anyway, the nearer end.
Nearest nearest_in_metres(const Task& task, const JointVector& from, const JointVector& to, const JointVector& q,
                          double enough) {
  const double start = bound(task, from, q), end = bound(task, to, q);
  Nearest best = start < end ? Nearest{0.0, start} : Nearest{1.0, end};
  if (start - bound(task, from, to) > enough) return best;
  double low = 0.0, high = 1.0;
  for (int i = 0; i < thirds; ++i) {
    const double third = (high - low) / 3.0;
    const double left = bound(task, between(from, to, low + third), q);
    const double right = bound(task, between(from, to, high - third), q);
    (left <= right ? high : low) += left <= right ? -third : third;
  }
  const double middle = 0.5 * (low + high), away = bound(task, between(from, to, middle), q);
  return away < best.away - tie ? Nearest{middle, away} : best;
}

/// The points of a path's segments that are nearest to a configuration, as `measure` has it; the first is the path's
/// beginning.
template <typename Measure>
std::vector<Nearest> nearest_points(const JointPath& path, const Measure& measure) {
  std::vector<Nearest> points{measure(path.front(), path.front())};
  for (std::size_t i = 1; i < path.size(); ++i) points.push_back(measure(path[i - 1], path[i]));
  return points;
}

/// Where a path comes nearest: the first such pass, or the last. A robot that may be off by `error` may have stopped on
/// any pass within that: the first of these counts, as what comes after it may not have been tested.
Stop nearest_pass(const std::vector<Nearest>& points, bool first, double error) {
  const auto least = std::min_element(points.begin(), points.end(),
                                      [](const Nearest& a, const Nearest& b) { return a.away < b.away; });
  const auto is_off = [&](const Nearest& point) { return point.away > std::max(least->away, error) + tie; };
  auto begin = points.begin(), end = points.end();
  if (first && error > 0.0) {
    begin = std::find_if_not(begin, end, is_off);
    end = std::find_if(begin, end, is_off);
  }
  const auto index = [&](auto point) { return static_cast<std::size_t>(point - points.begin()); };
  Stop best{index(begin), begin->fraction, 0};
  double nearest = begin->away;
  for (auto point = begin + 1; point != end; ++point) {
    const bool nearer = first ? point->away < nearest - tie : point->away <= nearest + tie;
    if (!nearer || (point->fraction == 0.0 && point->away >= nearest - tie)) continue;
    nearest = std::min(nearest, point->away);
    best = {index(point), point->fraction, 0};
  }
  return best;
}

JointVector point(const JointPath& path, const Stop& stop) {
  return stop.segment == 0 ? path.front() : between(path[stop.segment - 1], path[stop.segment], stop.fraction);
}

/// The straight way to `to`, no point of the robot moving more than `touch_spacing` at a time.
void add_closely(const Task& task, const JointVector& to, JointPath& path) {
  const JointVector from = path.back();
  const int count = std::max(1, static_cast<int>(std::ceil(bound(task, from, to) / touch_spacing)));
  for (int k = 1; k <= count; ++k) path.push_back(k == count ? to : between(from, to, static_cast<double>(k) / count));
}

/// The configuration `back` metres of motion before the stop on its segment; the segment's beginning if that is nearer.
JointVector backed_off(const Task& task, const JointVector& from, const JointVector& stop, double back) {
  const double length = bound(task, from, stop);
  return length <= back ? from : between(stop, from, back / length);
}

/// Adds a free configuration before a contact if the next waypoint is the stop, and from there the way by `rest` to the
/// stop, which is its end: closely where the robot may have travelled on, else the stop alone.
void add_stop(const Task& task, const action::Sensing& sensing, const JointPath& rest, Trace& trace) {
  const JointVector& stop = rest.back();
  if (rest.size() == 1) {
    const JointVector free = backed_off(task, trace.path.back(), stop, stop_blur(task, sensing));
    if (free != trace.path.back()) trace.path.push_back(free);
  }
  trace.touch = trace.path.size();
  trace.travel = sensing.stopping_distance;
  trace.slack = sensing.stopping_distance > 0.0 ? touch_spacing : 0.0;
  if (trace.slack > 0.0)
    for (const JointVector& q : rest) add_closely(task, q, trace.path);
  else
    trace.path.push_back(stop);
}

}  // namespace

double stop_blur(const Task& task, const action::Sensing& sensing) {
  return task.options().stop_tolerance + sensing.stopping_distance + 2.0 * sensing.encoder_error;
}

Stop locate(const Task& task, const Action& action, const Observation& observation) {
  check(task, observation);
  const JointPath& path = action.path;
  const JointVector& q = observation.q;
  const action::Sensing sensing = worse_of(task.options().sensing, action.sensing);
  const double error = sensing.encoder_error;
  const double allowed = std::max({0.001, task.options().stop_tolerance, error + tie});
  const double off_end = bound(task, path.back(), q);
  if (error > 0.0 && !observation.contact && off_end <= error + tie) return {path.size() - 1, 1.0, path.size() - 1};
  const bool first_pass = observation.contact || off_end > allowed;
  const auto in_joints = [&](const JointVector& from, const JointVector& to) { return nearest_in_joints(from, to, q); };
  const auto in_metres = [&](const JointVector& from, const JointVector& to) {
    return nearest_in_metres(task, from, to, q, allowed);
  };
  Stop best = nearest_pass(nearest_points(path, in_joints), first_pass, 0.0);
  if (error > 0.0 || bound(task, point(path, best), q) > allowed)
    best = nearest_pass(nearest_points(path, in_metres), first_pass, error);
  const JointVector on_path = point(path, best);
  const double off = bound(task, on_path, q);
  if (off > allowed)
    throw Error(Status::stop_off_path, "observation.joints: found a stop up to " + std::to_string(1000.0 * off) +
                                           " mm off the action's path, expected at most " +
                                           std::to_string(1000.0 * allowed) +
                                           " mm; after a jog use set_configuration instead");
  if (!observation.contact) {
    best.last_free = best.segment == 0 || best.fraction >= 1.0 - 1e-9 ? best.segment : best.segment - 1;
    return best;
  }
  best.last_free = best.segment == 0 ? 0 : best.segment - 1;
  while (best.last_free > 0 && bound(task, path[best.last_free], on_path) < stop_blur(task, sensing)) --best.last_free;
  return best;
}

std::vector<const Trace*> believed(const std::vector<Trace>& history) {
  std::vector<const Trace*> traces;
  for (const Trace& trace : history)
    if (!trace.doubted) traces.push_back(&trace);
  return traces;
}

bool has_met_something(const std::vector<Trace>& history) {
  return std::any_of(history.begin(), history.end(), [](const Trace& trace) { return trace.contact; });
}

std::uint64_t fingerprint(const std::vector<Trace>& history, std::size_t count) {
  std::uint64_t print = support::mix(count);
  for (std::size_t i = 0; i < count; ++i)
    print = support::mix(print ^ action::path_id(history[i].path) ^ (history[i].contact ? 1 : 0));
  return print;
}

Trace trace_of(const Task& task, const Action& action, const Observation& observation, const Stop& stop) {
  Trace trace;
  trace.action_id = action.id;
  trace.kind = action.kind;
  trace.contact = observation.contact;
  trace.outcome = observation.contact
                      ? stop.segment
                      : (stop.last_free + 1 == action.path.size() ? action.path.size() : stop.last_free);
  trace.path.assign(action.path.begin(), action.path.begin() + static_cast<std::ptrdiff_t>(stop.last_free) + 1);
  trace.touch = trace.path.size();
  const action::Sensing sensing = worse_of(task.options().sensing, action.sensing);
  trace.error = sensing.encoder_error;
  if (observation.contact) {
    JointPath rest;
    for (std::size_t i = stop.last_free + 1; i < stop.segment; ++i) rest.push_back(action.path[i]);
    rest.push_back(observation.q);
    add_stop(task, sensing, rest, trace);
  } else if (stop.segment > stop.last_free)
    trace.path.push_back(observation.q), trace.touch = trace.path.size();
  trace.bodies = BodyPath(task.bodies(), trace.path);
  return trace;
}

Trace retraced(const Task& task, const Trace& trace, const action::Sensing& sensing) {
  Trace again = trace;
  again.error = std::max(trace.error, sensing.encoder_error);
  if (!trace.contact || trace.travel == sensing.stopping_distance) return again;
  JointPath rest{trace.path.back()};
  again.path.pop_back();
  while (again.path.size() > 1 && bound(task, again.path.back(), rest.back()) < stop_blur(task, sensing)) {
    rest.insert(rest.begin(), again.path.back());
    again.path.pop_back();
  }
  add_stop(task, sensing, rest, again);
  again.bodies = BodyPath(task.bodies(), again.path);
  return again;
}

bool may_touch(const Task& task, const Trace& trace, const Pose& base_from_target, double radius, Effort* effort) {
  const contact::TargetContact& target = task.target_contact();
  const double reach = radius + target.margin() + trace.error + trace.slack;
  return target.first_within(trace.bodies, base_from_target, reach, trace.touch, effort).has_value();
}

/// No waypoint before the touch, from `from` on, is certainly in contact with the target at every pose of the set.
bool may_be_free(const Task& task, const Trace& trace, const Pose& base_from_target, double radius, std::size_t from,
                 Effort* effort = nullptr) {
  if (from >= trace.touch) return true;
  const contact::TargetContact& target = task.target_contact();
  const double sound = radius + target.margin() + trace.error;
  const auto first = target.first_certain_contact(trace.bodies, base_from_target, sound, from, effort);
  return !first || *first >= trace.touch;
}

bool reproduces(const Task& task, const Trace& trace, const Pose& base_from_target) {
  if (trace.contact && !may_touch(task, trace, base_from_target, 0.0)) return false;
  if (trace.error > 0.0) return may_be_free(task, trace, base_from_target, 0.0, 0);
  const auto first = task.target_contact().first_within(trace.bodies, base_from_target, 0.0, 0);
  return !first || *first >= trace.touch;
}

bool may_reproduce(const Task& task, const Trace& trace, const Pose& base_from_target, double radius, Effort* effort) {
  return (!trace.contact || may_touch(task, trace, base_from_target, radius, effort)) &&
         may_be_free(task, trace, base_from_target, radius, 0, effort);
}

bool reproduces(const Task& task, const std::vector<const Trace*>& traces, const Pose& base_from_target) {
  return std::all_of(traces.rbegin(), traces.rend(),
                     [&](const Trace* trace) { return reproduces(task, *trace, base_from_target); });
}

bool reproduces(const Task& task, const std::vector<Trace>& history, const Pose& base_from_target) {
  return reproduces(task, believed(history), base_from_target);
}

bool may_reproduce(const Task& task, const std::vector<Trace>& history, const Pose& base_from_target, double radius) {
  return std::all_of(history.rbegin(), history.rend(), [&](const Trace& trace) {
    return trace.doubted || may_reproduce(task, trace, base_from_target, radius);
  });
}

SetOut set_out(const Task& task, const Trace& trace, const Pose& base_from_target, double radius) {
  const contact::TargetContact& target = task.target_contact();
  const double sound = radius + target.margin() + trace.error;
  SetOut found;
  while (found.clear < trace.touch && target.within(trace.bodies, found.clear, base_from_target, sound)) ++found.clear;
  while (found.inside < found.clear &&
         target.first_certain_contact(trace.bodies, base_from_target, sound, found.inside) == found.inside)
    ++found.inside;
  return found;
}

Fit fit_free(const Task& task, const Trace& trace, const Pose& base_from_target, double radius, std::size_t from) {
  if (from >= trace.touch) return Fit::all;
  const contact::TargetContact& target = task.target_contact();
  const auto first = target.first_within(trace.bodies, base_from_target, radius + target.margin(), from);
  if (!first || *first >= trace.touch) return Fit::all;
  return may_be_free(task, trace, base_from_target, radius, *first) ? Fit::some : Fit::none;
}

Fit fit_touch(const Task& task, const Trace& trace, const Pose& base_from_target, double radius) {
  if (!may_touch(task, trace, base_from_target, radius)) return Fit::none;
  const contact::TargetContact& target = task.target_contact();
  const double sound = radius + target.margin() + trace.error;
  return target.first_certain_contact(trace.bodies, base_from_target, sound, trace.touch) ? Fit::all : Fit::some;
}

}  // namespace tactus::belief
