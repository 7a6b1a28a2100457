// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/kernel/sets.hpp"

/// Written plainly: compilers make the best of it for each width.
namespace tactus::contact::kernel {
namespace {

void count(const SparseWords& sparse, const std::uint32_t* ends, std::size_t groups, const std::uint64_t* dense,
           std::uint32_t* counts) {
  std::uint32_t k = 0;
  for (std::size_t group = 0; group < groups; ++group) {
    std::uint32_t members = 0;
    for (; k < ends[group]; ++k)
      members += static_cast<std::uint32_t>(__builtin_popcountll(sparse.mask[k] & dense[sparse.word[k]]));
    counts[group] = members;
  }
}

std::uint64_t take(const std::uint64_t* __restrict low, const std::uint64_t* __restrict high, int shift,
                   std::size_t rows, std::uint64_t* __restrict left, std::uint64_t* __restrict taken) {
  std::uint64_t any = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::uint64_t window = low[row] >> shift | high[row] << 1 << (63 - shift);
    taken[row] = left[row] & window;
    left[row] &= ~window;
    any |= taken[row];
  }
  return any;
}

}  // namespace
}  // namespace tactus::contact::kernel
