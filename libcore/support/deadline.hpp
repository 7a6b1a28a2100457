// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>

#include "support/cancellation.hpp"

namespace tactus::support {

/// How long a computation may go on: wall-clock seconds, counted expansions, or until somebody cancels. Any of them may
/// be without limit. A budget in expansions gives the same result on every machine; one in seconds can't.
class Deadline {
 public:
  using Clock = std::chrono::steady_clock;

  Deadline(double seconds, std::uint64_t expansions, Cancellation cancellation = {});
  static Deadline unlimited() { return {std::numeric_limits<double>::infinity(), UINT64_MAX}; }

  void count_expansion() { ++used_; }
  const Cancellation& cancellation() const { return cancellation_; }
  bool cancelled() const { return cancellation_.requested(); }
  bool spent() const;            ///< out of time, out of expansions, or cancelled
  double used_fraction() const;  ///< of the tighter budget, in [0, 1]; 0 without one, 1 if cancelled
  double elapsed_seconds() const;
  Clock::time_point at(double share) const;  ///< so much of the seconds; the end of all time without a limit
  std::uint64_t expansions() const { return used_; }

 private:
  Clock::time_point start_ = Clock::now();
  double seconds_;
  std::uint64_t limit_;
  std::uint64_t used_ = 0;
  Cancellation cancellation_;
};

}  // namespace tactus::support
