// SPDX-License-Identifier: BSD-3-Clause
#include "contact/kernel/descent.hpp"

namespace tactus::contact::kernel {

const Kernel* const* kernels() {
#ifdef TACTUS_X86
  static constexpr const Kernel* all[] = {&avx512, &avx2, &sse41, &portable, nullptr};
#else
  static constexpr const Kernel* all[] = {&portable, nullptr};
#endif
  return all;
}

const Kernel& fastest() {
  const Kernel* const* kernel = kernels();
  while (!(*kernel)->supported()) ++kernel;
  return **kernel;
}

}  // namespace tactus::contact::kernel
