// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tactus::support {

enum class LogLevel : int { debug = 0, info = 1, warning = 2, error = 3 };

/// Where log lines go. The library itself never prints: without a sink the lines are dropped.
using LogSink = void (*)(LogLevel level, const char* message, void* context);

/// Sets the sink of the process (null: none). Any thread; a line being delivered still reaches the old sink.
void set_log_sink(LogSink sink, void* context);

/// Sends one line to the sink.
void log(LogLevel level, const std::string& message);

}  // namespace tactus::support
