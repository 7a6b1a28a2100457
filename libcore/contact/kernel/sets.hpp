// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

/// The inner loops on sets of cells and voxels, 64 to the word, at the machine's width. Plain data, as for the other
/// kernels; all give the same bits.
namespace tactus::contact::kernel {

/// Members of a set in words of 64.
struct SparseWords {
  const std::uint32_t* word;
  const std::uint64_t* mask;
};

struct SetKernel {
  const char* name;

  /// Whether the machine has the instructions.
  bool (*supported)();

  /// How many members of the dense set are among those of each group of sparse words: group g ends before `ends[g]`.
  void (*count)(const SparseWords& sparse, const std::uint32_t* ends, std::size_t groups, const std::uint64_t* dense,
                std::uint32_t* counts);

  /// Of the members `left` in each of some rows, a word a row, takes those whose bit is set in the word that begins
  /// `shift` (0 .. 63) bits into `low` and goes on in `high`. Returns all that were `taken`, one word over the other.
  std::uint64_t (*take)(const std::uint64_t* low, const std::uint64_t* high, int shift, std::size_t rows,
                        std::uint64_t* left, std::uint64_t* taken);
};

extern const SetKernel sets_portable;
#ifdef TACTUS_X86
extern const SetKernel sets_sse41, sets_avx2, sets_avx512;
#endif

/// All that were built, the widest first; null at the end.
const SetKernel* const* set_kernels();

/// The widest that the machine has.
const SetKernel& fastest_set_kernel();

}  // namespace tactus::contact::kernel
