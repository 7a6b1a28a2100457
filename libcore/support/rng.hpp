// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace tactus::support {

/// A random number generator (xoshiro256++) whose sequence is the same on every machine and compiler. Not thread-safe:
/// give each thread its own, by `fork`.
class Rng {
 public:
  explicit Rng(std::uint64_t seed);

  std::uint64_t next();                      ///< 64 random bits
  double uniform();                          ///< in [0, 1)
  double uniform(double low, double high);   ///< in [low, high)
  std::uint64_t below(std::uint64_t limit);  ///< in {0 .. limit-1}; `limit` > 0
  double normal();                           ///< standard normal
  Rng fork();                                ///< an independent generator; advances this one

  const std::array<std::uint64_t, 4>& state() const { return state_; }
  void restore(const std::array<std::uint64_t, 4>& state) { state_ = state; }

 private:
  std::array<std::uint64_t, 4> state_;
};

/// A well-mixed 64-bit hash of one word (splitmix64's finaliser).
std::uint64_t mix(std::uint64_t word);

}  // namespace tactus::support
