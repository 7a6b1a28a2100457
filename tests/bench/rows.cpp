// SPDX-License-Identifier: BSD-3-Clause
#include "bench/rows.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <limits>
#include <ostream>
#include <sstream>

namespace tactus::bench {
namespace {

std::string quoted(const std::string& text) {
  std::ostringstream out;
  out << '"';
  for (const char c : text) {
    if (c == '"' || c == '\\') out << '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      out << "\\u" << std::hex << std::setw(4) << std::setfill('0') << static_cast<int>(c) << std::dec;
    else
      out << c;
  }
  out << '"';
  return out.str();
}

template <typename Number>
std::string json(const std::optional<Number>& number) {
  if (!number) return "null";
  std::ostringstream out;
  out << std::setprecision(std::numeric_limits<double>::max_digits10) << *number;
  return out.str();
}

std::string json(double number) { return json(std::isfinite(number) ? std::optional(number) : std::nullopt); }

template <typename Number>
std::string cell(const std::optional<Number>& number, int digits = 0) {
  if (!number) return "-";
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << *number;
  return out.str();
}

std::optional<double> per_pair(const std::optional<double>& seconds, std::size_t pairs) {
  return seconds ? std::optional(1e6 * *seconds / static_cast<double>(pairs)) : std::nullopt;
}

void print_line(std::ostream& out, const std::array<std::string, 11>& cells) {
  constexpr std::array widths{14, 9, 5, 12, 9, 10, 9, 8, 10, 6, 9};
  for (std::size_t i = 0; i < cells.size(); ++i)
    out << (i == 0 ? std::left : std::right) << std::setw(widths[i]) << cells[i];
  out << '\n';
}

}  // namespace

double resident_mib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1024.0;
  return std::numeric_limits<double>::quiet_NaN();
}

void print_heading(std::ostream& out) {
  print_line(out,
             {"work", "pairs", "n", "baseline s", "us/pair", "ours s", "us/pair", "ratio", "agreeing", "flips", "MiB"});
}

void print(std::ostream& out, const Row& row) {
  print_line(out, {row.work, std::to_string(row.pairs), cell(row.n), cell(row.baseline_s, 3),
                   cell(per_pair(row.baseline_s, row.pairs), 2), cell(std::optional(row.ours_s), 4),
                   cell(per_pair(row.ours_s, row.pairs), 3), cell(row.ratio(), 1), cell(row.agreeing),
                   cell(row.flips_within_1e_9), cell(std::optional(row.memory_mib))});
  out << "    " << row.note << '\n';
  for (const std::string& disagreement : row.disagreements) out << "    DISAGREEMENT: " << disagreement << '\n';
  out.flush();
}

void print_json(std::ostream& out, const std::vector<Row>& rows) {
  out << "{\"rows\":[";
  for (const Row& row : rows) {
    out << (&row == &rows.front() ? "\n" : ",\n") << "{\"work\":" << quoted(row.work) << ",\"pairs\":" << row.pairs
        << ",\"n\":" << json(row.n) << ",\"baseline_s\":" << json(row.baseline_s) << ",\"ours_s\":" << json(row.ours_s)
        << ",\"ratio\":" << json(row.ratio()) << ",\"compared\":" << json(row.compared)
        << ",\"agreeing\":" << json(row.agreeing) << ",\"flips_within_1e-9\":" << json(row.flips_within_1e_9)
        << ",\"threads\":" << row.threads << ",\"memory_mib\":" << json(row.memory_mib)
        << ",\"note\":" << quoted(row.note) << ",\"disagreements\":[";
    for (const std::string& disagreement : row.disagreements)
      out << (&disagreement == &row.disagreements.front() ? "" : ",") << quoted(disagreement);
    out << "]}";
  }
  out << "\n]}\n";
}

}  // namespace tactus::bench
