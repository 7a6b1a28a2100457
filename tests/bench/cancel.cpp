// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <iomanip>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <thread>

#include "bench/episodes.hpp"
#include "bench/work.hpp"
#include "solver/planner.hpp"

namespace tactus::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t queries = 40;  // for each state
constexpr double latest = 0.8;       // s after which a query is cancelled

solver::PlannerOptions without_end(std::uint64_t seed) {
  solver::PlannerOptions options;
  options.budget_seconds = std::numeric_limits<double>::infinity();
  options.budget_expansions = 1000000;
  options.seed = seed;
  return options;
}

/// Seconds of wall clock from `cancel` until the query is back; none if it was back before.
std::optional<double> cancelled_after(solver::Planner& planner, const belief::Belief& belief, double seconds) {
  std::atomic<bool> is_back = false;
  Clock::time_point back;
  std::thread query([&] {
    planner.query(belief);
    back = Clock::now();
    is_back = true;
  });
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  const bool was_back = is_back;
  const Clock::time_point start = Clock::now();
  for (; !is_back; std::this_thread::sleep_for(std::chrono::milliseconds(1))) planner.cancel();
  query.join();
  if (was_back) return std::nullopt;
  return std::max(0.0, std::chrono::duration<double>(back - start).count());
}

/// Times are of the wall clock here.
Row row_of(const std::string& work, std::vector<double> seconds) {
  std::sort(seconds.begin(), seconds.end());
  const auto at = [&](double share) {
    return 1000.0 * seconds[static_cast<std::size_t>(share * static_cast<double>(seconds.size() - 1))];
  };
  Row row;
  row.work = work;
  row.pairs = seconds.size();
  row.ours_s = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  row.memory_mib = resident_mib();
  std::ostringstream note;
  note << std::setprecision(3) << "back after " << at(0.5) << " ms in the median, " << at(0.95) << " in 95 of 100, "
       << at(1.0) << " at most";
  row.note = note.str();
  return row;
}

/// Queries that are cancelled at random times, before the first contact and after the 4th, 8th, ...
std::vector<Row> cancels(const std::string& name, const Options& options) {
  const auto model = model_of(name);
  std::map<std::size_t, std::vector<double>> after;
  support::Rng rng(support::mix(options.seed));
  const auto look_at = [&](const belief::Belief& belief, std::size_t contacts) {
    solver::Planner planner(model, without_end(options.seed));
    for (std::size_t query = 0; query < queries; ++query)
      if (const auto seconds = cancelled_after(planner, belief, rng.uniform(0.0, latest)))
        after[contacts].push_back(*seconds);
  };
  look_at(belief::Belief(model, model->task->scene().start), 0);
  for_each_state(model, options.seed,
                 [&](const State& state, support::Rng&) { look_at(state.belief, state.contacts); });
  std::vector<Row> rows;
  for (const auto& [contacts, seconds] : after)
    if (!seconds.empty()) rows.push_back(row_of(name + "-" + std::to_string(contacts), seconds));
  return rows;
}

}  // namespace

std::vector<Work> cancel_works() { return on_scenarios(cancels); }

}  // namespace tactus::bench
