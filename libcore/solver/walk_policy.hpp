// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/rate_policy.hpp"
#include "solver/walks.hpp"

namespace tactus::solver {

/// What a policy costs that looks for the target by walking: from place to place of a lattice, by the way on which the
/// least is walked on average until something is touched, and what the rate policy does from there on. Where that
/// policy begins with whole sweeps, each from the retreat plane, a walk goes on where it is; no step of it need pay by
/// itself. Found by beam search. One thread.
class WalkPolicy {
 public:
  using Members = RatePolicy::Members;

  /// `predictions` and `after` must outlive it. `base_from_tool`: where planning begins, by which the beam is told how
  /// far there is to go. `dimensions`: of the poses, as for `least_group`. The first walk is as good as there is time
  /// for, by the predictions' limit.
  WalkPolicy(std::shared_ptr<const action::Task> task, std::shared_ptr<const action::Lattice> lattice,
             Predictions& predictions, RatePolicy& after, const geometry::Pose& base_from_tool, int dimensions);

  /// Expected cost until the tool is seated, if the target is at one of these poses (not empty), from where the tool
  /// is. Never less than the best policy costs, as far as the ways to the lattice's places and over the retreat plane
  /// are free. `beam`: ways that are followed side by side; the time it takes grows with them. The rest of the walk
  /// found where planning begins counts beside what they find, so that who goes along it is worth what it promised.
  double cost(const Members& members, const geometry::Pose& base_from_tool, std::size_t beam = careful);

  static constexpr std::size_t quick = 6, careful = 24;

  /// Moves from where a robot at `q` stands along the lattice of its walks, as `Walks::steps_from`; that on the walk
  /// found where planning begins in front.
  std::vector<action::MotionPtr> steps_from(const robot::JointVector& q) const {
    return walks_.steps_from(q, first_.steps.empty() ? 0 : first_.steps.front().second);
  }

  double pitch() const { return walks_.lattice().pitch(); }  ///< m, of its steps

 private:
  static constexpr std::size_t thorough = 96;  ///< of the first walk, which all others are measured by

  double cost_of(const Walk& walk, support::Bitset left, const geometry::Pose& base_from_tool);
  const std::vector<double>& after_step(std::size_t place, std::size_t direction);

  Predictions& predictions_;
  RatePolicy& after_;
  int dimensions_;
  Walks walks_;
  Walk first_;                                    ///< where planning begins, with all poses
  std::vector<std::vector<double>> costs_after_;  ///< by place and direction, by pose: from its contact on
};

}  // namespace tactus::solver
