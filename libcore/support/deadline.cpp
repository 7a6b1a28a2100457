// SPDX-License-Identifier: BSD-3-Clause
#include "support/deadline.hpp"

#include <algorithm>

namespace tactus::support {

Deadline::Deadline(double seconds, std::uint64_t expansions, Cancellation cancellation)
    : seconds_(seconds), limit_(expansions), cancellation_(cancellation) {}

bool Deadline::spent() const { return cancelled() || used_ >= limit_ || elapsed_seconds() >= seconds_; }

double Deadline::used_fraction() const {
  if (limit_ == 0 || !(seconds_ > 0.0) || cancelled()) return 1.0;
  const double of_time = elapsed_seconds() / seconds_;
  const double of_count = limit_ == UINT64_MAX ? 0.0 : static_cast<double>(used_) / static_cast<double>(limit_);
  return std::min(1.0, std::max(of_time, of_count));
}

Deadline::Clock::time_point Deadline::at(double share) const {
  constexpr double most = 1e6;
  if (!(seconds_ < most)) return Clock::time_point::max();
  return start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(share * seconds_));
}

double Deadline::elapsed_seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

}  // namespace tactus::support
