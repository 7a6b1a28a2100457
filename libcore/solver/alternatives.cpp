// SPDX-License-Identifier: BSD-3-Clause
#include "solver/alternatives.hpp"

#include <algorithm>

namespace tactus::solver {

std::vector<Alternative> alternatives(const Search& search, int node, std::optional<Greedy> rule,
                                      const std::vector<Verdict>& verdicts) {
  const std::vector<Choice>& choices = search.choices(node);
  std::vector<bool> left_out;
  for (const Verdict verdict : verdicts)
    left_out.push_back(verdict == Verdict::set_aside || verdict == Verdict::unreachable);
  const double most = most_information(choices, left_out);
  std::vector<std::pair<Merit, std::size_t>> ranked;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const auto merit =
        rule ? merit_of(choices[i], *rule, most) : Merit{false, -search.q_value(node, i, search.executed_by())};
    if (merit) ranked.emplace_back(*merit, i);
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Alternative> result;
  for (const auto& [merit, i] : ranked)
    result.push_back(
        {choices[i],
         {search.q_value(node, i, ValueType::admissible), search.q_value(node, i, ValueType::inadmissible)},
         verdicts[i]});
  return result;
}

}  // namespace tactus::solver
