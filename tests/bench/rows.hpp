// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace tactus::bench {

/// What was measured. Times are of the one thread's CPU. What does not apply is empty, and null in JSON.
struct Row {
  std::string work;
  std::size_t pairs = 0;
  std::optional<std::size_t> n;                  ///< configurations of a motion that are tested
  std::optional<double> baseline_s;              ///< for all pairs; scaled where only a share was measured
  double ours_s = 0.0;                           ///< for all pairs
  std::optional<std::size_t> compared;           ///< pairs whose baseline was measured
  std::optional<std::size_t> agreeing;           ///< of those compared
  std::optional<std::size_t> flips_within_1e_9;  ///< not agreeing, but the baseline's answer is ours 1e-9 m away
  int threads = 1;
  double memory_mib = 0.0;                 ///< resident after the work
  std::string note;                        ///< what was compared: triangles, links, trees, shares
  std::vector<std::string> disagreements;  ///< the rest, one sentence each

  std::optional<double> ratio() const { return baseline_s ? std::optional(*baseline_s / ours_s) : std::nullopt; }
};

/// The memory of this process that is resident now, in MiB.
double resident_mib();

void print_heading(std::ostream& out);
void print(std::ostream& out, const Row& row);  ///< as a line of the table, its note below

/// {"rows": [...]}; numbers without loss.
void print_json(std::ostream& out, const std::vector<Row>& rows);

}  // namespace tactus::bench
