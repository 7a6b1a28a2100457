// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <mutex>
#include <optional>

#include "action/action.hpp"
#include "action/lattice.hpp"
#include "support/deadline.hpp"

namespace tactus::action {

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

}  // namespace tactus::action
