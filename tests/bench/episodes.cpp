// SPDX-License-Identifier: BSD-3-Clause
#include "bench/episodes.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "scenario/scenario.hpp"
#include "simulation/world.hpp"

namespace tactus::bench {
namespace {

using belief::Belief;

constexpr std::uint64_t episodes = 3;
constexpr std::size_t most_actions = 60;

std::size_t met(const Belief& belief) {
  return static_cast<std::size_t>(std::count_if(belief.history().begin(), belief.history().end(),
                                                [](const belief::Trace& trace) { return trace.contact; }));
}

solver::PlannerOptions short_sighted(std::uint64_t seed) {
  solver::PlannerOptions options;
  options.solver = solver::Solver::rate;
  options.budget_seconds = std::numeric_limits<double>::infinity();
  options.budget_expansions = 1;
  options.seed = seed;
  return options;
}

}  // namespace

std::shared_ptr<const belief::Model> model_of(const std::string& scenario) {
  return scenario::load(TACTUS_SOURCE_DIR "/examples/scenarios/" + scenario + ".yaml")
      ->model_of(belief::Kind::particles);
}

void for_each_state(const std::shared_ptr<const belief::Model>& model, std::uint64_t seed,
                    const std::function<void(const State&, support::Rng&)>& visit) {
  for (std::uint64_t episode = 0; episode < episodes; ++episode) {
    support::Rng rng(seed + episode);
    const geometry::Pose truth = model->task->scene().prior.sample(rng);
    simulation::World world(model, truth);
    Belief belief(model, model->task->scene().start);
    solver::Planner planner(model, short_sighted(seed + episode));
    for (std::size_t action = 0, next = 0; action < most_actions && next < std::size(contacts_looked_at); ++action) {
      const solver::Answer answer = planner.query(belief);
      if (answer.kind != solver::Answer::Kind::action) break;
      belief.step(*answer.action, world.execute(*answer.action));
      if (!belief.history().back().contact || met(belief) != contacts_looked_at[next]) continue;
      visit({belief, truth, contacts_looked_at[next++], episode}, rng);
    }
  }
}

}  // namespace tactus::bench
