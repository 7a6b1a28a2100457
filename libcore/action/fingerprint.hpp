// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <string>

#include "scene/scene.hpp"
#include "support/rng.hpp"

namespace tactus::action {

/// A running hash of what something saved makes sense with only.
class Fingerprint {
 public:
  void add(std::uint64_t word) { sum_ = support::mix(sum_ ^ word); }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value + 0.0)); }  // + 0.0: no minus zero
  void add(const std::string& text);
  void add_rounded(double value);        ///< to a millionth: it may come from sines
  void add(const geometry::Pose& pose);  ///< so
  void add(const geometry::Mesh& mesh);
  void add(const scene::Prior& prior);

  /// The target, its seats and tolerances, the tool, the robot's joints and the world around it. What comes from sines,
  /// which need not be the same to the last bit on every machine, is rounded; the robot's frames are left out.
  void add(const scene::Scene& scene);

  std::uint64_t sum() const { return sum_; }

 private:
  std::uint64_t sum_ = 0;
};

}  // namespace tactus::action
