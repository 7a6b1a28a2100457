// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tactus::capi {

/// Sets what `tactus_last_error` gives in this thread: "function: text".
void set_last_error(const char* function, const char* text) noexcept;

}  // namespace tactus::capi
