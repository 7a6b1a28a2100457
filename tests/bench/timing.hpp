// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace tactus::bench {

/// CPU seconds of this thread for one run of `work`, by Google Benchmark: the mean over as many runs as fill
/// `at_least` seconds; 0: one run.
double thread_seconds(const std::string& name, double at_least, const std::function<void()>& work);

}  // namespace tactus::bench
