// SPDX-License-Identifier: BSD-3-Clause
#include "action/archive.hpp"

#include <algorithm>
#include <numbers>

#include "action/fingerprint.hpp"
#include "support/error.hpp"

namespace tactus::action {
namespace {

using support::ByteReader;
using support::ByteWriter;

constexpr support::Seal seal{{'T', 'A', 'C', 'T', 'U', 'S', '-', 'A'}, 3};

/// rad or m that a joint may go between waypoints: paths are looked at in fine steps.
constexpr double longest_step = 2.0 * std::numbers::pi;

std::uint64_t fingerprint(const Task& task) {
  Fingerprint print;
  print.add(task.scene());
  return print.sum();
}

void write_pose(ByteWriter& to, const Pose& pose) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) to.f64(pose.matrix()(row, column));
}

Pose read_pose(ByteReader& from, const char* field) {
  Pose pose = Pose::Identity();
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) pose.matrix()(row, column) = from.finite(field);
  const Eigen::Matrix3d off = pose.linear().transpose() * pose.linear() - Eigen::Matrix3d::Identity();
  if (!(off.cwiseAbs().maxCoeff() < 1e-6 && pose.linear().determinant() > 0.0))
    from.fail(field, "a matrix that is no rotation", "a rigid motion");
  return pose;
}

std::vector<double> read_times(ByteReader& from, std::size_t count) {
  std::vector<double> times;
  for (std::size_t i = 0; i < count; ++i) {
    times.push_back(from.finite("times"));
    if (times[i] < (i == 0 ? 0.0 : times[i - 1]))
      from.fail("times", std::to_string(times[i]) + " s at waypoint " + std::to_string(i),
                "times that do not run back");
  }
  return times;
}

double read_amount(ByteReader& from, const char* field) {
  const double value = from.finite(field);
  if (value < 0.0) from.fail(field, std::to_string(value), "a number that is not negative");
  return value;
}

}  // namespace

void write_joints(ByteWriter& to, const JointVector& q) {
  for (const double value : q) to.f64(value);
}

void write_path(ByteWriter& to, const JointPath& path) {
  to.u64(path.size());
  for (const JointVector& q : path) write_joints(to, q);
}

JointVector read_joints(ByteReader& from, int dof, const char* field) {
  JointVector q(dof);
  for (double& value : q) value = from.finite(field);
  return q;
}

JointPath read_path(ByteReader& from, int dof, std::size_t least, const char* field) {
  const std::size_t count = from.count(8 * static_cast<std::size_t>(std::max(1, dof)), field);
  if (count < least) from.fail(field, std::to_string(count) + " waypoints", "at least " + std::to_string(least));
  JointPath path;
  for (std::size_t i = 0; i < count; ++i) {
    path.push_back(read_joints(from, dof, field));
    if (i > 0 && (path[i] - path[i - 1]).cwiseAbs().maxCoeff() > longest_step)
      from.fail(field,
                "a joint that goes more than a whole turn, or that many metres, at waypoint " + std::to_string(i),
                "neighbours close to each other");
  }
  return path;
}

Kind read_kind(ByteReader& from, const char* field) {
  const std::uint32_t value = from.u32(field);
  if (value < static_cast<std::uint32_t>(Kind::move) || value > static_cast<std::uint32_t>(Kind::insertion))
    from.fail(field, std::to_string(value), "a kind of action");
  return static_cast<Kind>(value);
}

void write_sensing(ByteWriter& to, const Sensing& sensing) {
  for (const double value :
       {sensing.stopping_distance, sensing.encoder_error, sensing.missed_contacts, sensing.false_contacts})
    to.f64(value);
}

Sensing read_sensing(ByteReader& from, const char* field) {
  Sensing sensing;
  for (double* value :
       {&sensing.stopping_distance, &sensing.encoder_error, &sensing.missed_contacts, &sensing.false_contacts})
    *value = read_amount(from, field);
  return sensing;
}

std::vector<std::uint8_t> save(const Task& task, const Action& action) {
  ByteWriter to(seal);
  to.u64(fingerprint(task));
  to.u32(static_cast<std::uint32_t>(action.kind));
  write_path(to, action.path);
  for (const double time : action.times) to.f64(time);
  to.u64(action.lead);
  for (const double value : {action.length, action.full_cost, action.expected_cost, action.contact_probability})
    to.f64(value);
  write_sensing(to, action.sensing);
  write_pose(to, action.supposed_target);
  return to.sealed();
}

Action restore(const Task& task, const std::uint8_t* bytes, std::size_t size) {
  ByteReader from(seal, "saved action", bytes, size);
  const int dof = task.scene().robot->dof();
  if (from.u64("fingerprint") != fingerprint(task))
    throw support::Error(
        support::Status::wrong_scenario,
        "saved action: found one of another scenario, expected the same target, seats, tolerances, tool, "
        "world and joints");
  Action action;
  action.kind = read_kind(from, "kind");
  action.path = read_path(from, dof, 1, "path");
  action.times = read_times(from, action.path.size());
  action.lead = static_cast<std::size_t>(from.u64("lead"));
  if (action.lead >= action.path.size())
    from.fail("lead", std::to_string(action.lead),
              "less than the " + std::to_string(action.path.size()) + " waypoints");
  action.length = read_amount(from, "length");
  action.full_cost = read_amount(from, "cost");
  action.expected_cost = read_amount(from, "expected cost");
  action.contact_probability = read_amount(from, "contact probability");
  if (action.contact_probability > 1.0 + 1e-9)
    from.fail("contact probability", std::to_string(action.contact_probability), "at most 1");
  action.sensing = read_sensing(from, "errors of the robot");
  action.supposed_target = read_pose(from, "supposed target");
  from.finish();
  action.id = path_id(action.path);
  action.bodies = BodyPath(task.bodies(), action.path);
  return action;
}

}  // namespace tactus::action
