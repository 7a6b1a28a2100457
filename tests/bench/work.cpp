// SPDX-License-Identifier: BSD-3-Clause
#include "bench/work.hpp"

namespace tactus::bench {

std::vector<Work> on_scenarios(std::vector<Row> (*run)(const std::string& scenario, const Options&)) {
  std::vector<Work> works;
  for (const std::string name : {"shelf_3d", "base_4d", "sim_5d"})
    works.push_back({name, [name, run](const Options& options) { return run(name, options); }});
  return works;
}

}  // namespace tactus::bench
