// SPDX-License-Identifier: BSD-3-Clause
#include "solver/candidates.hpp"

namespace tactus::solver {

Candidates::Candidates(const Search& search, int node, std::optional<Greedy> rule, double telling,
                       std::vector<std::size_t> held_back)
    : search_(search),
      node_(node),
      rule_(rule),
      telling_(telling),
      held_back_(std::move(held_back)),
      verdicts_(search.choices(node).size(), Verdict::passed_over) {
  for (const std::size_t choice : held_back_) verdicts_[choice] = Verdict::set_aside;
}

std::optional<std::size_t> Candidates::next() {
  const auto choice = best();
  if (choice || held_back_.empty()) return choice;
  for (const std::size_t held : held_back_) verdicts_[held] = Verdict::passed_over;
  held_back_.clear();
  return best();
}

void Candidates::rule_out(std::size_t choice, Verdict why) { verdicts_[choice] = why; }

std::vector<Verdict> Candidates::verdicts(std::size_t chosen) const {
  const std::vector<bool> is_left_out = left_out();
  std::vector<Verdict> result = verdicts_;
  for (std::size_t i = 0; i < result.size(); ++i)
    if (is_left_out[i] && result[i] == Verdict::passed_over) result[i] = Verdict::set_aside;
  result[chosen] = Verdict::chosen;
  return result;
}

std::optional<std::size_t> Candidates::best() const {
  return rule_ ? greedy_choice(search_.choices(node_), *rule_, left_out()) : search_.best(node_, left_out());
}

std::vector<bool> Candidates::left_out() const {
  std::vector<bool> banned;
  for (const Verdict verdict : verdicts_) banned.push_back(verdict != Verdict::passed_over);
  return falling_short(search_.choices(node_), telling_, banned);
}

}  // namespace tactus::solver
