// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "action/action.hpp"
#include "support/bitset.hpp"
#include "support/deadline.hpp"

namespace tactus::solver {

/// The two value functions of the paper's Algorithm 1: one from a heuristic that never overestimates, one from a greedy
/// one.
enum class ValueType { admissible = 0, inadmissible = 1 };
using Values = std::array<double, 2>;  ///< indexed by `ValueType`, in units of cost

/// What the second one begins from: a greedy heuristic that may be too high or too low (h_inad), or what a simple
/// policy costs, which the value is never above.
enum class SecondValue { greedy, upper_bound };

/// What may come of a motion: first contact at a waypoint, or none (`waypoint` is then the path's size).
struct Outcome {
  std::size_t waypoint = 0;
  std::size_t last = 0;  ///< the same, or a later one: first contact at a waypoint up to this one
  double probability = 0.0;
  double cost = 0.0;      ///< of the motion up to there, the way to its start and back to the last free waypoint
  bool goal = false;      ///< the successor needs nothing more; on voxels an estimate: it is expected to be handed over
  Values heuristic{};     ///< of the successor; 0 at the goal
  double possible = 0.0;  ///< share of the belief that is left then; 0: the probability, as where outcomes are certain
};

/// A motion weighed at a belief. The outcomes' probabilities sum to one.
struct Choice {
  action::MotionPtr motion;
  std::vector<Outcome> outcomes;
  double expected_cost() const;   ///< C(b, a)
  double expected_total() const;  ///< Q(b, a) by the successors' second values
  double contact_probability() const;
  double goal_probability() const;
  double information() const;  ///< expected bits by which the belief gets smaller
};

/// The same, were its motion to cost so much `more`, whatever comes of it.
Choice charged(Choice choice, double more);

/// What a bit is worth to h_inad: a half more than what the motion with the best rate of expected bits to expected cost
/// pays for one, so that motion is worth making; at least `least`.
double greedy_cost_per_bit(const std::vector<double>& expected_cost, const std::vector<double>& expected_bits,
                           double least);

/// Makes a bit worth so much to the greedy heuristics of outcomes that were weighed as if it were worth one unit of
/// cost.
void price_bits(std::vector<Choice>& choices, double cost_per_bit);

/// A belief as the solver sees it, whichever representation is behind it. Immutable, but for what is computed on first
/// use.
class BeliefState {
 public:
  virtual ~BeliefState() = default;

  virtual support::Hash128 hash() const = 0;  ///< equal for equal beliefs
  virtual const robot::JointVector& configuration() const = 0;
  virtual Values heuristic() const = 0;
  virtual std::size_t support_size() const = 0;  ///< poses or voxels that the belief rests on

  /// Every motion worth considering with what may come of it: the expensive part of an expansion. Some of them, at
  /// least the first, if the deadline is spent before all are weighed. Where planning starts, all, or some of every
  /// kind at least, unless it is cancelled: the best of a few that are alike may be far from any good.
  virtual std::vector<Choice> choices(const support::Deadline& deadline) const = 0;

  /// A choice as its motion turned out, with the way to where that begins: it costs so much `more`, and where the
  /// belief can tell, by the deadline or a little later, something may be met on the way too.
  virtual Choice realised(const Choice& choice, const action::Action& made, double more,
                          const support::Deadline& deadline) const;

  /// The belief after an outcome that is not the goal.
  virtual std::shared_ptr<const BeliefState> successor(const Choice& choice, const Outcome& outcome) const = 0;
};

using BeliefStatePtr = std::shared_ptr<const BeliefState>;

}  // namespace tactus::solver
