// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <mutex>
#include <optional>
#include <vector>

#include "action/motion.hpp"
#include "support/cancellation.hpp"

namespace tactus::action {

/// Places of the tool through the whole region, in rows along the axes of the search frame, turned about the approach
/// axis as it is where it stands: on the retreat plane, and in layers as deep as sweeps go. One row each way and one
/// layer go through where it stands. Neighbouring places are joined by short guarded moves, made when first asked for
/// and kept: what a walk that looks for the target is laid out on. May be shared by threads.
class Lattice {
 public:
  /// `q`: where the robot stands, whose posture is kept. `pitch`: m between neighbouring places of a layer. The task
  /// must outlive it.
  Lattice(const Task& task, const JointVector& q, double pitch);

  std::size_t size() const { return places_.size(); }
  const Pose& base_from_tool(std::size_t place) const { return places_[place]; }
  bool is_on_plane(std::size_t place) const { return place < across_[0] * across_[1]; }
  double pitch() const { return pitch_; }

  static constexpr double same_place = 0.01;  ///< m within which a tool stands on a place

  /// Whether a robot at `q` stands on a place in the same posture, or would if the lattice went on that far.
  bool passes(const JointVector& q) const;

  static constexpr std::size_t directions = 6;  ///< +x, -x, +y, -y, +z, -z of the search frame

  /// The next place that way; none at the edge.
  std::optional<std::size_t> neighbour(std::size_t place, std::size_t direction) const;

  /// The move there; null where the known world or the limits block it. Throws `Cancelled`.
  MotionPtr step(std::size_t place, std::size_t direction, const support::Cancellation& cancellation = {}) const;

 private:
  const MotionPtr& kept_step(std::size_t place, std::size_t direction, const support::Cancellation& cancellation) const;
  MotionPtr made(std::size_t place, std::size_t direction, const support::Cancellation& cancellation) const;

  const Task& task_;
  JointVector q_;
  double pitch_;
  Vector3 through_;                      ///< search frame
  double turn_;                          ///< rad
  std::vector<double> heights_;          ///< of the retreat plane and the layers, ascending
  std::array<std::size_t, 3> across_{};  ///< places along each axis
  std::vector<Pose> places_;             ///< x slowest within a layer, the retreat plane's first
  mutable std::mutex mutex_;
  mutable std::vector<std::optional<MotionPtr>> steps_;  ///< by place and direction
};

}  // namespace tactus::action
