// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>

#include "belief/plain_world.hpp"
#include "solver/planner.hpp"

/// Small tasks of both kinds of belief, and planners with a counted budget for them.
namespace tactus::test {

using belief::Belief;
using belief::Kind;
using solver::Answer;
using solver::Planner;
using solver::PlannerOptions;
using solver::Solver;
using support::Rng;
using Model = std::shared_ptr<const belief::Model>;

inline constexpr std::array solvers{Solver::rtdp_bel, Solver::rtdp_inad, Solver::rtdp_ad, Solver::brtdp_bel,
                                    Solver::tbl,      Solver::frontier,  Solver::rate};

constexpr double infinity = std::numeric_limits<double>::infinity();

inline const std::shared_ptr<const action::Task>& task() {
  static const auto made = small_task({.roll_width = 0.2, .position_width = 0.04});
  return made;
}

inline Model made_model(Kind kind, std::size_t delta = 0) {
  belief::Options options;
  options.kind = kind;
  options.voxel_size = 0.005;
  options.delta = delta;
  options.cells.most = 300;
  options.particles = 40;
  return std::make_shared<const belief::Model>(task(), options);
}

inline const Model& model(Kind kind) {
  static const Model voxels_first = made_model(Kind::hierarchical), poses = made_model(Kind::particles);
  return kind == Kind::hierarchical ? voxels_first : poses;
}

inline PlannerOptions within(std::uint64_t expansions, Solver solver = Solver::rtdp_bel) {
  return {.solver = solver, .budget_seconds = infinity, .budget_expansions = expansions};
}

/// A hidden target, a belief of cells from the first, and a planner.
struct Trial {
  Trial(std::uint64_t seed, const PlannerOptions& options)
      : world(*task(), drawn(seed)),
        belief(model(Kind::particles), task()->scene().start),
        planner(model(Kind::particles), options) {}
  PlainWorld world;
  Belief belief;
  Planner planner;

 private:
  static Pose drawn(std::uint64_t seed) {
    Rng rng(seed);
    return task()->scene().prior.sample(rng);
  }
};

}  // namespace tactus::test
