// SPDX-License-Identifier: BSD-3-Clause
#include "tactus/instance.h"

#include <limits>

#include "handles.hpp"
#include "solver/evaluation.hpp"
#include "solver/exact.hpp"
#include "solver/pomdp_file.hpp"
#include "solver/sampled_instance.hpp"

using namespace tactus;
using namespace tactus::capi;

namespace {

constexpr std::uint64_t default_seed = 1;

tactus_instance_options options_of(const solver::SampleOptions& from) {
  return {0,
          static_cast<uint32_t>(from.poses),
          static_cast<uint32_t>(from.configurations),
          static_cast<uint32_t>(from.motions),
          from.discount,
          default_seed};
}

tactus_evaluation evaluation_of(const solver::Evaluation& from) {
  return {0,          0,          from.expected_cost, from.worst_cost, from.inserted, from.lower_bound,
          from.value, from.plans, from.expansions};
}

std::string exported(const solver::Instance& instance, int32_t format) {
  if (format == TACTUS_FORMAT_POMDPX) return solver::pomdpx(instance);
  if (format == TACTUS_FORMAT_POMDP) return solver::pomdp(instance);
  reject("format", std::to_string(format), "one of TACTUS_FORMAT_*");
}

}  // namespace

tactus_status tactus_instance_options_init(tactus_instance_options* options, size_t size) noexcept {
  return guarded(__func__, [&] { init_struct(options, size, options_of({}), "options"); });
}

tactus_status tactus_instance_create(const tactus_scenario* scenario, const tactus_instance_options* options,
                                     tactus_instance** instance) noexcept {
  return guarded(__func__, [&] {
    tactus_instance*& made = cleared(instance, "instance");
    const ScenarioPtr& contents = required(scenario, "scenario").contents;
    tactus_instance_options chosen = options_of({});
    if (options != nullptr) chosen = read_struct(options, chosen, "options");
    support::Rng rng(chosen.seed);
    solver::Instance drawn = solver::sampled_instance(
        *contents->task, {chosen.poses, chosen.configurations, chosen.motions, chosen.discount}, rng);
    drawn.name = contents->description.name;
    made = new tactus_instance{contents, std::make_shared<const solver::Instance>(std::move(drawn))};
  });
}

void tactus_instance_destroy(tactus_instance* instance) noexcept { delete instance; }

tactus_status tactus_instance_size(const tactus_instance* instance, size_t* poses, size_t* configurations,
                                   size_t* motions) noexcept {
  return guarded(__func__, [&] {
    const solver::Instance& is = *required(instance, "instance").instance;
    required(poses, "poses"), required(configurations, "configurations"), required(motions, "motions");
    *poses = is.weight.size(), *configurations = is.configurations.size(), *motions = is.motions.size();
  });
}

tactus_status tactus_instance_export(const tactus_instance* instance, int32_t format, char* text, size_t capacity,
                                     size_t* count) noexcept {
  return guarded(__func__, [&] {
    required(count, "count");
    const std::string made = exported(*required(instance, "instance").instance, format);
    if (char* out = room_for(made.size() + 1, text, capacity, count, "text"))
      std::memcpy(out, made.c_str(), made.size() + 1);
  });
}

tactus_status tactus_evaluation_init(tactus_evaluation* evaluation, size_t size) noexcept {
  return guarded(__func__, [&] { init_struct(evaluation, size, tactus_evaluation{}, "evaluation"); });
}

tactus_status tactus_instance_evaluate(const tactus_instance* instance, const tactus_planner_options* options,
                                       tactus_evaluation* evaluation) noexcept {
  return guarded(__func__, [&] {
    checked_size(required(evaluation, "evaluation").struct_size, "evaluation");
    const solver::PlannerOptions chosen = planner_options(options, required(instance, "instance").scenario->planner);
    write_struct(evaluation, evaluation_of(solver::evaluate(instance->instance, chosen)), "evaluation");
  });
}

tactus_status tactus_instance_optimum(const tactus_instance* instance, uint64_t most_beliefs, double* optimum,
                                      uint64_t* beliefs) noexcept {
  return guarded(__func__, [&] {
    required(optimum, "optimum"), required(beliefs, "beliefs");
    const solver::InstancePtr& is = required(instance, "instance").instance;
    solver::ExactSolver exact(is, is->discount, most_beliefs);
    const auto value = exact.value(0, support::Bitset(is->weight.size(), true));
    *optimum = value.value_or(std::numeric_limits<double>::quiet_NaN());
    *beliefs = exact.beliefs();
  });
}

tactus_status tactus_instance_bounds(const tactus_instance* instance, uint64_t most_beliefs, double* informed,
                                     double* pairs) noexcept {
  return guarded(__func__, [&] {
    required(informed, "informed"), required(pairs, "pairs");
    const solver::InstancePtr& is = required(instance, "instance").instance;
    solver::ExactSolver exact(is, is->discount, most_beliefs);
    const support::Bitset all(is->weight.size(), true);
    const auto bound = exact.lower_bound(0, all);
    *informed = exact.informed(0, all);
    *pairs = bound.value_or(std::numeric_limits<double>::quiet_NaN());
  });
}
