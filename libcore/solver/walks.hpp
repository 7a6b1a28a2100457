// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "action/lattice.hpp"
#include "solver/predictions.hpp"

namespace tactus::solver {

/// A way from place to place of a lattice, and what it costs to get to the first of them.
struct Walk {
  double entry = 0.0;
  std::vector<std::pair<std::size_t, std::size_t>> steps;  ///< place and direction
};

/// What walks over a lattice cost, and which poses they touch. One thread.
class Walks {
 public:
  struct Step {
    std::size_t to = 0;       ///< place
    double cost = 0.0;        ///< 1e300 where it is blocked
    support::Bitset touched;  ///< poses
  };

  /// `predictions` must outlive it.
  Walks(std::shared_ptr<const action::Task> task, std::shared_ptr<const action::Lattice> lattice,
        Predictions& predictions);

  const action::Lattice& lattice() const { return *lattice_; }
  const Step& step(std::size_t place, std::size_t direction) const;

  /// What it costs to get to a place: over the retreat plane to one on it, straight to one next to the tool; 1e300 to
  /// any other.
  double entry_cost(const geometry::Pose& base_from_tool, std::size_t place) const;

  /// The moves of a robot at `q`, whose tool is at a place, to the places next to it, that in the direction `first` in
  /// front; none if it is at no place.
  std::vector<action::MotionPtr> steps_from(const robot::JointVector& q, std::size_t first = 0) const;

  /// The walk on which the least is spent on average until it touches the target, if that is at one of these poses. If
  /// it can't get to nearly all of them, a walk to those that it can. `beam`: ways that are followed side by side; the
  /// time it takes grows with them.
  Walk best(const support::Bitset& members, const geometry::Pose& base_from_tool, std::size_t beam) const;

  /// The same, or the best that was found when the predictions ran out of time.
  Walk best_in_time(const support::Bitset& members, const geometry::Pose& base_from_tool, std::size_t beam) const;

  /// From the place on a walk that is the cheapest to get to, of several the last; none if there is no way to any.
  std::optional<Walk> rest(const Walk& walk, const geometry::Pose& base_from_tool) const;

  /// Tells a beam how far it is on average until a walk has touched one of all poses: as far as on this one.
  void look_ahead_as_on(const Walk& walk);

 private:
  class Beam;
  Step made_step(std::size_t place, std::size_t direction) const;
  double with_actions(double way) const;

  std::shared_ptr<const action::Task> task_;
  std::shared_ptr<const action::Lattice> lattice_;
  Predictions& predictions_;
  double to_go_ = 0.75;                             ///< m on average until a walk has touched one of all poses
  mutable std::vector<std::optional<Step>> steps_;  ///< by place and direction, once looked at
};

}  // namespace tactus::solver
