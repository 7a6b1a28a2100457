// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "solver/greedy.hpp"
#include "solver/search.hpp"

namespace tactus::solver {

/// What became of a motion that was weighed for an answer.
enum class Verdict : std::int32_t {
  passed_over = 0,  ///< a better one was found
  chosen = 1,       ///< handed out
  unreachable = 2,  ///< no free way to its start
  set_aside = 3,    ///< it changed nothing when it was last tried, others come first while the belief stalls, or it
                    ///< tells too little for its cost beside another
};

/// A motion weighed for an answer.
struct Alternative {
  Choice choice;
  Values q{};  ///< Q(b, a) in units of cost: this motion, and then on; by `ValueType`
  Verdict verdict = Verdict::passed_over;
};

/// The motions weighed at an expanded belief, those that are executed first in front: by Q, or as the one-step rule
/// has it, and then only those that it may choose. `verdicts`: by choice.
std::vector<Alternative> alternatives(const Search& search, int node, std::optional<Greedy> rule,
                                      const std::vector<Verdict>& verdicts);

}  // namespace tactus::solver
