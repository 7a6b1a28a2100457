// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "geometry/pose.hpp"
#include "robot/model.hpp"
#include "support/error.hpp"
#include "tactus/status.h"

/// What every entry point of the C ABI is made of: one exception boundary, and the checks of its arguments.
namespace tactus::capi {

using support::Error;
using support::Status;

/// Notes the text for `tactus_last_error` of this thread and returns the code. Inside a `catch` only.
tactus_status failed(const char* function) noexcept;

/// Runs `body` and turns what it throws into a status and a text. `body` returns nothing, or a `Status`.
template <typename Body>
tactus_status guarded(const char* function, Body&& body) noexcept {
  try {
    if constexpr (std::is_void_v<decltype(body())>) {
      body();
      return TACTUS_OK;
    } else {
      return static_cast<tactus_status>(body());
    }
  } catch (...) {
    return failed(function);
  }
}

[[noreturn]] void reject(const std::string& argument, const std::string& found, const std::string& expected);

/// `*pointer`; throws if it is NULL.
template <typename T>
T& required(T* pointer, const char* argument) {
  if (pointer == nullptr) reject(argument, "NULL", "a pointer");
  return *pointer;
}

/// Where a new handle goes: NULL at once, so that it is NULL after any error.
template <typename Handle>
Handle*& cleared(Handle** out, const char* argument) {
  return required(out, argument) = nullptr;
}

/// `index`, checked against `size`.
std::size_t index_below(std::size_t size, std::size_t index, const char* argument);

// --- arrays and vectors

/// Where to write `rows` rows; null if only their number was asked for. Always sets `*count`.
template <typename T>
T* room_for(std::size_t rows, T* buffer, std::size_t capacity, std::size_t* count, const char* argument) {
  required(count, "count") = rows;
  if (buffer == nullptr && capacity == 0) return nullptr;
  required(buffer, argument);
  if (capacity < rows)
    throw Error(Status::buffer_too_small, std::string(argument) + ": found a capacity of " + std::to_string(capacity) +
                                              ", expected " + std::to_string(rows));
  return buffer;
}

/// Copies a container of plain values, one a row.
template <typename Container, typename T>
void give(const Container& values, T* buffer, std::size_t capacity, std::size_t* count, const char* argument) {
  if (T* out = room_for(static_cast<std::size_t>(values.size()), buffer, capacity, count, argument))
    std::copy(values.begin(), values.end(), out);
}

robot::JointVector joints_from(const double* q, int dof, const char* argument);

/// Throws for NULL, a value that is not finite, and a quaternion whose norm is not 1 (to 1e-3).
geometry::Pose pose_from(const double* xyzq, const char* argument);
void write_pose(const geometry::Pose& pose, double* xyzq);

// --- structs that begin with `struct_size`

/// Every field, or pair of smaller ones, fills eight bytes: what a `struct_size` covers is a number of such blocks.
inline constexpr std::size_t struct_block = 8;

/// The size, if it is one that a caller can mean.
std::size_t checked_size(std::size_t size, const char* argument);

/// Throws if bytes that this version does not know are set.
void check_tail(const unsigned char* bytes, std::size_t known, std::size_t size, const char* argument);

/// How many bytes of a `T` a struct of `size` bytes covers.
template <typename T>
std::size_t covered(std::size_t size) {
  static_assert(sizeof(T) % struct_block == 0 && offsetof(T, struct_size) == 0);
  return std::min(size - size % struct_block, sizeof(T));
}

template <typename T>
void init_struct(T* out, std::size_t size, T defaults, const char* argument) {
  required(out, argument);
  defaults.struct_size = static_cast<std::uint32_t>(checked_size(size, "size"));
  std::memset(static_cast<void*>(out), 0, size);
  std::memcpy(static_cast<void*>(out), &defaults, covered<T>(size));
}

/// What the caller set, over `defaults` where the size does not reach.
template <typename T>
T read_struct(const T* given, T defaults, const char* argument) {
  const std::size_t size = checked_size(required(given, argument).struct_size, argument);
  check_tail(reinterpret_cast<const unsigned char*>(given), sizeof(T), size, argument);
  std::memcpy(static_cast<void*>(&defaults), given, covered<T>(size));
  return defaults;
}

/// Writes what the caller's struct has room for.
template <typename T>
void write_struct(T* out, T value, const char* argument) {
  value.struct_size = static_cast<std::uint32_t>(checked_size(required(out, argument).struct_size, argument));
  const std::size_t size = value.struct_size;
  std::memcpy(static_cast<void*>(out), &value, covered<T>(size));
  if (size > sizeof(T)) std::memset(reinterpret_cast<unsigned char*>(out) + sizeof(T), 0, size - sizeof(T));
}

// --- one thread at a time

/// Holds an object for one call; throws `busy` if another thread holds it.
class Use {
 public:
  Use(std::atomic<bool>& in_use, const char* argument);
  ~Use() { in_use_.store(false, std::memory_order_release); }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  std::atomic<bool>& in_use_;
};

}  // namespace tactus::capi
