// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <limits>

namespace tactus::support {

/// Thrown where a computation was to end; caught by whoever may be cancelled. No error.
struct Cancelled {};

/// Thrown where a computation took longer than was left for it; caught by whoever can do without. No error.
struct OutOfTime {};

/// A time at which computations end that were told of it. It may be set and lifted while they go on.
class TimeLimit {
 public:
  using Clock = std::chrono::steady_clock;

  void set(Clock::time_point end) { end_.store(end.time_since_epoch().count(), std::memory_order_relaxed); }
  void lift() { end_.store(never, std::memory_order_relaxed); }
  bool is_over() const {
    const Clock::rep end = end_.load(std::memory_order_relaxed);
    return end != never && Clock::now().time_since_epoch().count() >= end;
  }

 private:
  static constexpr Clock::rep never = std::numeric_limits<Clock::rep>::max();
  std::atomic<Clock::rep> end_{never};
};

/// Whether somebody wants a computation to end, or the clock does. It is asked every millisecond or so by what takes
/// longer. A value; by default nobody can.
class Cancellation {
 public:
  Cancellation() = default;
  /// `flag` and `limit` are read only, and must outlive this.
  Cancellation(const std::atomic<bool>* flag) : flag_(flag) {}
  Cancellation(const Cancellation& other, const TimeLimit* limit) : flag_(other.flag_), limit_(limit) {}

  bool requested() const { return flag_ != nullptr && flag_->load(std::memory_order_relaxed); }

  /// Throws `Cancelled` if it is, `OutOfTime` if a limit is over. What calls it leaves nothing half done.
  void check() const {
    if (requested()) throw Cancelled{};
    if (limit_ != nullptr && limit_->is_over()) throw OutOfTime{};
  }

 private:
  const std::atomic<bool>* flag_ = nullptr;
  const TimeLimit* limit_ = nullptr;
};

}  // namespace tactus::support
