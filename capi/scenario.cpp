// SPDX-License-Identifier: BSD-3-Clause
#include "tactus/scenario.h"

#include <cmath>

#include "handles.hpp"

using namespace tactus;
using namespace tactus::capi;

namespace {

const DrawnBody& body_of(const tactus_scenario* scenario, std::size_t body) {
  const std::vector<DrawnBody>& bodies = required(scenario, "scenario").bodies;
  return bodies[index_below(bodies.size(), body, "body")];
}

const robot::Joint& joint_of(const tactus_scenario* scenario, std::size_t joint) {
  const std::vector<robot::Joint>& joints = required(scenario, "scenario").scene().robot->joints;
  return joints[index_below(joints.size(), joint, "joint")];
}

const belief::CellTables& tables_of(const tactus_scenario* scenario) {
  return *required(scenario, "scenario").contents->model->options.cells.tables;
}

/// Beliefs check what they are given themselves; drawing does not.
robot::JointVector finite_joints_from(const double* q, const robot::RobotModel& robot) {
  const robot::JointVector joints = joints_from(q, robot.dof(), "q");
  for (int j = 0; j < robot.dof(); ++j)
    if (!std::isfinite(joints[j]))
      reject("q[" + std::to_string(j) + "] (" + robot.joints[j].name + ")", "a value that is not finite",
             "a joint position");
  return joints;
}

std::string joined_lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

}  // namespace

// --- making one

tactus_status tactus_scenario_load(const char* path, tactus_scenario** scenario) noexcept {
  return guarded(__func__, [&] {
    tactus_scenario*& made = cleared(scenario, "scenario");
    made = new tactus_scenario(scenario::load(&required(path, "path")));
  });
}

tactus_status tactus_scenario_parse(const char* yaml, const char* base_dir, tactus_scenario** scenario) noexcept {
  return guarded(__func__, [&] {
    tactus_scenario*& made = cleared(scenario, "scenario");
    made = new tactus_scenario(scenario::parse(&required(yaml, "yaml"), &required(base_dir, "base_dir")));
  });
}

tactus_status tactus_scenario_check(const char* path, char* text, size_t capacity, size_t* count) noexcept {
  return guarded(__func__, [&] {
    required(count, "count");
    const std::string found = joined_lines(scenario::check(&required(path, "path")));
    if (char* out = room_for(found.size() + 1, text, capacity, count, "text"))
      std::memcpy(out, found.c_str(), found.size() + 1);
  });
}

void tactus_scenario_destroy(tactus_scenario* scenario) noexcept { delete scenario; }

// --- what it says

tactus_status tactus_scenario_name(const tactus_scenario* scenario, const char** name) noexcept {
  return guarded(__func__,
                 [&] { required(name, "name") = required(scenario, "scenario").contents->description.name.c_str(); });
}

tactus_status tactus_scenario_dof(const tactus_scenario* scenario, size_t* dof) noexcept {
  return guarded(__func__, [&] {
    required(dof, "dof") = static_cast<std::size_t>(required(scenario, "scenario").scene().robot->dof());
  });
}

tactus_status tactus_scenario_joint_name(const tactus_scenario* scenario, size_t joint, const char** name) noexcept {
  return guarded(__func__, [&] { required(name, "name") = joint_of(scenario, joint).name.c_str(); });
}

tactus_status tactus_scenario_joint_limits(const tactus_scenario* scenario, size_t joint, double* lower, double* upper,
                                           double* velocity) noexcept {
  return guarded(__func__, [&] {
    const robot::Joint& limits = joint_of(scenario, joint);
    required(lower, "lower"), required(upper, "upper"), required(velocity, "velocity");
    *lower = limits.lower, *upper = limits.upper, *velocity = limits.velocity;
  });
}

tactus_status tactus_scenario_start(const tactus_scenario* scenario, double* q, size_t capacity,
                                    size_t* count) noexcept {
  return guarded(__func__, [&] { give(required(scenario, "scenario").scene().start, q, capacity, count, "q"); });
}

tactus_status tactus_costs_init(tactus_costs* costs, size_t size) noexcept {
  return guarded(__func__, [&] { init_struct(costs, size, tactus_costs{}, "costs"); });
}

tactus_status tactus_limits_init(tactus_limits* limits, size_t size) noexcept {
  return guarded(__func__, [&] { init_struct(limits, size, tactus_limits{}, "limits"); });
}

