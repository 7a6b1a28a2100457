// SPDX-License-Identifier: BSD-3-Clause
#include "bench/work.hpp"

namespace tactus::bench {

std::vector<Work> lattice_works() { return {}; }

}  // namespace tactus::bench
