// SPDX-License-Identifier: BSD-3-Clause
#include "support/bitset.hpp"

#include "support/rng.hpp"

namespace tactus::support {

Bitset::Bitset(std::size_t size, bool value) : size_(size), words_((size + 63) / 64, value ? ~std::uint64_t{0} : 0) {
  if (value && size % 64 != 0) words_.back() = (std::uint64_t{1} << (size % 64)) - 1;
}

std::size_t Bitset::count() const {
  std::size_t total = 0;
  for (const std::uint64_t word : words_) total += static_cast<std::size_t>(std::popcount(word));
  return total;
}

bool Bitset::none() const {
  for (const std::uint64_t word : words_)
    if (word != 0) return false;
  return true;
}

Bitset& Bitset::operator&=(const Bitset& other) {
  for (std::size_t w = 0; w < words_.size(); ++w) words_[w] &= other.words_[w];
  return *this;
}

Bitset& Bitset::and_not(const Bitset& other) {
  for (std::size_t w = 0; w < words_.size(); ++w) words_[w] &= ~other.words_[w];
  return *this;
}

Hash128 Bitset::hash(std::uint64_t salt) const {
  Hash128 sum{mix(salt), mix(~salt)};
  for_each([&](std::size_t i) {
    sum.low ^= mix(2 * i + 1);
    sum.high ^= mix(~(2 * i));
  });
  return sum;
}

}  // namespace tactus::support
