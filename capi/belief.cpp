// SPDX-License-Identifier: BSD-3-Clause
#include "tactus/belief.h"

#include "belief/modes.hpp"
#include "handles.hpp"
#include "solver/forecast.hpp"

using namespace tactus;
using namespace tactus::capi;

namespace {

static_assert(TACTUS_BELIEF_HIERARCHICAL == static_cast<int>(belief::Kind::hierarchical) &&
              TACTUS_BELIEF_PARTICLES == static_cast<int>(belief::Kind::particles));
static_assert(TACTUS_PHASE_VOXELS == static_cast<int>(belief::Phase::voxels) &&
              TACTUS_PHASE_POSES == static_cast<int>(belief::Phase::poses));
static_assert(TACTUS_HEALTH_GOOD == static_cast<int>(belief::Health::good) &&
              TACTUS_HEALTH_CONTRADICTED == static_cast<int>(belief::Health::contradicted));
static_assert(TACTUS_LIKELIHOOD_PAPER == static_cast<int>(belief::Likelihood::paper) &&
              TACTUS_LIKELIHOOD_CALIBRATED == static_cast<int>(belief::Likelihood::calibrated));

tactus_belief_options options_of(belief::Kind kind) { return {0, static_cast<tactus_belief_kind>(kind)}; }

belief::Kind kind_from(const tactus_belief_options& options) {
  if (options.kind != TACTUS_BELIEF_HIERARCHICAL && options.kind != TACTUS_BELIEF_PARTICLES)
    reject("options.kind", std::to_string(options.kind), "TACTUS_BELIEF_HIERARCHICAL or TACTUS_BELIEF_PARTICLES");
  return static_cast<belief::Kind>(options.kind);
}

belief::Likelihood likelihood_from(tactus_likelihood likelihood) {
  if (likelihood != TACTUS_LIKELIHOOD_PAPER && likelihood != TACTUS_LIKELIHOOD_CALIBRATED)
    reject("likelihood", std::to_string(likelihood), "TACTUS_LIKELIHOOD_PAPER or TACTUS_LIKELIHOOD_CALIBRATED");
  return static_cast<belief::Likelihood>(likelihood);
}

tactus_summary summary_of(const belief::Summary& from) {
  tactus_summary summary{};
  summary.phase = static_cast<int32_t>(from.phase);
  summary.health = static_cast<int32_t>(from.health);
  summary.doubted = static_cast<uint32_t>(from.doubted);
  summary.observations = from.observations;
  summary.contacts = from.contacts;
  summary.possibly_occupied = from.possibly_occupied;
  summary.volume = from.volume;
  summary.cells = from.cells;
  summary.bits = from.bits;
  std::copy(from.mean.begin(), from.mean.end(), summary.mean);
  std::copy(from.extent.begin(), from.extent.end(), summary.extent);
  std::copy(from.covariance.begin(), from.covariance.end(), summary.covariance);
  return summary;
}

/// Saved bytes do not say of which kind the belief is: the one that they fit.
belief::Belief restored(const scenario::Scenario& scenario, const uint8_t* bytes, std::size_t size) {
  try {
    return belief::Belief::restore(scenario.model_of(belief::Kind::hierarchical), bytes, size);
  } catch (const Error& error) {
    if (error.status() != Status::wrong_scenario) throw;
    return belief::Belief::restore(scenario.model_of(belief::Kind::particles), bytes, size);
  }
}

/// Holds a belief for one call.
struct Held {
  explicit Held(const tactus_belief* handle)
      : use(required(handle, "belief").in_use, "belief"), belief(handle->belief) {}

  Use use;
  const belief::Belief& belief;
};

}  // namespace

tactus_status tactus_belief_options_init(tactus_belief_options* options, size_t size) noexcept {
  return guarded(__func__, [&] { init_struct(options, size, options_of(belief::Options{}.kind), "options"); });
}

