// SPDX-License-Identifier: BSD-3-Clause
#include <iomanip>
#include <sstream>

#include "bench/timing.hpp"
#include "bench/work.hpp"
#include "scenario/scenario.hpp"
#include "solver/walk_cost.hpp"

namespace tactus::bench {
namespace {

using support::Bitset;

constexpr double seconds = 0.2;
constexpr std::size_t others = 1000;  // poses that a walk was not laid out for
constexpr std::size_t beams[] = {6, 24, 96};
constexpr std::size_t samples[] = {120, 480};

solver::Predictions drawn(const std::shared_ptr<const action::Task>& task, std::size_t count, support::Rng& rng) {
  std::vector<geometry::Pose> poses;
  while (poses.size() < count) poses.push_back(task->scene().prior.sample(rng));
  return {task, std::move(poses)};
}

std::string share(std::size_t count, std::size_t of) {
  std::ostringstream text;
  text << std::setprecision(3) << 100.0 * static_cast<double>(count) / static_cast<double>(of) << " %";
  return text.str();
}

/// Walks from where the robot stands, laid out for some poses of the prior, and what they cost on those and on others.
std::vector<Row> walks(const std::string& name, const Options& options) {
  const std::shared_ptr<const action::Task> task =
      scenario::load(TACTUS_SOURCE_DIR "/examples/scenarios/" + name + ".yaml")->task;
  const robot::JointVector& q = task->scene().start;
  const auto lattice = action::ActionLibrary(*task).lattice_through(q);
  support::Rng rng(options.seed);
  solver::Predictions other_poses = drawn(task, others, rng);
  const solver::Walks elsewhere(task, lattice, other_poses);
  std::vector<Row> rows;
  for (const std::size_t sample : samples) {
    solver::Predictions poses = drawn(task, sample, rng);
    const solver::Walks here(task, lattice, poses);
    const Bitset all(sample, true);
    for (const std::size_t beam : beams) {
      solver::Walk walk = here.best(all, task->base_from_tool(q), beam);
      Row row;
      row.work = name + "-" + std::to_string(sample) + "-" + std::to_string(beam);
      row.pairs = sample * lattice->size() * action::Lattice::directions;
      row.n = walk.steps.size();
      row.ours_s = thread_seconds("ours", seconds, [&] { walk = here.best(all, task->base_from_tool(q), beam); });
      row.memory_mib = resident_mib();
      const test::WalkCost own = test::cost_of(walk, here, all),
                           other = test::cost_of(walk, elsewhere, Bitset(others, true));
      std::ostringstream note;
      note << std::setprecision(3) << "until touched " << own.expected << " on its poses, " << other.expected
           << " on others; misses " << share(own.missed, sample) << ", " << share(other.missed, others);
      row.note = note.str();
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

}  // namespace

std::vector<Work> walk_works() { return on_scenarios(walks); }

}  // namespace tactus::bench
