// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <functional>

#include "solver/problem.hpp"
#include "support/rng.hpp"

/// A finite problem, random and small enough to be solved plainly, as a belief that the search can be asked about.
namespace tactus::test {

using solver::Values;
using solver::ValueType;

struct Toy {
  static constexpr int goal = -1;
  struct Arrow {
    double probability = 0.0;
    double cost = 0.0;
    int to = goal;
  };
  using Move = std::vector<Arrow>;

  std::vector<std::vector<Move>> moves;  ///< by state
  std::vector<Values> heuristic;         ///< by state
  mutable std::size_t expansions = 0;    ///< how often a state was asked for its choices
  std::function<void()> when_asked;      ///< for them
};

inline double ahead(const Toy::Arrow& arrow, const std::vector<double>& value) {
  return arrow.to == Toy::goal ? 0.0 : value[static_cast<std::size_t>(arrow.to)];
}

/// The first of the likeliest outcomes: the one that trials follow.
inline std::size_t likeliest(const Toy::Move& move) {
  std::size_t best = 0;
  for (std::size_t z = 1; z < move.size(); ++z)
    if (move[z].probability > move[best].probability) best = z;
  return best;
}

/// Value iteration until nothing changes. `off_trial`: what the outcomes that no trial follows are taken to be worth;
/// none: their own value, the true optimum.
inline std::vector<double> optimum(const Toy& toy, const std::vector<double>* off_trial = nullptr) {
  std::vector<double> value(toy.moves.size(), 0.0);
  for (double change = 1.0; change > 1e-13;) {
    change = 0.0;
    for (std::size_t s = 0; s < toy.moves.size(); ++s) {
      double lowest = 1e300;
      for (const Toy::Move& move : toy.moves[s]) {
        double q = 0.0;
        for (std::size_t z = 0; z < move.size(); ++z)
          q += move[z].probability *
               (move[z].cost + ahead(move[z], off_trial && z != likeliest(move) ? *off_trial : value));
        lowest = std::min(lowest, q);
      }
      change = std::max(change, std::abs(lowest - value[s]));
      value[s] = lowest;
    }
  }
  return value;
}

/// `states` states with two to four moves of up to `outcomes` outcomes, most of them to states a little further on; the
/// last ones lead to the goal. Heuristics are 0.
inline Toy random_toy(support::Rng& rng, int states, std::size_t outcomes) {
  Toy toy;
  for (int s = 0; s < states; ++s) {
    toy.moves.emplace_back(2 + rng.below(3));
    for (Toy::Move& move : toy.moves.back()) {
      double total = 0.0;
      for (std::uint64_t z = 1 + rng.below(outcomes); z > 0; --z) {
        const int to = s - 3 + static_cast<int>(rng.below(16));
        move.push_back({rng.uniform(0.1, 1.0), rng.uniform(0.1, 1.0), to >= states ? Toy::goal : std::max(0, to)});
        total += move.back().probability;
      }
      for (Toy::Arrow& arrow : move) arrow.probability /= total;
    }
    toy.moves.back().front().back().to = s + 5 < states ? s + 5 : Toy::goal;
  }
  toy.heuristic.assign(toy.moves.size(), Values{});
  return toy;
}

/// A state of a toy; an outcome's waypoint counts the arrows out of the state.
class ToyState : public solver::BeliefState {
 public:
  ToyState(std::shared_ptr<const Toy> toy, int state)
      : toy_(std::move(toy)), state_(state), q_(robot::JointVector::Constant(1, state)) {}

  support::Hash128 hash() const override { return {support::mix(static_cast<std::uint64_t>(state_)), 7}; }
  const robot::JointVector& configuration() const override { return q_; }
  Values heuristic() const override { return toy_->heuristic[static_cast<std::size_t>(state_)]; }
  std::size_t support_size() const override { return 1; }

  std::vector<solver::Choice> choices(const support::Deadline& deadline) const override {
    ++toy_->expansions;
    if (toy_->when_asked) toy_->when_asked();
    std::vector<solver::Choice> result;
    std::size_t count = 0;
    for (const Toy::Move& move : moves()) {
      if (!result.empty() && deadline.spent()) break;
      result.emplace_back();
      for (const auto& [probability, cost, to] : move) {
        const bool done = to == Toy::goal;
        result.back().outcomes.push_back(
            {count, count, probability, cost, done, done ? Values{} : toy_->heuristic[static_cast<std::size_t>(to)]});
        ++count;
      }
    }
    return result;
  }

  solver::BeliefStatePtr successor(const solver::Choice&, const solver::Outcome& outcome) const override {
    std::size_t left = outcome.waypoint;
    for (const Toy::Move& move : moves()) {
      if (left < move.size()) return std::make_shared<ToyState>(toy_, move[left].to);
      left -= move.size();
    }
    return nullptr;
  }

 private:
  const std::vector<Toy::Move>& moves() const { return toy_->moves[static_cast<std::size_t>(state_)]; }

  std::shared_ptr<const Toy> toy_;
  int state_;
  robot::JointVector q_;
};

}  // namespace tactus::test
