// SPDX-License-Identifier: BSD-3-Clause
#include "contact/kernel/sets.inl.hpp"

namespace tactus::contact::kernel {
namespace {

bool supported() { return true; }

}  // namespace

constinit const SetKernel sets_portable{"portable", &supported, &count, &take};

}  // namespace tactus::contact::kernel
