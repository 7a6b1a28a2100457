// SPDX-License-Identifier: BSD-3-Clause
#include "support/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace tactus::support {
namespace {

constexpr std::size_t ranges_per_thread = 8;  // so that none waits long for the others
constexpr std::size_t least_count = 32;

}  // namespace

std::size_t thread_count(int threads) {
  return threads > 0 ? static_cast<std::size_t>(threads) : std::max(1u, std::thread::hardware_concurrency());
}

void for_ranges(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& work) {
  const std::size_t workers = count < least_count ? 1 : std::min(count, thread_count(threads));
  if (workers == 1) return work(0, count);
  const std::size_t size = count / (workers * ranges_per_thread) + 1;
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto run = [&] {
    try {
      for (std::size_t begin = next.fetch_add(size); begin < count; begin = next.fetch_add(size))
        work(begin, std::min(count, begin + size));
    } catch (...) {
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    try {
      for (std::size_t i = 1; i < workers; ++i) others.emplace_back(run);
    } catch (const std::system_error&) {  // no more threads are to be had: with those that there are
    }
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace tactus::support
