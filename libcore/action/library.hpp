// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <mutex>
#include <optional>

#include "action/lattice.hpp"
#include "action/motion.hpp"
#include "support/deadline.hpp"

namespace tactus::action {

/// What the robot executes, guarded: a joint path from its present configuration, with times. Const, shared between
/// planner, belief and caller.
struct Action {
  std::uint64_t id = 0;  ///< of the path: equal paths have equal ids
  Kind kind = Kind::move;
  JointPath path;
  std::vector<double> times;  ///< s, by waypoint
  BodyPath bodies;
  std::size_t lead = 0;              ///< waypoints before the motion proper: the way over the retreat plane
  double length = 0.0;               ///< m that the tool frame goes if nothing is touched
  double full_cost = 0.0;            ///< of going all the way
  double expected_cost = 0.0;        ///< as the planner saw it
  double contact_probability = 0.0;  ///< as the planner saw it
  Sensing sensing;                   ///< what is taken for possible of the robot, and decides where its contact may be
  Pose supposed_target = Pose::Identity();
};

using ActionPtr = std::shared_ptr<const Action>;

/// Makes and keeps motions. Grows lazily behind a mutex; may be shared by threads.
class ActionLibrary {
 public:
  explicit ActionLibrary(const Task& task) : task_(task) {}

  /// Through where the robot stands; kept for as long as it moves along its rows.
  std::shared_ptr<const Lattice> lattice_through(const JointVector& q);

  /// `primitives` from `q`, made once per configuration. Throws `Cancelled`, as the next.
  std::vector<MotionPtr> primitives_at(const JointVector& q, const support::Cancellation& cancellation = {});

  /// `probes` through a region, or a little beyond it: kept for as long as the next region fills most of the last one
  /// they were made for, and the robot stays in a similar posture.
  std::vector<MotionPtr> probes_in(const geometry::Box& region, const JointVector& near, int most,
                                   const support::Cancellation& cancellation = {});

  /// The executable action that takes the robot from `q` through `motion`: its way back and over the retreat plane
  /// first if it is anchored, by a planned path where the straight one is not free. None if no free way is found.
  /// `way_back`: a way from `q` that is known to be free of the target too; followed as far as the retreat plane.
  std::optional<Action> realise(const JointVector& q, const Motion& motion, const support::Deadline& deadline,
                                const JointPath& way_back = {}) const;

 private:
  std::optional<Action> realise_anchored(const JointVector& q, const Motion& motion, const support::Deadline& deadline,
                                         const JointPath& way_back) const;
  JointPath lead_in(JointPath path, const JointVector& start, const support::Deadline& deadline) const;
  JointPath connected(JointPath path, const JointVector& start, const support::Deadline& deadline) const;
  bool are_inside_limits(const JointPath& path) const;
  JointPath as_far_as_plane(const JointPath& way_back, const JointVector& start) const;
  double past_plane(const JointVector& q, const JointVector& start) const;

  const Task& task_;
  std::shared_ptr<const Lattice> lattice_;
  std::mutex mutex_;
  std::map<std::vector<double>, std::vector<MotionPtr>> primitives_;
  struct Probes {
    geometry::Box region;
    JointVector near;  ///< empty before the first
    int most = 0;
    std::vector<MotionPtr> motions;
  };
  Probes probes_;
};

/// A hash of the waypoints: the identity of an action.
std::uint64_t path_id(const JointPath& path);

/// An action along `path` with everything that follows from it.
Action make_action(const Task& task, Kind kind, JointPath path, std::size_t lead,
                   const std::vector<motion::PacedSegment>& pace);

}  // namespace tactus::action
