// SPDX-License-Identifier: BSD-3-Clause
#include "bench/work.hpp"

namespace tactus::bench {

std::vector<Work> belief_works() { return {}; }

}  // namespace tactus::bench
