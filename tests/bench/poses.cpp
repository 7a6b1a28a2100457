// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "bench/episodes.hpp"
#include "bench/timing.hpp"
#include "bench/work.hpp"

namespace tactus::bench {
namespace {

using belief::Belief;

constexpr std::size_t seeds = 100;              // that are brought into agreement with a history
constexpr std::size_t draws = 20;               // of cells, for each of these
constexpr double nearly = 0.001;                // m
constexpr double beside_by[] = {0.0003, 0.01};  // m off the true pose, for seeds beside it

/// Poses of the cells that no motion that met nothing would have met.
std::vector<geometry::PoseVector> seeds_of(const Belief& belief, support::Rng& rng) {
  std::vector<geometry::PoseVector> poses;
  for (std::size_t drawn = 0; drawn < draws * seeds && poses.size() < seeds; ++drawn) {
    const geometry::PoseVector v = belief.cells().draw_in(belief.cells().draw_cell(rng), rng);
    const geometry::Pose pose = geometry::pose_from(v);
    if (std::all_of(belief.history().begin(), belief.history().end(), [&](const belief::Trace& trace) {
          return trace.contact || belief::reproduces(belief.task(), trace, pose);
        }))
      poses.push_back(v);
  }
  return poses;
}

/// Poses up to a centimetre beside the true one, most of them much less.
std::vector<geometry::PoseVector> seeds_beside(const Belief& belief, const geometry::Pose& truth, support::Rng& rng) {
  const double lever = 0.5 * belief.task().target_diameter();
  std::vector<geometry::PoseVector> poses(seeds, geometry::pose_vector(truth));
  for (geometry::PoseVector& v : poses) {
    const double off = std::exp(rng.uniform(std::log(beside_by[0]), std::log(beside_by[1])));
    for (int d = 0; d < 6; ++d)
      if (belief.task().scene().prior.width[d] > 0.0) v[d] += off * rng.uniform(-1.0, 1.0) / (d < 3 ? 1.0 : lever);
  }
  return poses;
}

/// How many of some poses come to agree with the history, and how many to a millimetre.
struct Agreeing {
  std::size_t tried = 0, exactly = 0, to_a_millimetre = 0;
  double seconds = 0.0;

  void add(const Belief& belief, const std::vector<geometry::PoseVector>& from) {
    seconds += thread_seconds("ours", 0.0, [&] {
      for (const geometry::PoseVector& seed : from) {
        const auto found = belief::projected(belief.task(), belief.history(), seed, nearly);
        exactly += found && found->exact();
        to_a_millimetre += found && !found->exact();
      }
    });
    tried += from.size();
  }

  Row row(const std::string& name) const {
    Row row;
    row.work = name;
    row.pairs = tried;
    row.ours_s = seconds;
    row.memory_mib = resident_mib();
    std::ostringstream note;
    note << std::setprecision(3) << exactly << " agree, " << to_a_millimetre << " to a millimetre; "
         << 1000.0 * seconds / static_cast<double>(std::max<std::size_t>(1, tried)) << " ms each";
    row.note = note.str();
    return row;
  }
};

/// Poses brought into agreement with what was felt in some episodes, up to their fourth contact, ...
std::vector<Row> poses(const std::string& name, const Options& options) {
  std::map<std::size_t, Agreeing> after, beside;
  std::map<std::uint64_t, support::Rng> rng_beside;
  for_each_state(model_of(name), options.seed, [&](const State& state, support::Rng& rng) {
    auto& own = rng_beside.try_emplace(state.episode, support::mix(options.seed + state.episode)).first->second;
    after[state.contacts].add(state.belief, seeds_of(state.belief, rng));
    beside[state.contacts].add(state.belief, seeds_beside(state.belief, state.truth, own));
  });
  std::vector<Row> rows;
  for (const auto& [contacts, agreeing] : after) {
    const std::string work = name + "-" + std::to_string(contacts);
    rows.push_back(agreeing.row(work));
    rows.push_back(beside[contacts].row(work + "-beside"));
  }
  return rows;
}

}  // namespace

std::vector<Work> pose_works() { return on_scenarios(poses); }

}  // namespace tactus::bench
