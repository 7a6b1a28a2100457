// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "belief/trace.hpp"

namespace tactus::belief {

/// Boxes of poses, all of one size, whose middles lie round about a pose.
struct Boxes {
  double radius;  ///< m that a point of the target may be off at any pose of them;
  double own;     ///< m, at a pose of one of them beside its middle;
  double spread;  ///< m, at a middle
};

/// A trace, as it is asked of ever smaller sets of boxes of poses: may they have given it? What was found out for a set
/// holds for its parts: the bodies that can't be deep enough in the target anywhere in it are not asked again. A value.
class Claim {
 public:
  /// Of any set. `trace` must outlive the claim.
  explicit Claim(const Trace& trace);

  bool of_contact() const { return trace_->contact; }

  /// Whether none of the boxes can have a pose that gave the trace, or `may_be_met` would be true of all of them; errs
  /// to `some` only. From then on the claim is one about these boxes.
  Fit narrow(const Task& task, const Pose& base_from_target, const Boxes& boxes);

  /// Whether one of the boxes may have a pose that gave the trace, as `may_reproduce` has it.
  bool may_be_met(const Task& task, const Pose& base_from_target, double radius) const;

 private:
  bool is_surely_touched(const Task& task, const Pose& base_from_target, double radius) const;

  const Trace* trace_;
  std::vector<std::uint32_t> from_;  ///< by body: at no earlier waypoint are all poses of a box touched
};

}  // namespace tactus::belief
