// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "bench/work.hpp"

namespace tactus::bench {

/// A mistake on the command line, as a sentence.
class UsageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Arguments {
  bool help = false;
  std::string suite;        ///< contact, voxels, belief, poses or walks
  std::string json;         ///< file, "-" for stdout, empty for none
  std::vector<Work> works;  ///< the chosen ones
  Options options;
};

extern const char* const usage;

/// Throws `UsageError`.
Arguments parse_arguments(const std::vector<std::string>& words);

}  // namespace tactus::bench
