// SPDX-License-Identifier: BSD-3-Clause
#include "support/error.hpp"

namespace tactus::support {

std::string to_text(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += problem.where + ": found " + problem.found + ", expected " + problem.expected;
  }
  return text;
}

void throw_if_any(const std::vector<Problem>& problems, Status status, const std::string& heading) {
  if (problems.empty()) return;
  const std::string count = std::to_string(problems.size()) + (problems.size() == 1 ? " problem" : " problems");
  throw Error(status, heading + ": " + count + '\n' + to_text(problems));
}

}  // namespace tactus::support
