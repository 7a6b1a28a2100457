// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/setting.hpp"
#include "bench/work.hpp"

namespace tactus::bench {

/// Times FCL and ours on the same pairs, one thread each, and compares the answers at margin 0. What does not depend on
/// a motion or a pose (trees, fields) is built outside of the timing, what a motion needs inside, on either side.
Row compare(const std::string& work, const Setting& setting, const Options& options);

}  // namespace tactus::bench
