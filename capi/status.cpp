// SPDX-License-Identifier: BSD-3-Clause
#include "tactus/status.h"

#include <string>

#include "last_error.hpp"
#include "support/error.hpp"

namespace {

using tactus::support::Status;

constexpr struct {
  Status in_core;
  tactus_status value;
  const char* name;
} statuses[] = {
    {Status::ok, TACTUS_OK, "TACTUS_OK"},
    {Status::goal_reached, TACTUS_GOAL_REACHED, "TACTUS_GOAL_REACHED"},
    {Status::no_informative_action, TACTUS_NO_INFORMATIVE_ACTION, "TACTUS_NO_INFORMATIVE_ACTION"},
    {Status::cancelled, TACTUS_CANCELLED, "TACTUS_CANCELLED"},
    {Status::invalid_argument, TACTUS_INVALID_ARGUMENT, "TACTUS_INVALID_ARGUMENT"},
    {Status::buffer_too_small, TACTUS_BUFFER_TOO_SMALL, "TACTUS_BUFFER_TOO_SMALL"},
    {Status::struct_size, TACTUS_STRUCT_SIZE, "TACTUS_STRUCT_SIZE"},
    {Status::busy, TACTUS_BUSY, "TACTUS_BUSY"},
    {Status::stop_off_path, TACTUS_STOP_OFF_PATH, "TACTUS_STOP_OFF_PATH"},
    {Status::wrong_scenario, TACTUS_WRONG_SCENARIO, "TACTUS_WRONG_SCENARIO"},
    {Status::file_not_found, TACTUS_FILE_NOT_FOUND, "TACTUS_FILE_NOT_FOUND"},
    {Status::file_unreadable, TACTUS_FILE_UNREADABLE, "TACTUS_FILE_UNREADABLE"},
    {Status::bad_mesh, TACTUS_BAD_MESH, "TACTUS_BAD_MESH"},
    {Status::bad_robot, TACTUS_BAD_ROBOT, "TACTUS_BAD_ROBOT"},
    {Status::bad_scenario, TACTUS_BAD_SCENARIO, "TACTUS_BAD_SCENARIO"},
    {Status::bad_saved_state, TACTUS_BAD_SAVED_STATE, "TACTUS_BAD_SAVED_STATE"},
    {Status::start_in_collision, TACTUS_START_IN_COLLISION, "TACTUS_START_IN_COLLISION"},
    {Status::prior_unreachable, TACTUS_PRIOR_UNREACHABLE, "TACTUS_PRIOR_UNREACHABLE"},
    {Status::motion_infeasible, TACTUS_MOTION_INFEASIBLE, "TACTUS_MOTION_INFEASIBLE"},
    {Status::out_of_memory, TACTUS_OUT_OF_MEMORY, "TACTUS_OUT_OF_MEMORY"},
    {Status::internal, TACTUS_INTERNAL, "TACTUS_INTERNAL"},
};

constexpr bool values_agree() {
  for (const auto& status : statuses)
    if (static_cast<tactus_status>(status.in_core) != status.value) return false;
  return true;
}
static_assert(values_agree(), "the codes of include/tactus/status.h are those of libcore/support/error.hpp");

thread_local std::string last_error;

}  // namespace

void tactus::capi::set_last_error(const char* function, const char* text) noexcept {
  try {
    last_error = std::string(function) + ": " + text;
  } catch (...) {
    last_error.clear();  // no memory even for the text
  }
}

const char* tactus_status_name(tactus_status status) noexcept {
  for (const auto& known : statuses)
    if (known.value == status) return known.name;
  return "unknown status";
}

const char* tactus_last_error() noexcept { return last_error.c_str(); }