tactus_status tactus_scenario_belief_options(const tactus_scenario* scenario, tactus_belief_options* options) noexcept {
  return guarded(__func__, [&] {
    write_struct(options, options_of(required(scenario, "scenario").contents->model->options.kind), "options");
  });
}

tactus_status tactus_belief_create(const tactus_scenario* scenario, const tactus_belief_options* options,
                                   const double* q, tactus_belief** belief) noexcept {
  return guarded(__func__, [&] {
    tactus_belief*& made = cleared(belief, "belief");
    const ScenarioPtr& contents = required(scenario, "scenario").contents;
    const robot::JointVector configuration = joints_from(q, dof(contents), "q");
    tactus_belief_options chosen = options_of(contents->model->options.kind);
    if (options != nullptr) chosen = read_struct(options, chosen, "options");
    made = new tactus_belief(contents, {contents->model_of(kind_from(chosen)), configuration});
  });
}

tactus_status tactus_belief_clone(const tactus_belief* belief, tactus_belief** clone) noexcept {
  return guarded(__func__, [&] {
    tactus_belief*& made = cleared(clone, "clone");
    const Held held(belief);
    made = new tactus_belief(belief->scenario, held.belief);
  });
}

void tactus_belief_destroy(tactus_belief* belief) noexcept { delete belief; }

// --- what happens to it

tactus_status tactus_belief_step(tactus_belief* belief, const tactus_action* action,
                                 const tactus_observation* observation) noexcept {
  return guarded(__func__, [&] {
    const Held held(belief);
    check_same(belief->scenario, required(action, "action").scenario, "action");
    belief->belief.step(*action->action, observation_from(observation, dof(belief->scenario)));
  });
}

tactus_status tactus_belief_set_configuration(tactus_belief* belief, const double* q) noexcept {
  return guarded(__func__, [&] {
    const Held held(belief);
    belief->belief.set_configuration(joints_from(q, dof(belief->scenario), "q"));
  });
}

// --- what it says

tactus_status tactus_belief_configuration(const tactus_belief* belief, double* q, size_t capacity,
                                          size_t* count) noexcept {
  return guarded(__func__, [&] { give(Held(belief).belief.configuration(), q, capacity, count, "q"); });
}

tactus_status tactus_summary_init(tactus_summary* summary, size_t size) noexcept {
  return guarded(__func__, [&] { init_struct(summary, size, tactus_summary{}, "summary"); });
}

tactus_status tactus_belief_summary(const tactus_belief* belief, tactus_summary* summary) noexcept {
  return guarded(__func__, [&] {
    const Held held(belief);
    required(summary, "summary");
    write_struct(summary, summary_of(held.belief.summary()), "summary");
  });
}

tactus_status tactus_belief_voxels(const tactus_belief* belief, double* centres, size_t capacity,
                                   size_t* count) noexcept {
  return guarded(__func__, [&] {
    const Held held(belief);
    const bool any = held.belief.phase() == belief::Phase::voxels;
    const std::size_t rows = any ? held.belief.voxels().possibly_occupied().count() : 0;
    double* out = room_for(rows, centres, capacity, count, "centres");
    if (out == nullptr || !any) return;
    held.belief.voxels().possibly_occupied().for_each(
        [&](std::size_t v) { out = std::copy_n(held.belief.voxels().model().grid.centre(v).data(), 3, out); });
  });
}

tactus_status tactus_belief_poses(const tactus_belief* belief, double* poses, size_t capacity, size_t* count) noexcept {
  return guarded(__func__, [&] {
    const Held held(belief);
    const bool any = held.belief.phase() == belief::Phase::poses;
    const std::size_t rows = any ? held.belief.cells().size() : 0;
    double* out = room_for(rows, poses, capacity, count, "poses");
    if (out == nullptr || !any) return;
    held.belief.cells().for_each([&](const belief::Cell& cell) {
      write_pose(geometry::pose_from(cell.centre), out);
      out += 7;
    });
  });
}

