// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "action/library.hpp"
#include "solver/predictions.hpp"
#include "solver/problem.hpp"
#include "solver/rate_policy.hpp"
#include "solver/seats.hpp"
#include "solver/walk_policy.hpp"

namespace tactus::solver {

/// What planning on poses shares between its beliefs: the poses drawn for one planning call, the motions made for them,
/// and where each pose is first touched on each motion. One thread.
class PoseProblem : public std::enable_shared_from_this<PoseProblem> {
 public:
  /// `predictions`: of the poses. `bits`: log2 of how many tolerances the full belief spans; `cost_per_bit` in units of
  /// cost. `nothing_met`: the target is still looked for, by walks where an upper bound is the second value. Then the
  /// steps of walks from where the robot stands are choices at the start, and moves shorter than they are none, as they
  /// meet nothing that longer ones don't, nor are turns, which walks don't make: with them a robot would rather stay
  /// where it is as long as what lies ahead seems worse.
  PoseProblem(std::shared_ptr<const action::Task> task, std::shared_ptr<action::ActionLibrary> library,
              std::shared_ptr<Predictions> predictions, double bits, double cost_per_bit,
              SecondValue second = SecondValue::greedy, bool nothing_met = false);

  /// Makes the anchored motions for a belief that is the whole prior, of a robot that stands at the scene's start,
  /// ahead of the call that asks for them. Some tenths of a second.
  static void prepare(const action::Task& task, action::ActionLibrary& library);

  /// Weighs the motions of such a call on so many poses, so that the steps of walks that it looks at are there too.
  /// Half a second or so. Returns how many seconds that takes once they are.
  static double rehearse(const std::shared_ptr<const action::Task>& task,
                         const std::shared_ptr<action::ActionLibrary>& library, std::size_t poses);

  /// The belief at the start: all poses. Without an upper bound as the second value, what a bit is worth to the
  /// heuristics of what follows depends on its choices: they are to be asked for first. A walk is laid out as far as
  /// there is time for it.
  BeliefStatePtr start(const robot::JointVector& q, const support::Deadline& deadline = support::Deadline::unlimited());

 private:
  friend class PoseState;
  bool seated(const action::Motion& motion, std::size_t pose) const;
  bool leads_nowhere(const action::Motion& motion) const;
  const std::vector<action::MotionPtr>& anchored(const robot::JointVector& near);
  int dimensions() const;  ///< that are free
  std::size_t weighed_late() const;
  void price_bits(std::vector<Choice>& at_start);
  const support::Cancellation& cancellation() const { return predictions_->cancellation(); }
  action::MotionPtr ending_with_contacts(const action::MotionPtr& motion);
  const std::vector<action::MotionPtr>& near_pokes(const robot::JointVector& q);
  std::unique_ptr<RatePolicy> rate_policy(const robot::JointVector& q);
  double simulated(const std::vector<std::size_t>& group, const geometry::Pose& base_from_tool, bool is_met,
                   std::size_t beam);
  geometry::Box bounds() const;

  std::shared_ptr<const action::Task> task_;
  std::shared_ptr<action::ActionLibrary> library_;
  std::shared_ptr<Predictions> predictions_;
  geometry::Box region_;  ///< of the target at all poses, search frame
  Seats seats_;
  double bits_;
  double least_cost_per_bit_;
  double cost_per_bit_;  ///< of h_inad, from the greedy rate at the start
  SecondValue second_;
  bool nothing_met_;
  std::unique_ptr<RatePolicy> policy_;  ///< once there is a start, if its cost is the second value
  std::unique_ptr<WalkPolicy> walk_;    ///< the same as long as nothing was met; the cheaper of the two counts
  std::optional<std::vector<action::MotionPtr>> anchored_, near_pokes_;  ///< the latter from the start
};

}  // namespace tactus::solver
