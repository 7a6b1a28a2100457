// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace tactus::support {

/// How many threads that is: 0 asks for as many as the machine has.
std::size_t thread_count(int threads);

/// Calls `work(begin, end)` for ranges that together are [0, count), on up to `threads` threads (as `thread_count`) and
/// returns when all are done. What one call writes no other may read. An exception of one is thrown here. With one
/// thread, or few things to do, no thread is made.
void for_ranges(std::size_t count, int threads, const std::function<void(std::size_t begin, std::size_t end)>& work);

}  // namespace tactus::support
