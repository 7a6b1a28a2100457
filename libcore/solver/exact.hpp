// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <unordered_map>

#include "solver/instance.hpp"

namespace tactus::solver {

/// Solves an instance exactly, belief by belief as they are asked for: depth first, motions by their lower bounds,
/// leaving out those that can't be the best. A motion parts the set of poses or only moves the robot, so the beliefs of
/// one set are solved together, after those of its parts. Bounds are exact values of pairs of poses: V* is concave, and
/// a belief is a mixture of its pairs. One thread.
class ExactSolver {
 public:
  ExactSolver(InstancePtr instance, double discount, std::size_t most_beliefs = 200'000);

  /// V* of a configuration and a set of poses: the expected discounted cost of the best policy. None if more beliefs
  /// would have to be solved than allowed; then there is no answer to anything else either.
  std::optional<double> value(std::size_t place, const support::Bitset& poses);

  /// The mean of the values of pairs, at most V*; none as above.
  std::optional<double> lower_bound(std::size_t place, const support::Bitset& poses);

  /// The expected cost if the pose were known, at most `lower_bound`.
  double informed(std::size_t place, const support::Bitset& poses) const;

  std::size_t beliefs() const { return beliefs_; }  ///< solved, those of single poses not counted

 private:
  struct TooMany {};
  using Layer = std::vector<double>;  ///< V* by configuration of one set of poses; NaN where not asked for yet
  /// A motion that takes the robot elsewhere and tells nothing.
  struct Move {
    std::size_t from, to;
    double cost;
  };
  struct Child {
    std::size_t place;
    const support::Bitset* poses;
    double weight;  ///< discounted probability
    double bound;
  };
  struct Weighed {
    double bound;  ///< of Q, from below
    std::vector<Child> children;
    std::map<int, support::Bitset> outcomes;
  };
  struct HashOf {
    std::size_t operator()(const support::Hash128& h) const { return h.low; }
  };

  template <typename Solve>
  std::optional<double> within_limit(Solve&& solve);
  double solved(std::size_t place, const support::Bitset& poses);
  void solve(Layer& layer, std::size_t place, const support::Bitset& poses);
  std::vector<Move> moves_from(std::size_t place, const support::Bitset& poses) const;
  double best_split(std::size_t place, const support::Bitset& poses);
  Weighed weigh(const Instance::Results& results, std::map<int, support::Bitset> outcomes,
                const support::Bitset& poses);
  double informed_cost(const Instance::Results& results, const support::Bitset& poses) const;
  double expected_cost(const Instance::Results& results, const support::Bitset& poses) const;
  double bound(std::size_t place, const support::Bitset& poses);
  double quick_bound(std::size_t place, const support::Bitset& poses);
  double pair_value(std::size_t place, std::size_t a, std::size_t b);

  InstancePtr instance_;
  double discount_;
  std::size_t most_beliefs_, beliefs_ = 0;
  std::vector<std::vector<double>> informed_;
  std::vector<Layer> pairs_;  ///< by pose, by lesser pose
  std::unordered_map<support::Hash128, Layer, HashOf> layers_;
};

}  // namespace tactus::solver
