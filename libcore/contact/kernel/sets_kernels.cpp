// SPDX-License-Identifier: BSD-3-Clause
#include "contact/kernel/sets.hpp"

namespace tactus::contact::kernel {

const SetKernel* const* set_kernels() {
#ifdef TACTUS_X86
  static constexpr const SetKernel* all[] = {&sets_avx512, &sets_avx2, &sets_sse41, &sets_portable, nullptr};
#else
  static constexpr const SetKernel* all[] = {&sets_portable, nullptr};
#endif
  return all;
}

const SetKernel& fastest_set_kernel() {
  static const SetKernel* const fastest = [] {
    const SetKernel* const* kernel = set_kernels();
    while (!(*kernel)->supported()) ++kernel;
    return *kernel;
  }();
  return *fastest;
}

}  // namespace tactus::contact::kernel
