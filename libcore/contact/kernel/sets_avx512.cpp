// SPDX-License-Identifier: BSD-3-Clause
#include "contact/kernel/sets.inl.hpp"

namespace tactus::contact::kernel {
namespace {

bool supported() { return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("popcnt"); }

}  // namespace

constinit const SetKernel sets_avx512{"avx512", &supported, &count, &take};

}  // namespace tactus::contact::kernel
