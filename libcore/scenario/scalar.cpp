// SPDX-License-Identifier: BSD-3-Clause
#include "scenario/scalar.hpp"

#include <algorithm>
#include <charconv>
#include <numbers>
#include <numeric>
#include <string_view>
#include <utility>

namespace tactus::scenario {
namespace {

std::optional<double> decimal_from(std::string_view text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

/// Levenshtein's: how many letters must be put in, taken out or replaced.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::optional<double> number_from(const std::string& text) {
  std::string_view rest = text;
  const bool negative = rest.starts_with('-');
  if (negative || rest.starts_with('+')) rest.remove_prefix(1);
  if (rest.empty() || rest.front() == '-' || rest.front() == '+') return std::nullopt;
  const double sign = negative ? -1.0 : 1.0;

  const std::size_t pi = rest.find("pi");
  if (pi == std::string_view::npos) {
    const std::optional<double> value = decimal_from(rest);
    return value ? std::optional(sign * *value) : std::nullopt;
  }
  const std::string_view before = rest.substr(0, pi), after = rest.substr(pi + 2);
  const std::optional<double> factor = before.empty() ? 1.0 : decimal_from(before);
  const std::optional<double> divisor = after.empty()          ? 1.0
                                        : after.front() == '/' ? decimal_from(after.substr(1))
                                                               : std::nullopt;
  if (!factor || !divisor) return std::nullopt;
  return sign * *factor * std::numbers::pi / *divisor;
}

std::string number_text(double number) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr};
}

std::string alternatives(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return text;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& words) {
  if (word.size() > 64) return {};
  const std::string* best = nullptr;
  std::size_t fewest = std::min<std::size_t>(3, word.size() / 2) + 1;
  for (const std::string& candidate : words) {
    const std::size_t edits = edit_distance(word, candidate);
    if (edits < fewest) fewest = edits, best = &candidate;
  }
  return best == nullptr ? std::string() : " (did you mean " + *best + "?)";
}

}  // namespace tactus::scenario
