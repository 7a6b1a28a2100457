// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace tactus::support {

/// Why something could not be done. The values are those of `tactus_status` in `include/tactus/status.h` and never
/// change.
enum class Status : std::int32_t {
  ok = 0,
  // 1..99: not an error, but no result of the usual kind
  goal_reached = 1,
  no_informative_action = 2,
  cancelled = 3,
  // 100..199: the caller's arguments
  invalid_argument = 100,
  buffer_too_small = 101,
  struct_size = 102,
  busy = 103,
  stop_off_path = 104,
  wrong_scenario = 105,
  // 200..299: files
  file_not_found = 200,
  file_unreadable = 201,
  bad_mesh = 202,
  bad_robot = 203,
  bad_scenario = 204,
  bad_saved_state = 205,
  // 300..399: the task as described can't be done
  start_in_collision = 300,
  prior_unreachable = 301,
  motion_infeasible = 302,
  // 900..: ours or the machine's
  out_of_memory = 900,
  internal = 901,
};

/// The one exception of the core. `what()` is a sentence for a person: what was wrong, where, what was found, what was
/// expected.
class Error : public std::runtime_error {
 public:
  Error(Status status, const std::string& what) : std::runtime_error(what), status_(status) {}
  Status status() const { return status_; }

 private:
  Status status_;
};

/// One thing wrong in an input file: where it stands, what was found there, what was expected.
struct Problem {
  std::string where;  ///< "shelf.yaml:12: prior.width.y"
  std::string found;
  std::string expected;
};

/// "where: found X, expected Y", one line a problem.
std::string to_text(const std::vector<Problem>& problems);

/// Throws an `Error` with all the problems in it, if there are any.
void throw_if_any(const std::vector<Problem>& problems, Status status, const std::string& heading);

}  // namespace tactus::support
