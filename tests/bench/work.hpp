// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/rows.hpp"

namespace tactus::bench {

struct Options {
  std::size_t pairs = 400'000;  ///< (motion, pose) pairs of a work
  std::uint64_t seed = 1;
  double baseline_share = 1.0;  ///< of the pairs on which the baseline is measured, in (0, 1]
};

/// Something to be timed, as `--works` names it. It gives one row or more.
struct Work {
  std::string name;
  std::function<std::vector<Row>(const Options&)> run;
};

/// The same work on each of the scenarios that true poses are drawn for, named as they are.
std::vector<Work> on_scenarios(std::vector<Row> (*run)(const std::string& scenario, const Options&));

std::vector<Work> contact_works();  ///< with those on the lattice at the end
std::vector<Work> lattice_works();
std::vector<Work> voxel_works();
std::vector<Work> belief_works();
std::vector<Work> pose_works();
std::vector<Work> walk_works();
std::vector<Work> cancel_works();

}  // namespace tactus::bench
