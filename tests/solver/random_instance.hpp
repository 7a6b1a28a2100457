// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "solver/instance.hpp"
#include "support/rng.hpp"

/// Instances at random, in which most motions tell much, so that few beliefs can come about.
namespace tactus::test {

struct RandomInstance {
  std::size_t poses = 30;
  std::size_t probes = 25;  ///< beside an insertion at each pose
  std::size_t configurations = 10;
  bool equal_weights = true;
};

using Point = std::array<double, 2>;

inline Point random_point(support::Rng& rng) { return {rng.uniform(), rng.uniform()}; }

inline double distance(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

/// A motion from a point of the unit square: each pose ends it at one of two to `most` configurations.
inline solver::Instance::Results random_results(support::Rng& rng, const RandomInstance& is, std::uint64_t most) {
  std::vector<int> ends(2 + rng.below(most - 1));
  for (int& end : ends) end = static_cast<int>(rng.below(is.configurations));
  solver::Instance::Results results(is.poses);
  for (auto& [to, cost] : results) to = ends[rng.below(ends.size())], cost = rng.uniform(0.005, 0.1);
  return results;
}

/// Adds a motion that can be made from nine of ten configurations, at the cost of the way to `from` on top.
inline void add_motion(solver::Instance& instance, const std::string& name, const solver::Instance::Results& results,
                       const Point& from, const std::vector<Point>& places, support::Rng& rng, double share) {
  instance.motions.push_back(name);
  for (std::size_t i = 0; i < places.size(); ++i) {
    auto& offered = instance.configurations[i].results;
    offered.emplace_back();
    if (rng.uniform() >= share) continue;
    offered.back() = results;
    for (auto& result : offered.back()) result.cost += distance(places[i], from);
  }
}

inline solver::InstancePtr random_instance(support::Rng& rng, const RandomInstance& is = {}) {
  solver::Instance instance;
  instance.name = "random";
  double total = 0.0;
  for (std::size_t pose = 0; pose < is.poses; ++pose) {
    instance.weight.push_back(is.equal_weights ? 1.0 : rng.uniform(0.2, 1.0));
    total += instance.weight.back();
  }
  for (double& weight : instance.weight) weight /= total;
  std::vector<Point> places;
  for (std::size_t i = 0; i < is.configurations; ++i) {
    places.push_back(random_point(rng));
    instance.configurations.push_back({robot::JointVector::Constant(1, static_cast<double>(i)), rng.below(2) == 0, {}});
  }
  for (std::size_t probe = 0; probe < is.probes; ++probe)
    add_motion(instance, "probe" + std::to_string(probe), random_results(rng, is, 8), random_point(rng), places, rng,
               0.9);
  for (std::size_t pose = 0; pose < is.poses; ++pose) {
    auto results = random_results(rng, is, 3);
    results[pose].to = solver::Instance::goal;
    add_motion(instance, "insertion" + std::to_string(pose), results, random_point(rng), places, rng, 1.0);
  }
  return std::make_shared<const solver::Instance>(std::move(instance));
}

}  // namespace tactus::test
