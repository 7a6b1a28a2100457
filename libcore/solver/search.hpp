// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <unordered_map>

#include "solver/problem.hpp"
#include "support/deadline.hpp"

namespace tactus::solver {

struct SearchOptions {
  double epsilon = 0.5;  ///< share of the budget in which trials follow the admissible values; 0: RTDP-Inad, 1: RTDP-Ad
  int horizon = 8;       ///< motions a trial goes deep
  /// The second value is an upper bound: both only get closer, trials go where they are farthest apart (bounded RTDP),
  /// and the search ends when they are within `gap` of the lower one at the start.
  bool bounded = false;
  double gap = 0.01;
};

/// The paper's Algorithm 1, Modified RTDP-Bel: trials from the start that update both values of every belief they pass,
/// choose the motion by one of them and follow the most likely outcome. What has been computed by the deadline is a
/// partial policy. Bounded (BRTDP on beliefs), L <= V* <= U at every belief, where the first values are below V* and
/// the second ones above; the outcome followed is that with the largest P (U - L), and a trial's beliefs are updated
/// again on the way back. One thread.
class Search {
 public:
  Search(BeliefStatePtr start, const SearchOptions& options);

  /// Trials until the deadline is spent, nothing changes any more, or a thousand trials met no belief that was new, or
  /// until what the beliefs do is out of time. May be called again to go on.
  void run(support::Deadline& deadline);

  /// Only what can be done from the start, for one-step rules.
  void expand_start(support::Deadline& deadline) { expand(start, deadline); }

  static constexpr int start = 0;

  /// The values by which the best motion is found: the inadmissible ones, unless those were never followed.
  ValueType executed_by() const { return options_.epsilon >= 1.0 ? ValueType::admissible : ValueType::inadmissible; }

  /// The best motion at an expanded belief, leaving out the banned ones; none if no motion is left. A choice's index.
  std::optional<std::size_t> best(int node, const std::vector<bool>& banned = {}) const;

  /// Puts a motion at a belief as it turned out in the place of what was thought of it. What is known of the beliefs
  /// that follow is kept unless it is another motion; else the outcomes must be the same.
  void reweigh(int node, std::size_t choice, Choice weighed);

  bool expanded(int node) const { return nodes_[node].expanded; }
  const BeliefState& state(int node) const { return *nodes_[node].state; }
  const std::vector<Choice>& choices(int node) const { return nodes_[node].choices; }
  double value(int node, ValueType type) const { return nodes_[node].value[static_cast<int>(type)]; }
  double q_value(int node, std::size_t choice, ValueType type) const;
  /// The belief that follows; -1 if it is the goal or no trial has been there.
  int child(int node, std::size_t choice, std::size_t outcome) const { return nodes_[node].children[choice][outcome]; }
  std::size_t size() const { return nodes_.size(); }

 private:
  struct Node {
    BeliefStatePtr state;
    bool expanded = false;
    Values value{};
    std::vector<Choice> choices;
    std::vector<std::vector<int>> children;
  };
  struct HashOf {
    std::size_t operator()(const support::Hash128& h) const { return h.low; }
  };

  void trials(support::Deadline& deadline);
  bool trial(support::Deadline& deadline, ValueType guide);
  bool converged() const;
  std::optional<std::size_t> outcome_to_follow(int node, std::size_t choice) const;
  double ahead(int node, std::size_t choice, std::size_t outcome, ValueType type) const;
  bool expand(int node, support::Deadline& deadline);
  bool update(int node);
  std::optional<std::size_t> best_by(int node, ValueType type, const std::vector<bool>& banned = {}) const;
  int follow(int node, std::size_t choice, std::size_t outcome);
  int intern(BeliefStatePtr state);

  SearchOptions options_;
  std::vector<Node> nodes_;
  std::unordered_map<support::Hash128, int, HashOf> index_;
};

}  // namespace tactus::solver
