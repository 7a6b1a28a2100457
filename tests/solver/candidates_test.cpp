// SPDX-License-Identifier: BSD-3-Clause
#include "solver/candidates.hpp"

#include <gtest/gtest.h>

#include <set>

#include "solver/toy.hpp"

/// In which order motions are tried: laws on random problems, beside the plain rule.
namespace tactus::test {
namespace {

using solver::Candidates;
using solver::Search;
using solver::Verdict;
using support::Deadline;
using support::Rng;

using Choices = std::set<std::size_t>;

Search expanded(Rng& rng) {
  Search search(std::make_shared<ToyState>(std::make_shared<Toy>(random_toy(rng, 12, 3)), 0), {});
  Deadline deadline = Deadline::unlimited();
  search.expand_start(deadline);
  return search;
}

std::optional<std::size_t> cheapest(const Search& search, const Choices& of) {
  std::optional<std::size_t> best;
  for (const std::size_t choice : of)
    if (!best || search.q_value(0, choice, search.executed_by()) < search.q_value(0, *best, search.executed_by()))
      best = choice;
  return best;
}

TEST(Candidates, AreTheCheapestOfThoseLeftAndWhatIsHeldBackComesLast) {
  Rng rng(1);
  int held_ones_tried = 0;
  for (int round = 0; round < 200; ++round) {
    const Search search = expanded(rng);
    Choices open, held;
    for (std::size_t i = 0; i < search.choices(0).size(); ++i) (rng.uniform() < 0.4 ? held : open).insert(i);
    Candidates candidates(search, 0, std::nullopt, 0.0, {held.begin(), held.end()});
    while (!open.empty() || !held.empty()) {
      Choices& now = open.empty() ? held : open;
      const auto expected = cheapest(search, now);
      ASSERT_EQ(candidates.next(), expected);
      ASSERT_EQ(candidates.next(), expected) << "asked again";
      held_ones_tried += open.empty();
      now.erase(*expected);
      candidates.rule_out(*expected, Verdict::unreachable);
    }
    ASSERT_FALSE(candidates.next());
  }
  EXPECT_GT(held_ones_tried, 100);
}

TEST(Candidates, SayWhatBecameOfEach) {
  Rng rng(2);
  for (int round = 0; round < 200; ++round) {
    const Search search = expanded(rng);
    const std::size_t count = search.choices(0).size();
    const std::size_t held = rng.below(count);
    Candidates candidates(search, 0, std::nullopt, 0.0, {held});
    const auto unreachable = candidates.next();
    ASSERT_TRUE(unreachable);
    candidates.rule_out(*unreachable, Verdict::unreachable);
    const auto chosen = candidates.next();
    ASSERT_TRUE(chosen);
    const std::vector<Verdict> verdicts = candidates.verdicts(*chosen);
    for (std::size_t i = 0; i < count; ++i) {
      const Verdict expected = i == *chosen                   ? Verdict::chosen
                               : i == *unreachable            ? Verdict::unreachable
                               : i == held && *chosen != held ? Verdict::set_aside
                                                              : Verdict::passed_over;
      ASSERT_EQ(verdicts[i], expected);
    }
  }
}

/// Those that tell too little for their cost beside the best are passed by, and said to be set aside.
TEST(Candidates, TellEnoughIfTheyMust) {
  constexpr double telling = 0.6;
  Rng rng(3);
  int fell_short = 0;
  for (int round = 0; round < 200; ++round) {
    const Search search = expanded(rng);
    Candidates candidates(search, 0, std::nullopt, telling, {});
    const std::vector<bool> falls_short = solver::falling_short(search.choices(0), telling);
    const auto chosen = candidates.next();
    ASSERT_TRUE(chosen);
    ASSERT_FALSE(falls_short[*chosen]);
    const std::vector<Verdict> verdicts = candidates.verdicts(*chosen);
    for (std::size_t i = 0; i < verdicts.size(); ++i)
      if (falls_short[i]) {
        ASSERT_EQ(verdicts[i], Verdict::set_aside);
        ++fell_short;
      }
  }
  EXPECT_GT(fell_short, 100);
}

}  // namespace
}  // namespace tactus::test
