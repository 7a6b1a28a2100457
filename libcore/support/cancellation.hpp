// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>

namespace tactus::support {

/// Thrown where a computation was to end; caught by whoever may be cancelled. No error.
struct Cancelled {};

/// Whether somebody wants a computation to end. It is asked every millisecond or so by what takes longer. A value; by
/// default nobody can.
class Cancellation {
 public:
  Cancellation() = default;
  /// `flag` is read only, and must outlive this.
  Cancellation(const std::atomic<bool>* flag) : flag_(flag) {}

  bool requested() const { return flag_ != nullptr && flag_->load(std::memory_order_relaxed); }

  /// Throws `Cancelled` if it is. What calls it leaves nothing half done.
  void check() const {
    if (requested()) throw Cancelled{};
  }

 private:
  const std::atomic<bool>* flag_ = nullptr;
};

}  // namespace tactus::support
