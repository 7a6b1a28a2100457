// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "action/action.hpp"

namespace tactus::belief {

using action::Action;
using action::Task;
using contact::BodyPath;
using contact::Effort;
using geometry::Pose;
using geometry::Vector3;
using motion::JointPath;
using robot::JointVector;

/// What a robot reports after a guarded motion: where its joints stopped, and whether it felt a contact there.
struct Observation {
  bool contact = false;
  JointVector q;
};

/// Where on an action's path an observation lies.
struct Stop {
  std::size_t segment = 0;    ///< between waypoints `segment - 1` and `segment`; 0: at the first waypoint
  double fraction = 0.0;      ///< of that segment, in (0, 1]
  std::size_t last_free = 0;  ///< the last waypoint that is certainly free: where the robot goes back to after a
                              ///< contact, and where it is without one
};

/// m before a reported stop within which the first contact may lie.
double stop_blur(const Task& task, const action::Sensing& sensing);

/// Finds the stop, of a robot that errs by no more than the task or the action has it. A robot without contact at the
/// path's end, give or take the encoder error, has gone all the way; any other stop is the path's first pass there:
/// what comes after it may not have been tested. After a contact the last free waypoint is farther back than the stop
/// tolerance, the stopping distance and what the encoders may be off at both. Throws `stop_off_path` if the robot
/// stopped farther from the path than any point of it may be off (1 mm, the stop tolerance or the encoder error), and
/// `invalid_argument` for a NaN or a wrong number of joints.
Stop locate(const Task& task, const Action& action, const Observation& observation);

/// An action as far as it went, in a form in which it can be replayed against any pose: free at its waypoints; with
/// contact, in touch at one of the last, between which and the reported stop a robot that travels on may have gone.
struct Trace {
  std::uint64_t action_id = 0;
  action::Kind kind = action::Kind::move;
  bool contact = false;
  std::size_t outcome = 0;  ///< as predicted by a planner: the waypoint of the action at the end of the segment in
                            ///< which it stopped; the path's size without contact
  std::size_t touch = 0;    ///< free at the waypoints before this one; the path's size without contact
  double slack = 0.0;       ///< m: a contact came within this of the waypoints from `touch` on, or of one of them
  double travel = 0.0;      ///< m that a point of the robot may have gone on after a contact
  double error = 0.0;       ///< m by which the waypoints may put a point of it off
  bool doubted = false;     ///< it contradicts the others, and is left out: a contact that was none, for instance
  JointPath path;
  BodyPath bodies;
};

/// The traces that are not doubted.
std::vector<const Trace*> believed(const std::vector<Trace>& history);

bool has_met_something(const std::vector<Trace>& history);

/// Of what was done and seen, in order: equal for beliefs of one model that went through the same.
std::uint64_t fingerprint(const std::vector<Trace>& history, std::size_t count);

/// Of such a robot.
Trace trace_of(const Task& task, const Action& action, const Observation& observation, const Stop& stop);

/// The same of a robot that errs more than the action had it: the touch may be farther back.
Trace retraced(const Task& task, const Trace& trace, const action::Sensing& sensing);

/// Whether a target at exactly this pose would have given the trace.
bool reproduces(const Task& task, const Trace& trace, const Pose& base_from_target);

/// Whether some pose at which no point of the target is farther than `radius` from where it is at `base_from_target`
/// may have given the trace. Errs to true only. Adds to `effort` if there is one.
bool may_reproduce(const Task& task, const Trace& trace, const Pose& base_from_target, double radius,
                   Effort* effort = nullptr);

/// The same of where the robot stopped alone, for a trace with a contact.
bool may_touch(const Task& task, const Trace& trace, const Pose& base_from_target, double radius,
               Effort* effort = nullptr);

/// The same of every one of some traces.
bool reproduces(const Task& task, const std::vector<const Trace*>& traces, const Pose& base_from_target);

/// The same of every trace of a history that is not doubted.
bool reproduces(const Task& task, const std::vector<Trace>& history, const Pose& base_from_target);
bool may_reproduce(const Task& task, const std::vector<Trace>& history, const Pose& base_from_target, double radius);

/// Of the poses of such a set, none can have given a trace, perhaps some, or every one would have.
enum class Fit { none, some, all };

/// How many waypoints from the first one on lie in the target at every pose of such a set (errs to fewer only), and the
/// first waypoint that is clear of it at each of them (errs to later only), up to `Trace::touch`. A robot that sets out
/// in the target, after a contact that it missed, feels none before it was clear.
struct SetOut {
  std::size_t inside = 0, clear = 0;
};
SetOut set_out(const Task& task, const Trace& trace, const Pose& base_from_target, double radius);

/// Of the poses of such a set, whether the robot was free of the target from the waypoint `from` on to where it may
/// have touched, and whether it was in touch where it felt a contact. Err to `some` only.
Fit fit_free(const Task& task, const Trace& trace, const Pose& base_from_target, double radius, std::size_t from);
Fit fit_touch(const Task& task, const Trace& trace, const Pose& base_from_target, double radius);

}  // namespace tactus::belief
