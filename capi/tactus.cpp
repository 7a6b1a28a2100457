// SPDX-License-Identifier: BSD-3-Clause
#include "tactus/tactus.h"

#include <mutex>

#include "boundary.hpp"
#include "support/log.hpp"

namespace {

using tactus::support::LogLevel;

static_assert(TACTUS_VERSION_MAJOR == TACTUS_PROJECT_MAJOR && TACTUS_VERSION_MINOR == TACTUS_PROJECT_MINOR &&
                  TACTUS_VERSION_PATCH == TACTUS_PROJECT_PATCH,
              "the version of include/tactus/tactus.h is the project's");
static_assert(TACTUS_LOG_DEBUG == static_cast<int>(LogLevel::debug) &&
              TACTUS_LOG_INFO == static_cast<int>(LogLevel::info) &&
              TACTUS_LOG_WARNING == static_cast<int>(LogLevel::warning) &&
              TACTUS_LOG_ERROR == static_cast<int>(LogLevel::error));

struct Sink {
  tactus_log_callback callback = nullptr;
  void* context = nullptr;
};

std::mutex mutex;
Sink sink;

void deliver(LogLevel level, const char* message, void*) {
  Sink current;
  {
    const std::lock_guard lock(mutex);
    current = sink;
  }
  if (current.callback != nullptr) current.callback(static_cast<int32_t>(level), message, current.context);
}

}  // namespace

int32_t tactus_version() noexcept {
  return 10000 * TACTUS_VERSION_MAJOR + 100 * TACTUS_VERSION_MINOR + TACTUS_VERSION_PATCH;
}

const char* tactus_version_string() noexcept { return TACTUS_PROJECT_VERSION; }

tactus_status tactus_set_log_callback(tactus_log_callback callback, void* context) noexcept {
  return tactus::capi::guarded(__func__, [&] {
    const std::lock_guard lock(mutex);
    sink = {callback, context};
    tactus::support::set_log_sink(callback == nullptr ? nullptr : deliver, nullptr);
  });
}
