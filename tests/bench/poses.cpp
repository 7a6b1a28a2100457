// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "bench/timing.hpp"
#include "bench/work.hpp"
#include "scenario/scenario.hpp"
#include "simulation/world.hpp"

namespace tactus::bench {
namespace {

using belief::Belief;

constexpr std::size_t contacts[] = {4, 8, 12, 16};
constexpr std::size_t seeds = 100;  // that are brought into agreement with a history
constexpr std::size_t draws = 20;   // of cells, for each of these
constexpr std::uint64_t episodes = 3;
constexpr std::size_t most_actions = 60;
constexpr double nearly = 0.001;                // m
constexpr double beside_by[] = {0.0003, 0.01};  // m off the true pose, for seeds beside it

std::size_t met(const Belief& belief) {
  std::size_t count = 0;
  for (const belief::Trace& trace : belief.history()) count += trace.contact;
  return count;
}

solver::PlannerOptions short_sighted(std::uint64_t seed) {
  solver::PlannerOptions options;
  options.solver = solver::Solver::rate;
  options.budget_seconds = std::numeric_limits<double>::infinity();
  options.budget_expansions = 1;
  options.seed = seed;
  return options;
}

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

/// Episodes at random true poses, and poses brought into agreement with what was felt up to their fourth contact, ...
std::vector<Row> poses(const std::string& name, const Options& options) {
  const auto scenario = scenario::load(TACTUS_SOURCE_DIR "/examples/scenarios/" + name + ".yaml");
  const auto model = scenario->model_of(belief::Kind::particles);
  std::array<Agreeing, std::size(contacts)> after, beside;
  for (std::uint64_t episode = 0; episode < episodes; ++episode) {
    support::Rng rng(options.seed + episode), rng_beside(support::mix(options.seed + episode));
    const geometry::Pose truth = model->task->scene().prior.sample(rng);
    simulation::World world(model, truth);
    Belief belief(model, model->task->scene().start);
    solver::Planner planner(model, short_sighted(options.seed + episode));
    for (std::size_t action = 0, next = 0; action < most_actions && next < std::size(contacts); ++action) {
      const solver::Answer answer = planner.query(belief);
      if (answer.kind != solver::Answer::Kind::action) break;
      belief.step(*answer.action, world.execute(*answer.action));
      if (!belief.history().back().contact || met(belief) != contacts[next]) continue;
      after[next].add(belief, seeds_of(belief, rng));
      beside[next++].add(belief, seeds_beside(belief, truth, rng_beside));
    }
  }
  std::vector<Row> rows;
  for (std::size_t i = 0; i < std::size(contacts); ++i) {
    if (after[i].tried == 0) continue;
    const std::string work = name + "-" + std::to_string(contacts[i]);
    rows.push_back(after[i].row(work));
    rows.push_back(beside[i].row(work + "-beside"));
  }
  return rows;
}

}  // namespace

std::vector<Work> pose_works() {
  std::vector<Work> works;
  for (const std::string name : {"shelf_3d", "base_4d", "sim_5d"})
    works.push_back({name, [name](const Options& options) { return poses(name, options); }});
  return works;
}

}  // namespace tactus::bench
