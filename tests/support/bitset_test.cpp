// SPDX-License-Identifier: BSD-3-Clause
#include "support/bitset.hpp"

#include <gtest/gtest.h>

#include <set>

#include "support/rng.hpp"

namespace tactus::support {
namespace {

Bitset bits(std::size_t size, const std::set<std::size_t>& members) {
  Bitset set(size);
  for (const std::size_t member : members) set.set(member);
  return set;
}

std::set<std::size_t> random_members(std::size_t size, Rng& rng) {
  std::set<std::size_t> members;
  for (std::uint64_t k = rng.below(2 * size); k > 0; --k) members.insert(rng.below(size));
  return members;
}

TEST(Bitset, AgreesWithASet) {
  Rng rng(1);
  for (const std::size_t size : {1u, 63u, 64u, 65u, 128u, 200u})
    for (int i = 0; i < 50; ++i) {
      const std::set<std::size_t> a = random_members(size, rng), b = random_members(size, rng);
      std::set<std::size_t> both, only_a, visited;
      for (const std::size_t member : a) (b.count(member) ? both : only_a).insert(member);
      Bitset x = bits(size, a), y = x;
      EXPECT_EQ(x.count(), a.size());
      EXPECT_EQ(x.none(), a.empty());
      x.for_each([&](std::size_t member) { visited.insert(visited.end(), member); });
      EXPECT_EQ(visited, a);
      EXPECT_EQ(x &= bits(size, b), bits(size, both));
      EXPECT_EQ(y.and_not(bits(size, b)), bits(size, only_a));
    }
}

TEST(Bitset, RangesAndRanksAgreeWithASet) {
  Rng rng(2);
  for (const std::size_t size : {1u, 64u, 65u, 200u, 1000u})
    for (int i = 0; i < 100; ++i) {
      std::set<std::size_t> members = random_members(size, rng);
      Bitset set = bits(size, members);
      std::size_t rank = 0;
      for (const std::size_t member : members) EXPECT_EQ(set.member(rank++), member);
      const std::size_t limit = rng.below(size + 1);
      EXPECT_EQ(set.all_of([&](std::size_t member) { return member < limit; }),
                members.empty() || *members.rbegin() < limit);
      const std::size_t begin = rng.below(size + 1), end = begin + rng.below(size + 1 - begin);
      const auto low = members.lower_bound(begin), high = members.lower_bound(end);
      EXPECT_EQ(set.any_in(begin, end), low != high);
      members.erase(low, high);
      set.reset_in(begin, end);
      EXPECT_EQ(set, bits(size, members));
    }
}

TEST(Bitset, FullOnesHaveNoMembersBeyondTheirSize) {
  for (const std::size_t size : {0u, 1u, 63u, 64u, 65u, 130u}) {
    Bitset full(size, true);
    EXPECT_EQ(full.count(), size);
    for (std::size_t i = 0; i < size; ++i) full.reset(i);
    EXPECT_TRUE(full.none());
  }
}

TEST(Bitset, EqualSetsHaveEqualHashesHoweverTheyWereBuilt) {
  Bitset up(300), down(300);
  for (std::size_t i = 0; i < 300; i += 3) up.set(i);
  for (std::size_t i = 300; i-- > 0;) down.set(i);
  for (std::size_t i = 300; i-- > 0;)
    if (i % 3 != 0) down.reset(i);
  EXPECT_EQ(up.hash(), down.hash());
  EXPECT_EQ(up.hash(5), down.hash(5));
}

TEST(Bitset, DifferentSetsAndSaltsHaveDifferentHashes) {
  Rng rng(2);
  std::set<std::pair<std::uint64_t, std::uint64_t>> hashes;
  std::set<std::set<std::size_t>> sets;
  for (int i = 0; i < 2000; ++i) {
    const std::set<std::size_t> members = random_members(20, rng);
    if (!sets.insert(members).second) continue;
    for (const std::uint64_t salt : {0u, 1u}) {
      const Hash128 hash = bits(20, members).hash(salt);
      EXPECT_TRUE(hashes.emplace(hash.low, hash.high).second);
    }
  }
  EXPECT_GT(sets.size(), 1000u);
}

}  // namespace
}  // namespace tactus::support
