// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <optional>

#include "action/library.hpp"
#include "belief/belief.hpp"
#include "solver/alternatives.hpp"
#include "solver/predictions.hpp"
#include "solver/progress.hpp"
#include "solver/solvers.hpp"

namespace tactus::solver {

/// What the last query took. Counted since the planner was created where it says "total".
struct PlannerStatistics {
  bool from_policy = false;  ///< the action was computed by an earlier call
  std::uint64_t expansions = 0;
  double seconds = 0.0;
  double lower_bound = 0.0;       ///< admissible value at the belief
  double value = 0.0;             ///< inadmissible value at the belief
  std::uint64_t total_calls = 0;  ///< that planned
  std::uint64_t total_expansions = 0;
  double total_seconds = 0.0;
};

/// What a query found: an action, or why there is none.
struct Answer {
  enum class Kind { action, goal_reached, no_informative_action, cancelled } kind = Kind::action;
  action::ActionPtr action;
};

/// Plans on whatever phase a belief is in, within a budget, and follows the partial policy it computed while the
/// observations are the predicted ones. One thread at a time; `cancel` from any.
class Planner {
 public:
  /// Throws `invalid_argument` for options out of range. With bounds it makes motions for the first query, and
  /// rehearses it where the budget is in seconds: one to two seconds.
  Planner(std::shared_ptr<const belief::Model> model, const PlannerOptions& options);
  ~Planner();

  Answer query(const belief::Belief& belief);

  /// The query that is running returns `cancelled` within some milliseconds, unless it has its answer. Without one, the
  /// next query is not affected.
  void cancel() { cancelled_.store(true, std::memory_order_relaxed); }

  const PlannerStatistics& statistics() const { return statistics_; }

  /// What was weighed against the action that the last query handed out, the best first, by what the solver executes.
  /// Empty if there was none. Worked out when first asked for; good until the next query.
  const std::vector<Alternative>& alternatives() const;

 private:
  struct Policy;
  std::optional<int> followed(const belief::Belief& belief);
  Answer act(const belief::Belief& belief, int node, const support::Deadline& deadline);
  Answer hand_out(const belief::Belief& belief, int node, std::size_t choice, action::Action made);
  /// A motion made executable, weighed as it turned out, and what it costs more than was thought.
  struct Realised {
    action::Action action;
    Choice choice;
    double more = 0.0;
  };
  std::optional<HandedOut> handed_out() const;
  motion::JointPath way_off(const belief::Belief& belief, const motion::JointPath& way_back, int halts) const;
  std::optional<Realised> realised(const belief::Belief& belief, const BeliefState& state, const Choice& choice,
                                   const motion::JointPath& way_back, const support::Deadline& deadline) const;
  void predict(const belief::Belief& belief);
  bool is_bounded() const { return second_value_of(options_.solver) == SecondValue::upper_bound; }
  std::vector<belief::Drawn> draw(const belief::Belief& belief, const support::Deadline& deadline);
  void fit_sample(double& times, double least, double most, double used) const;
  BeliefStatePtr on_voxels(const belief::Belief& belief, const support::Deadline& deadline);
  BeliefStatePtr on_poses(const belief::Belief& belief, const support::Deadline& deadline);
  void plan(const belief::Belief& belief, support::Deadline& deadline);
  template <typename Work>
  Answer unless_cancelled(Work&& work);

  std::shared_ptr<const belief::Model> model_;
  PlannerOptions options_;
  std::shared_ptr<action::ActionLibrary> library_;
  support::Rng rng_;
  Progress progress_;
  double sample_;                             ///< times as many poses as long as nothing was met
  double sample_after_ = 1.0;                 ///< and from then on
  std::vector<belief::Drawn> poses_;          ///< of the last planning call, of the same history
  std::shared_ptr<Predictions> predictions_;  ///< of them
  std::unique_ptr<Policy> policy_;
  mutable std::vector<Alternative> alternatives_;  ///< once asked for
  std::atomic<bool> cancelled_{false};
  PlannerStatistics statistics_;
};

}  // namespace tactus::solver
