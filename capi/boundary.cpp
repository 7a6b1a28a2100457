// SPDX-License-Identifier: BSD-3-Clause
#include "boundary.hpp"

#include <cmath>
#include <new>

#include "last_error.hpp"

namespace tactus::capi {
namespace {

constexpr std::size_t largest_struct = 4096;
constexpr double unit_tolerance = 1e-3;

tactus_status noted(Status status, const char* function, const char* text) noexcept {
  set_last_error(function, text);
  return static_cast<tactus_status>(status);
}

}  // namespace

tactus_status failed(const char* function) noexcept {
  try {
    throw;
  } catch (const Error& error) {
    return noted(error.status(), function, error.what());
  } catch (const std::bad_alloc&) {
    return noted(Status::out_of_memory, function, "out of memory");
  } catch (const std::exception& error) {
    return noted(Status::internal, function, error.what());
  } catch (...) {
    return noted(Status::internal, function, "an exception of unknown type");
  }
}

void reject(const std::string& argument, const std::string& found, const std::string& expected) {
  throw Error(Status::invalid_argument, argument + ": found " + found + ", expected " + expected);
}

std::size_t index_below(std::size_t size, std::size_t index, const char* argument) {
  if (index >= size) reject(argument, std::to_string(index), "an index below " + std::to_string(size));
  return index;
}

robot::JointVector joints_from(const double* q, int dof, const char* argument) {
  return Eigen::Map<const robot::JointVector>(&required(q, argument), dof);
}

geometry::Pose pose_from(const double* xyzq, const char* argument) {
  required(xyzq, argument);
  double copy[7];
  double squares = 0.0;
  for (int i = 0; i < 7; ++i) {
    copy[i] = xyzq[i];
    if (!std::isfinite(copy[i]))
      reject(std::string(argument) + "[" + std::to_string(i) + "]", "a value that is not finite", "a number");
    if (i >= 3) squares += copy[i] * copy[i];
  }
  if (std::abs(std::sqrt(squares) - 1.0) > unit_tolerance)
    reject(argument, "a quaternion of norm " + std::to_string(std::sqrt(squares)), "x y z qx qy qz qw with norm 1");
  return geometry::pose_from_quaternion(copy);
}

void write_pose(const geometry::Pose& pose, double* xyzq) {
  double copy[7];
  geometry::to_quaternion(pose, copy);
  std::copy(std::begin(copy), std::end(copy), xyzq);
}

std::size_t checked_size(std::size_t size, const char* argument) {
  if (size < struct_block || size > largest_struct)
    throw Error(Status::struct_size,
                std::string(argument) + ": found a struct of " + std::to_string(size) +
                    " bytes, expected the size of the caller's struct; its _init function sets it");
  return size;
}

void check_tail(const unsigned char* bytes, std::size_t known, std::size_t size, const char* argument) {
  for (std::size_t i = known; i < size; ++i)
    if (bytes[i] != 0)
      throw Error(Status::struct_size, std::string(argument) + ": found a value at byte " + std::to_string(i) +
                                           ", expected zeros from byte " + std::to_string(known) +
                                           " on: this version of the library knows no field there");
}

Use::Use(std::atomic<bool>& in_use, const char* argument) : in_use_(in_use) {
  if (in_use_.exchange(true, std::memory_order_acquire))
    throw Error(Status::busy,
                std::string(argument) + ": found it in use by another call, expected one thread at a time");
}

}  // namespace tactus::capi
