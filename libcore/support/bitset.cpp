// SPDX-License-Identifier: BSD-3-Clause
#include "support/bitset.hpp"

#include "support/rng.hpp"

namespace tactus::support {
namespace {

/// Calls `visit(word, mask)` for every word that has some of begin .. end - 1, with a bit for each of them in it.
template <typename Visit>
void for_each_word(std::size_t begin, std::size_t end, Visit&& visit) {
  for (std::size_t w = begin >> 6; (w << 6) < end; ++w) {
    std::uint64_t mask = ~std::uint64_t{0};
    if (begin > w << 6) mask &= mask << (begin & 63);
    if (end < (w + 1) << 6) mask &= ~std::uint64_t{0} >> (64 - (end & 63));
    visit(w, mask);
  }
}

}  // namespace

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

bool Bitset::any_in(std::size_t begin, std::size_t end) const {
  std::uint64_t found = 0;
  for_each_word(begin, end, [&](std::size_t w, std::uint64_t mask) { found |= words_[w] & mask; });
  return found != 0;
}

void Bitset::reset_in(std::size_t begin, std::size_t end) {
  for_each_word(begin, end, [&](std::size_t w, std::uint64_t mask) { words_[w] &= ~mask; });
}

std::size_t Bitset::member(std::size_t rank) const {
  std::size_t w = 0;
  for (auto here = static_cast<std::size_t>(std::popcount(words_[w])); rank >= here;
       here = static_cast<std::size_t>(std::popcount(words_[++w])))
    rank -= here;
  std::uint64_t rest = words_[w];
  while (rank-- > 0) rest &= rest - 1;
  return 64 * w + static_cast<std::size_t>(std::countr_zero(rest));
}

Bitset& Bitset::operator&=(const Bitset& other) {
  for (std::size_t w = 0; w < words_.size(); ++w) words_[w] &= other.words_[w];
  return *this;
}

Bitset& Bitset::operator|=(const Bitset& other) {
  for (std::size_t w = 0; w < words_.size(); ++w) words_[w] |= other.words_[w];
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
