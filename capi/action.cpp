// SPDX-License-Identifier: BSD-3-Clause
#include "tactus/action.h"

#include "action/archive.hpp"
#include "handles.hpp"

using namespace tactus;
using namespace tactus::capi;

namespace {

using action::Kind;

constexpr struct {
  Kind in_core;
  tactus_action_kind value;
  const char* name;
} kinds[] = {
    {Kind::move, TACTUS_ACTION_MOVE, "move"},
    {Kind::turn, TACTUS_ACTION_TURN, "turn"},
    {Kind::sweep, TACTUS_ACTION_SWEEP, "sweep"},
    {Kind::poke, TACTUS_ACTION_POKE, "poke"},
    {Kind::insertion, TACTUS_ACTION_INSERTION, "insertion"},
};

constexpr bool values_agree() {
  for (const auto& kind : kinds)
    if (static_cast<tactus_action_kind>(kind.in_core) != kind.value) return false;
  return true;
}
static_assert(values_agree(), "the kinds of include/tactus/action.h are those of libcore/action/motion.hpp");

const action::Action& contents(const tactus_action* action) { return *required(action, "action").action; }

tactus_action_properties properties_of(const action::Action& action) {
  tactus_action_properties properties{};
  properties.kind = static_cast<tactus_action_kind>(action.kind);
  properties.id = action.id;
  properties.waypoints = action.path.size();
  properties.length = action.length;
  properties.duration = action.times.back();
  properties.full_cost = action.full_cost;
  properties.expected_cost = action.expected_cost;
  properties.contact_probability = action.contact_probability;
  return properties;
}

}  // namespace

belief::Observation capi::observation_from(const tactus_observation* observation, int dof) {
  const tactus_observation given = read_struct(observation, tactus_observation{}, "observation");
  if (given.contact != 0 && given.contact != 1) reject("observation.contact", std::to_string(given.contact), "0 or 1");
  if (given.joint_count != static_cast<std::uint64_t>(dof))
    reject("observation.joint_count", std::to_string(given.joint_count), std::to_string(dof));
  return {given.contact == 1, joints_from(given.joints, dof, "observation.joints")};
}

const char* tactus_action_kind_name(tactus_action_kind kind) noexcept {
  for (const auto& known : kinds)
    if (known.value == kind) return known.name;
  return "unknown";
}

tactus_status tactus_observation_init(tactus_observation* observation, size_t size) noexcept {
  return guarded(__func__, [&] { init_struct(observation, size, tactus_observation{}, "observation"); });
}

tactus_status tactus_action_properties_init(tactus_action_properties* properties, size_t size) noexcept {
  return guarded(__func__, [&] { init_struct(properties, size, tactus_action_properties{}, "properties"); });
}

tactus_status tactus_action_info(const tactus_action* action, tactus_action_properties* properties) noexcept {
  return guarded(__func__, [&] { write_struct(properties, properties_of(contents(action)), "properties"); });
}

tactus_status tactus_action_waypoints(const tactus_action* action, double* waypoints, size_t capacity,
                                      size_t* count) noexcept {
  return guarded(__func__, [&] {
    const motion::JointPath& path = contents(action).path;
    if (double* out = room_for(path.size(), waypoints, capacity, count, "waypoints"))
      for (const robot::JointVector& q : path) out = std::copy(q.begin(), q.end(), out);
  });
}

tactus_status tactus_action_times(const tactus_action* action, double* times, size_t capacity, size_t* count) noexcept {
  return guarded(__func__, [&] { give(contents(action).times, times, capacity, count, "times"); });
}

tactus_status tactus_action_retreat(const tactus_action* action, const tactus_observation* observation,
                                    size_t* waypoint) noexcept {
  return guarded(__func__, [&] {
    const action::Task& task = *required(action, "action").scenario->task;
    required(waypoint, "waypoint");
    *waypoint = belief::locate(task, contents(action), observation_from(observation, dof(action->scenario))).last_free;
  });
}

tactus_status tactus_action_save(const tactus_action* action, uint8_t* bytes, size_t capacity, size_t* count) noexcept {
  return guarded(__func__, [&] {
    give(action::save(*required(action, "action").scenario->task, contents(action)), bytes, capacity, count, "bytes");
  });
}

tactus_status tactus_action_restore(const tactus_scenario* scenario, const uint8_t* bytes, size_t size,
                                    tactus_action** action) noexcept {
  return guarded(__func__, [&] {
    tactus_action*& made = cleared(action, "action");
    const ScenarioPtr& contents = required(scenario, "scenario").contents;
    auto restored =
        std::make_shared<const action::Action>(action::restore(*contents->task, &required(bytes, "bytes"), size));
    made = new tactus_action{contents, std::move(restored)};
  });
}

void tactus_action_destroy(tactus_action* action) noexcept { delete action; }
