// SPDX-License-Identifier: BSD-3-Clause
#include "tactus/world.h"

#include "handles.hpp"

using namespace tactus;
using namespace tactus::capi;

namespace {

tactus_world_options options_of(const simulation::WorldOptions& from) {
  constexpr double as_the_scenario_says = -1.0;
  return {0,
          static_cast<int32_t>(from.fineness),
          from.seed,
          as_the_scenario_says,
          as_the_scenario_says,
          as_the_scenario_says,
          as_the_scenario_says};
}

/// What `given` says over what the scenario does.
action::Sensing sensing_from(const tactus_world_options& given, const action::Sensing& scenario) {
  const auto chosen = [](double wish, double otherwise) { return wish < 0.0 ? otherwise : wish; };
  return {chosen(given.stopping_distance, scenario.stopping_distance),
          chosen(given.encoder_error, scenario.encoder_error), chosen(given.missed_contacts, scenario.missed_contacts),
          chosen(given.false_contacts, scenario.false_contacts)};
}

simulation::WorldOptions options_from(const tactus_world_options& given, const action::Sensing& scenario) {
  if (given.fineness < 1) reject("options.fineness", std::to_string(given.fineness), "1 or more");
  return {static_cast<double>(given.fineness), sensing_from(given, scenario), given.seed};
}

/// Checks that `observation` has room for the joints, before anything moves.
double* joints_of(const tactus_observation* observation, std::size_t dof) {
  const tactus_observation given = read_struct(observation, tactus_observation{}, "observation");
  if (given.joint_count < dof)
    throw Error(Status::buffer_too_small, "observation.joint_count: found " + std::to_string(given.joint_count) +
                                              ", expected " + std::to_string(dof));
  return &required(given.joints, "observation.joints");
}

/// Holds a world for one call.
struct Held {
  explicit Held(const tactus_world* handle) : use(required(handle, "world").in_use, "world"), world(handle->world) {}

  Use use;
  const simulation::World& world;
};

}  // namespace

tactus_status tactus_world_options_init(tactus_world_options* options, size_t size) noexcept {
  return guarded(__func__, [&] { init_struct(options, size, options_of({}), "options"); });
}

tactus_status tactus_world_create(const tactus_scenario* scenario, const double true_pose[7],
                                  const tactus_world_options* options, tactus_world** world) noexcept {
  return guarded(__func__, [&] {
    tactus_world*& made = cleared(world, "world");
    tactus_world_options chosen = options_of({});
    if (options != nullptr) chosen = read_struct(options, chosen, "options");
    const ScenarioPtr& contents = required(scenario, "scenario").contents;
    made = new tactus_world(contents, capi::pose_from(true_pose, "true_pose"),
                            options_from(chosen, contents->task->options().sensing));
  });
}

void tactus_world_destroy(tactus_world* world) noexcept { delete world; }

tactus_status tactus_world_execute(tactus_world* world, const tactus_action* action,
                                   tactus_observation* observation) noexcept {
  return guarded(__func__, [&] {
    const Held held(world);
    check_same(world->scenario, required(action, "action").scenario, "action");
    double* joints = joints_of(observation, static_cast<std::size_t>(dof(world->scenario)));
    const belief::Observation seen = world->world.execute(*action->action);
    std::copy(seen.q.begin(), seen.q.end(), joints);
    observation->contact = seen.contact ? 1 : 0;
    observation->joint_count = static_cast<std::uint64_t>(seen.q.size());
  });
}

tactus_status tactus_world_inserted(const tactus_world* world, int32_t* inserted) noexcept {
  return guarded(__func__, [&] {
    const Held held(world);
    required(inserted, "inserted") = held.world.inserted() ? 1 : 0;
  });
}

tactus_status tactus_world_travelled(const tactus_world* world, double* metres, double* radians) noexcept {
  return guarded(__func__, [&] {
    const Held held(world);
    required(metres, "metres"), required(radians, "radians");
    *metres = held.world.travelled().metres, *radians = held.world.travelled().radians;
  });
}

tactus_status tactus_world_true_pose(const tactus_world* world, double pose[7]) noexcept {
  return guarded(__func__, [&] {
    const Held held(world);
    write_pose(held.world.base_from_target(), &required(pose, "pose"));
  });
}
