// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::support {

/// 128 bits that stand for a set: equal sets have equal hashes, whatever the order in which they were built.
struct Hash128 {
  std::uint64_t low = 0;
  std::uint64_t high = 0;
  bool operator==(const Hash128&) const = default;
};

/// A set of the integers 0 .. size-1, dense, 64 to the word.
class Bitset {
 public:
  Bitset() = default;
  explicit Bitset(std::size_t size, bool value = false);

  std::size_t size() const { return size_; }
  bool test(std::size_t i) const { return (words_[i >> 6] >> (i & 63)) & 1; }
  void set(std::size_t i) { words_[i >> 6] |= std::uint64_t{1} << (i & 63); }
  void reset(std::size_t i) { words_[i >> 6] &= ~(std::uint64_t{1} << (i & 63)); }
  std::size_t count() const;
  bool none() const;

  /// Of the members begin .. end - 1.
  bool any_in(std::size_t begin, std::size_t end) const;
  void reset_in(std::size_t begin, std::size_t end);

  /// Resets `begin + i` for every bit i of `mask`. None may be >= size.
  void reset_bits(std::size_t begin, std::uint64_t mask) {
    words_[begin >> 6] &= ~(mask << (begin & 63));
    if (const std::uint64_t above = mask >> 1 >> (63 - (begin & 63)); above != 0) words_[(begin >> 6) + 1] &= ~above;
  }

  /// The member that has `rank` members before it; there must be more than `rank`. O(words).
  std::size_t member(std::size_t rank) const;

  Bitset& operator&=(const Bitset& other);
  Bitset& operator|=(const Bitset& other);
  Bitset& and_not(const Bitset& other);
  bool operator==(const Bitset&) const = default;

  /// Zobrist hash of the members, salted.
  Hash128 hash(std::uint64_t salt = 0) const;

  /// Calls `visit(i)` for every member, ascending.
  template <typename Visit>
  void for_each(Visit&& visit) const {
    for (std::size_t w = 0; w < words_.size(); ++w)
      for (std::uint64_t rest = words_[w]; rest != 0; rest &= rest - 1)
        visit(w * 64 + static_cast<std::size_t>(std::countr_zero(rest)));
  }

  /// Whether `test(i)` holds for every member; ascending, up to the first for which it does not.
  template <typename Test>
  bool all_of(Test&& test) const {
    for (std::size_t w = 0; w < words_.size(); ++w)
      for (std::uint64_t rest = words_[w]; rest != 0; rest &= rest - 1)
        if (!test(w * 64 + static_cast<std::size_t>(std::countr_zero(rest)))) return false;
    return true;
  }

  const std::vector<std::uint64_t>& words() const { return words_; }
  /// The members among 64 w .. 64 w + 63, the lowest bit first. None may be >= size.
  void set_word(std::size_t w, std::uint64_t members) { words_[w] = members; }

 private:
  std::size_t size_ = 0;
  std::vector<std::uint64_t> words_;
};

}  // namespace tactus::support
