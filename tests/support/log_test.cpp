// SPDX-License-Identifier: BSD-3-Clause
#include "support/log.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace tactus::support {
namespace {

using Lines = std::vector<std::pair<LogLevel, std::string>>;

void keep(LogLevel level, const char* message, void* context) {
  static_cast<Lines*>(context)->emplace_back(level, message);
}

TEST(Log, GoesToTheSinkAndNowhereWithoutOne) {
  Lines lines;
  log(LogLevel::info, "dropped");
  set_log_sink(keep, &lines);
  log(LogLevel::warning, "kept");
  set_log_sink(nullptr, nullptr);
  log(LogLevel::error, "dropped too");
  EXPECT_EQ(lines, (Lines{{LogLevel::warning, "kept"}}));
}

/// A sink that sets another sink, or logs, does not wait for itself.
TEST(Log, ASinkMayChangeTheSink) {
  set_log_sink([](LogLevel, const char*, void*) { set_log_sink(nullptr, nullptr); }, nullptr);
  log(LogLevel::info, "once");
  log(LogLevel::info, "twice");
}

TEST(Log, MayBeWrittenByAnyThread) {
  std::atomic<int> count{0};
  set_log_sink([](LogLevel, const char*, void* context) { ++*static_cast<std::atomic<int>*>(context); }, &count);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([] {
      for (int i = 0; i < 100; ++i) log(LogLevel::debug, "line");
    });
  for (std::thread& thread : threads) thread.join();
  set_log_sink(nullptr, nullptr);
  EXPECT_EQ(count, 400);
}

}  // namespace
}  // namespace tactus::support
