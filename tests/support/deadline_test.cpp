// SPDX-License-Identifier: BSD-3-Clause
#include "support/deadline.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace tactus::support {
namespace {

constexpr double for_ever = std::numeric_limits<double>::infinity();

TEST(Deadline, WithoutLimitsIsNeverSpent) {
  Deadline deadline = Deadline::unlimited();
  for (int i = 0; i < 1000; ++i) deadline.count_expansion();
  EXPECT_FALSE(deadline.spent());
  EXPECT_EQ(deadline.used_fraction(), 0.0);
  EXPECT_EQ(deadline.expansions(), 1000u);
}

TEST(Deadline, CountsExpansions) {
  Deadline deadline(for_ever, 4);
  for (int i = 0; i < 4; ++i) {
    EXPECT_FALSE(deadline.spent());
    EXPECT_DOUBLE_EQ(deadline.used_fraction(), i / 4.0);
    deadline.count_expansion();
  }
  EXPECT_TRUE(deadline.spent());
  deadline.count_expansion();
  EXPECT_EQ(deadline.used_fraction(), 1.0);
}

TEST(Deadline, CountsSeconds) {
  const Deadline deadline(0.02, UINT64_MAX);
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_TRUE(deadline.spent());
  EXPECT_GE(deadline.elapsed_seconds(), 0.03);
  EXPECT_EQ(deadline.used_fraction(), 1.0);
  EXPECT_FALSE(Deadline(1000.0, UINT64_MAX).spent());
}

TEST(Deadline, OfNothingIsSpentAtOnce) {
  EXPECT_TRUE(Deadline(for_ever, 0).spent());
  EXPECT_TRUE(Deadline(0.0, UINT64_MAX).spent());
}

TEST(Deadline, EndsWhenSomebodyCancels) {
  std::atomic<bool> cancelled{false};
  const Deadline deadline(for_ever, UINT64_MAX, &cancelled);
  EXPECT_FALSE(deadline.spent());
  std::thread([&] { cancelled = true; }).join();
  EXPECT_TRUE(deadline.cancelled());
  EXPECT_TRUE(deadline.spent());
}

/// A budget of nothing is used up, not a number that is none.
TEST(Deadline, TheFractionIsOneOnceSomebodyCancels) {
  std::atomic<bool> cancelled{false};
  const Deadline deadline(1e9, 100, &cancelled);
  EXPECT_LT(deadline.used_fraction(), 1e-3);
  cancelled = true;
  EXPECT_EQ(deadline.used_fraction(), 1.0);
}

TEST(Deadline, TheFractionOfAnEmptyBudgetIsOne) {
  EXPECT_EQ(Deadline(for_ever, 0).used_fraction(), 1.0);
  EXPECT_EQ(Deadline(0.0, UINT64_MAX).used_fraction(), 1.0);
}

TEST(Deadline, SaysWhenAShareOfItIsUsed) {
  const auto now = Deadline::Clock::now();
  const Deadline deadline(100.0, UINT64_MAX);
  const std::chrono::duration<double> until = deadline.at(1.05) - now;
  EXPECT_GE(until.count(), 105.0 - 1e-6);
  EXPECT_LT(until.count(), 105.0 + 100.0 * deadline.used_fraction() + 1e-3);
  EXPECT_EQ(Deadline::unlimited().at(0.5), Deadline::Clock::time_point::max());
}

TEST(TimeLimit, EndsWhatAsksUntilItIsLifted) {
  std::atomic<bool> cancelled{false};
  TimeLimit limit;
  const Cancellation of_both(Cancellation(&cancelled), &limit);
  EXPECT_NO_THROW(of_both.check());
  limit.set(TimeLimit::Clock::time_point::max());
  EXPECT_NO_THROW(of_both.check());
  limit.set(TimeLimit::Clock::now());
  EXPECT_THROW(of_both.check(), OutOfTime);
  EXPECT_FALSE(of_both.requested()) << "by nobody";
  cancelled = true;
  EXPECT_THROW(of_both.check(), Cancelled);
  cancelled = false;
  limit.lift();
  EXPECT_NO_THROW(of_both.check());
}

}  // namespace
}  // namespace tactus::support
