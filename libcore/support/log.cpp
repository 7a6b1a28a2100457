// SPDX-License-Identifier: BSD-3-Clause
#include "support/log.hpp"

#include <mutex>

namespace tactus::support {
namespace {

struct Target {
  LogSink sink = nullptr;
  void* context = nullptr;
};

std::mutex mutex;
Target target;

}  // namespace

void set_log_sink(LogSink sink, void* context) {
  const std::lock_guard lock(mutex);
  target = {sink, context};
}

void log(LogLevel level, const std::string& message) {
  Target current;
  {
    const std::lock_guard lock(mutex);
    current = target;
  }
  if (current.sink != nullptr) current.sink(level, message.c_str(), current.context);
}

}  // namespace tactus::support
