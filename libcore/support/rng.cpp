// SPDX-License-Identifier: BSD-3-Clause
#include "support/rng.hpp"

#include <bit>
#include <cmath>
#include <numbers>

namespace tactus::support {

std::uint64_t mix(std::uint64_t word) {
  word += 0x9e3779b97f4a7c15ULL;
  word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9ULL;
  word = (word ^ (word >> 27)) * 0x94d049bb133111ebULL;
  return word ^ (word >> 31);
}

Rng::Rng(std::uint64_t seed) {
  for (std::uint64_t& word : state_) word = seed = mix(seed);
}

std::uint64_t Rng::next() {
  const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
  const std::uint64_t shifted = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= shifted;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

double Rng::uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

double Rng::uniform(double low, double high) { return low + (high - low) * uniform(); }

std::uint64_t Rng::below(std::uint64_t limit) {
  const std::uint64_t reject_from = UINT64_MAX - UINT64_MAX % limit;
  std::uint64_t word = next();
  while (word >= reject_from) word = next();
  return word % limit;
}

double Rng::normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

Rng Rng::fork() { return Rng(next()); }

}  // namespace tactus::support
