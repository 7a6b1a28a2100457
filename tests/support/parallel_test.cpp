// SPDX-License-Identifier: BSD-3-Clause
#include "support/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace tactus::support {
namespace {

TEST(Parallel, DoesEachThingOnce) {
  for (const int threads : {0, 1, 2, 5})
    for (const std::size_t count : {0u, 1u, 31u, 32u, 33u, 1000u}) {
      std::vector<std::atomic<int>> done(count);
      for_ranges(count, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) ++done[i];
      });
      for (const auto& times : done) EXPECT_EQ(times, 1);
    }
}

TEST(Parallel, ThrowsWhatARangeThrew) {
  for (const int threads : {1, 3})
    EXPECT_THROW(for_ranges(500, threads,
                            [](std::size_t begin, std::size_t end) {
                              if (begin <= 400 && 400 < end) throw std::runtime_error("at 400");
                            }),
                 std::runtime_error);
}

TEST(Parallel, AsManyAsTheMachineHasAreAtLeastOne) {
  EXPECT_GE(thread_count(0), 1u);
  EXPECT_EQ(thread_count(3), 3u);
}

}  // namespace
}  // namespace tactus::support
