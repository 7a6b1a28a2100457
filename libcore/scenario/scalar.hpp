// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tactus::scenario {

/// The number that a scalar of a scenario file stands for: "-0.25", "1e-3", or a multiple of pi: "pi", "2pi", "-pi/4",
/// "1.5pi".
std::optional<double> number_from(const std::string& text);

/// The number as short as it can be written without loss.
std::string number_text(double number);

/// "a, b or c"
std::string alternatives(const std::vector<std::string>& words);

/// " (did you mean b?)" where one of `words` is spelled nearly as `word`, otherwise nothing.
std::string suggestion(const std::string& word, const std::vector<std::string>& words);

}  // namespace tactus::scenario