tactus_status tactus_scenario_costs(const tactus_scenario* scenario, tactus_costs* costs) noexcept {
  return guarded(__func__, [&] {
    const action::CostWeights& cost = required(scenario, "scenario").contents->task->options().cost;
    write_struct(costs, tactus_costs{0, 0, cost.metre, cost.radian, cost.action}, "costs");
  });
}

tactus_status tactus_scenario_limits(const tactus_scenario* scenario, tactus_limits* limits) noexcept {
  return guarded(__func__, [&] {
    const scenario::LimitsDescription& given = required(scenario, "scenario").contents->description.limits;
    write_struct(limits, tactus_limits{0, given.actions, given.travel, given.seconds}, "limits");
  });
}

// --- poses

tactus_status tactus_scenario_sample_pose(const tactus_scenario* scenario, uint64_t seed, double pose[7]) noexcept {
  return guarded(__func__, [&] {
    support::Rng rng(seed);
    write_pose(required(scenario, "scenario").scene().prior.sample(rng), &required(pose, "pose"));
  });
}

tactus_status tactus_pose_from_rpy(const double xyzrpy[6], double pose[7]) noexcept {
  return guarded(__func__, [&] {
    geometry::PoseVector v;
    std::copy_n(&required(xyzrpy, "xyzrpy"), v.size(), v.begin());
    for (std::size_t i = 0; i < v.size(); ++i)
      if (!std::isfinite(v[i])) reject("xyzrpy[" + std::to_string(i) + "]", "a value that is not finite", "a number");
    write_pose(geometry::pose_from(v), &required(pose, "pose"));
  });
}

// --- keeping what was worked out

tactus_status tactus_scenario_save_tables(const tactus_scenario* scenario, uint8_t* bytes, size_t capacity,
                                          size_t* count) noexcept {
  return guarded(__func__, [&] { give(tables_of(scenario).save(), bytes, capacity, count, "bytes"); });
}

tactus_status tactus_scenario_restore_tables(const tactus_scenario* scenario, const uint8_t* bytes,
                                             size_t size) noexcept {
  return guarded(__func__, [&] { tables_of(scenario).restore(&required(bytes, "bytes"), size); });
}

// --- what to draw

tactus_status tactus_scenario_body_count(const tactus_scenario* scenario, size_t* count) noexcept {
  return guarded(__func__, [&] { required(count, "count") = required(scenario, "scenario").bodies.size(); });
}

tactus_status tactus_scenario_body_name(const tactus_scenario* scenario, size_t body, const char** name) noexcept {
  return guarded(__func__, [&] { required(name, "name") = body_of(scenario, body).name.c_str(); });
}

tactus_status tactus_scenario_body_kind(const tactus_scenario* scenario, size_t body, tactus_body_kind* kind) noexcept {
  return guarded(__func__, [&] { required(kind, "kind") = body_of(scenario, body).kind; });
}

tactus_status tactus_scenario_body_vertices(const tactus_scenario* scenario, size_t body, double* vertices,
                                            size_t capacity, size_t* count) noexcept {
  return guarded(__func__, [&] {
    const geometry::Mesh& mesh = body_of(scenario, body).mesh;
    if (double* out = room_for(mesh.vertices.size(), vertices, capacity, count, "vertices"))
      for (const geometry::Vector3& vertex : mesh.vertices) out = std::copy_n(vertex.data(), 3, out);
  });
}

tactus_status tactus_scenario_body_triangles(const tactus_scenario* scenario, size_t body, int32_t* triangles,
                                             size_t capacity, size_t* count) noexcept {
  return guarded(__func__, [&] {
    const geometry::Mesh& mesh = body_of(scenario, body).mesh;
    if (int32_t* out = room_for(mesh.triangles.size(), triangles, capacity, count, "triangles"))
      for (const geometry::Triangle& triangle : mesh.triangles) out = std::copy_n(triangle.data(), 3, out);
  });
}

tactus_status tactus_scenario_body_poses(const tactus_scenario* scenario, const double* q, const double target_pose[7],
                                         double* poses, size_t capacity, size_t* count) noexcept {
  return guarded(__func__, [&] {
    const robot::RobotModel& robot = *required(scenario, "scenario").scene().robot;
    const auto placed =
        body_poses(scenario->bodies, robot, finite_joints_from(q, robot), capi::pose_from(target_pose, "target_pose"));
    if (double* out = room_for(placed.size(), poses, capacity, count, "poses"))
      for (std::size_t b = 0; b < placed.size(); ++b) write_pose(placed[b], out + 7 * b);
  });
}
