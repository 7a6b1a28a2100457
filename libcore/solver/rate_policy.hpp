// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unordered_map>

#include "solver/predictions.hpp"
#include "solver/seats.hpp"

namespace tactus::solver {

/// What a simple policy costs that always ends: the motion with the most information per cost, again and again, until
/// attempts at the poses that are left, one after another, are cheaper. It chooses among anchored motions; where few
/// poses are left, without regard to where the robot is, so that a set of them is weighed once. An upper bound of the
/// value of a belief on these poses, as far as the ways over the retreat plane, those near by to a motion or an
/// attempt, and the attempts are free. One thread.
class RatePolicy {
 public:
  using Members = std::vector<std::size_t>;  ///< poses, ascending

  /// By pose: the attempt at it, and the poses that it serves. `dimensions`: of the poses, as for `least_group`. This
  /// and what follows throw `Cancelled` when the predictions do.
  RatePolicy(std::shared_ptr<const action::Task> task, Predictions& predictions, std::vector<action::MotionPtr> motions,
             std::vector<Attempt> attempts, std::vector<support::Bitset> served, int dimensions);

  /// Expected cost until the tool is seated, if the target is at one of these poses (not empty), from where the tool
  /// is.
  double cost(const Members& members, const geometry::Pose& base_from_tool);

  /// The same by member: what it costs if the target is at that one, of which only the policy does not know.
  std::vector<double> costs(const Members& members, const geometry::Pose& base_from_tool);

  /// Up to `most` of its motions that tell something, those with the most information per cost from where the tool is
  /// first.
  std::vector<action::MotionPtr> promising(const Members& members, const geometry::Pose& base_from_tool,
                                           std::size_t most);

 private:
  struct Plan {
    geometry::Pose base_from_start = geometry::Pose::Identity();  ///< of the first motion
    geometry::Pose base_from_near = geometry::Pose::Identity();   ///< on it, shortly before anything can be met
    double until_near = 0.0;                                      ///< from the one to the other, in units of cost
    const Attempt* attempt = nullptr;                             ///< the first motion, if it is one
    std::vector<double> costs;                                    ///< from there on, or from its end, by member
    double cost = 1e300;                                          ///< their mean
  };
  struct Plans {
    Plan probing, attempts;
  };
  const Plan& plan(const Members& members, const geometry::Pose& base_from_tool);
  double first_cost(const geometry::Pose& base_from_tool, const Plan& plan) const;
  double attempt_cost(const geometry::Pose& base_from_tool, const Attempt& attempt) const;
  double near_cost(const geometry::Pose& base_from_tool, const geometry::Pose& base_from_near) const;
  Plan attempts_at(const Members& members) const;
  Plan probing(const Members& members, const geometry::Pose* base_from_tool);
  double lead(const geometry::Pose& base_from_tool, const geometry::Pose& base_from_start) const;
  template <typename Entry>
  bool are_mostly_near(std::size_t motion, Entry begin, Entry end, std::int32_t waypoint) const;
  template <typename Visit>
  void for_each_group(std::size_t motion, const Members& members, Visit&& visit);
  double rate_of(std::size_t motion, const Members& members, const geometry::Pose* base_from_tool);
  double cost_to(std::size_t motion, std::size_t waypoint) const;
  std::size_t place_before(std::size_t motion, std::size_t waypoint) const;

  struct HashOf {
    std::size_t operator()(const support::Hash128& h) const { return h.low; }
  };
  std::shared_ptr<const action::Task> task_;
  std::vector<action::MotionPtr> motions_;
  std::vector<const std::vector<std::int32_t>*> first_contacts_;  ///< by motion
  std::vector<const std::vector<std::int32_t>*> first_nears_;     ///< by motion
  std::vector<Attempt> attempts_;
  std::vector<support::Bitset> served_;
  int dimensions_;
  support::Cancellation cancellation_;
  std::unordered_map<support::Hash128, Plans, HashOf> plans_;
  std::vector<std::pair<std::int32_t, std::size_t>> sorted_;  ///< by the motion in hand: first contact, pose
};

}  // namespace tactus::solver