tactus_status tactus_belief_modes(const tactus_belief* belief, double* modes, size_t capacity, size_t* count) noexcept {
  return guarded(__func__, [&] {
    const Held held(belief);
    std::vector<belief::Mode> found;
    if (held.belief.phase() == belief::Phase::poses)
      found = belief::modes_of(held.belief.cells(), held.belief.task().scene().prior);
    double* out = room_for(found.size(), modes, capacity, count, "modes");
    if (out == nullptr) return;
    for (const belief::Mode& mode : found) {
      *out++ = mode.mass;
      out = std::copy(mode.mean.begin(), mode.mean.end(), out);
      out = std::copy(mode.extent.begin(), mode.extent.end(), out);
    }
  });
}

tactus_status tactus_belief_history(const tactus_belief* belief, int32_t* events, size_t capacity,
                                    size_t* count) noexcept {
  return guarded(__func__, [&] {
    const Held held(belief);
    int32_t* out = room_for(held.belief.history().size(), events, capacity, count, "events");
    if (out == nullptr) return;
    for (const belief::Trace& trace : held.belief.history()) {
      *out++ = static_cast<int32_t>(trace.kind);
      *out++ = trace.contact ? 1 : 0;
      *out++ = trace.doubted ? 1 : 0;
    }
  });
}

tactus_status tactus_belief_stops(const tactus_belief* belief, double* joints, size_t capacity,
                                  size_t* count) noexcept {
  return guarded(__func__, [&] {
    const Held held(belief);
    double* out = room_for(held.belief.history().size(), joints, capacity, count, "joints");
    if (out == nullptr) return;
    for (const belief::Trace& trace : held.belief.history())
      out = std::copy_n(trace.path.back().data(), trace.path.back().size(), out);
  });
}

tactus_status tactus_belief_is_goal(const tactus_belief* belief, int32_t* goal) noexcept {
  return guarded(__func__, [&] {
    const Held held(belief);
    required(goal, "goal") = held.belief.is_goal() ? 1 : 0;
  });
}

tactus_status tactus_belief_contains(const tactus_belief* belief, const double pose[7], int32_t* contained) noexcept {
  return guarded(__func__, [&] {
    const Held held(belief);
    required(contained, "contained") = held.belief.contains(capi::pose_from(pose, "pose")) ? 1 : 0;
  });
}

tactus_status tactus_belief_forecast(const tactus_belief* belief, const tactus_action* action,
                                     tactus_likelihood likelihood, uint64_t seed, double* probabilities,
                                     size_t capacity, size_t* count) noexcept {
  return guarded(__func__, [&] {
    const Held held(belief);
    check_same(belief->scenario, required(action, "action").scenario, "action");
    const belief::Likelihood chosen = likelihood_from(likelihood);
    double* out = room_for(action->action->path.size() + 1, probabilities, capacity, count, "probabilities");
    if (out == nullptr) return;
    support::Rng rng(seed);
    const std::vector<double> forecast = solver::forecast(held.belief, *action->action, chosen, rng);
    std::copy(forecast.begin(), forecast.end(), out);
  });
}

// --- keeping it

tactus_status tactus_belief_save(const tactus_belief* belief, uint8_t* bytes, size_t capacity, size_t* count) noexcept {
  return guarded(__func__, [&] { give(Held(belief).belief.save(), bytes, capacity, count, "bytes"); });
}

tactus_status tactus_belief_restore(const tactus_scenario* scenario, const uint8_t* bytes, size_t size,
                                    tactus_belief** belief) noexcept {
  return guarded(__func__, [&] {
    tactus_belief*& made = cleared(belief, "belief");
    const ScenarioPtr& contents = required(scenario, "scenario").contents;
    made = new tactus_belief(contents, restored(*contents, &required(bytes, "bytes"), size));
  });
}
