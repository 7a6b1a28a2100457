// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "action/lattice.hpp"
#include "solver/rate_policy.hpp"

namespace tactus::solver {

/// What a policy costs that looks for the target by walking: from place to place of a lattice, by the way on which the
/// least is walked on average until something is touched, and what the rate policy does from there on. Where that
/// policy begins with whole sweeps, each from the retreat plane, a walk goes on where it is; no step of it need pay by
/// itself. Found by beam search. One thread.
class WalkPolicy {
 public:
  using Members = RatePolicy::Members;

  /// `predictions` and `after` must outlive it. `base_from_tool`: where planning begins, by which the beam is told how
  /// far there is to go. `dimensions`: of the poses, as for `least_group`.
  WalkPolicy(std::shared_ptr<const action::Task> task, std::shared_ptr<const action::Lattice> lattice,
             Predictions& predictions, RatePolicy& after, const geometry::Pose& base_from_tool, int dimensions);

  /// Expected cost until the tool is seated, if the target is at one of these poses (not empty), from where the tool
  /// is. Never less than the best policy costs, as far as the ways to the lattice's places and over the retreat plane
  /// are free. `beam`: ways that are followed side by side; the time it takes grows with them. The rest of the walk
  /// found where planning begins counts beside what they find, so that who goes along it is worth what it promised.
  double cost(const Members& members, const geometry::Pose& base_from_tool, std::size_t beam = careful);

  static constexpr std::size_t quick = 6, careful = 24;

  double pitch() const { return lattice_->pitch(); }  ///< m, of its steps

 private:
  struct Step {
    std::size_t to = 0;       ///< place
    double cost = 0.0;        ///< 1e300 where it is blocked
    support::Bitset touched;  ///< poses
  };
  struct Stand {
    std::size_t place = 0, direction = 0;  ///< where it is, and how it came there
    int before = -1;                       ///< the stand that it came from
    std::size_t count = 0;                 ///< of the poses not touched so far
    double spent = 0.0;                    ///< if nothing was touched
    double expected = 0.0;                 ///< until something was touched, or up to here
    support::Bitset left{};                ///< the poses not touched so far
  };
  /// The steps of the best walk, and what it costs to get to the first of them.
  struct Walk {
    double entry = 0.0;
    std::vector<std::pair<std::size_t, std::size_t>> steps;  ///< place and direction
  };

  double cost_of(const Walk& walk, support::Bitset left, const geometry::Pose& base_from_tool);
  Walk rest_of_first(const geometry::Pose& base_from_tool) const;
  Walk best_walk(const support::Bitset& members, const geometry::Pose& base_from_tool, std::size_t beam) const;
  std::vector<Stand> entries(const support::Bitset& members, const geometry::Pose& base_from_tool) const;
  double with_actions(double way) const;
  double entry_cost(const geometry::Pose& base_from_tool, std::size_t place) const;
  const Step& step(std::size_t place, std::size_t direction) const;
  Step made_step(std::size_t place, std::size_t direction) const;
  const std::vector<double>& after_step(std::size_t place, std::size_t direction);

  std::shared_ptr<const action::Task> task_;
  std::shared_ptr<const action::Lattice> lattice_;
  Predictions& predictions_;
  RatePolicy& after_;
  int dimensions_;
  double to_go_ = 0.5;                              ///< m on average until a walk has touched one of all poses
  Walk first_;                                      ///< where planning begins, with all poses
  mutable std::vector<std::optional<Step>> steps_;  ///< by place and direction, once looked at
  std::vector<std::vector<double>> costs_after_;    ///< likewise, by pose: what it costs from its contact on
};

}  // namespace tactus::solver
