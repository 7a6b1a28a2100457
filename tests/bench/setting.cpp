// SPDX-License-Identifier: BSD-3-Clause
#include "bench/setting.hpp"

#include <numbers>

#include "geometry/mesh_file.hpp"

namespace tactus::bench {
namespace {

using geometry::Vector3;
using support::Rng;

constexpr std::size_t motion_count = 10;
constexpr double motion_length = 0.2;                        // m
constexpr double breadth = 0.3;                              // m, of the poses
constexpr double breadth_of_turns = std::numbers::pi / 6.0;  // of the poses
constexpr double tilt = std::numbers::pi / 12.0;             // of the tool against the central pose, at most
constexpr double spread = 0.06;                              // m, of the middles of the motions
const Vector3 before_the_poses(-0.05, 0.0, 0.0);             // about here are the middles of the motions
const Vector3 tool_middle(0.0, 0.0, 0.14);                   // of the plug, in the tool link's frame

Vector3 random_direction(Rng& rng) { return Vector3(rng.normal(), rng.normal(), rng.normal()).normalized(); }

Pose turned(const Vector3& axis, double angle) { return Pose(Eigen::AngleAxisd(angle, axis)); }

/// The tool's middle passes the middle of the poses in any direction that does not lead back out of the wall.
std::vector<ToolMotion> tool_motions(Rng& rng, double turn) {
  const Pose seated = geometry::pose_from({0.0, 0.0, 0.0, -std::numbers::pi / 2.0, 0.0, -std::numbers::pi / 2.0});
  std::vector<ToolMotion> motions;
  for (std::size_t i = 0; i < motion_count; ++i) {
    const Pose facing = turned(random_direction(rng), rng.uniform(0.0, tilt)) * seated;
    const Vector3 middle = before_the_poses + rng.uniform(0.0, spread) * random_direction(rng);
    Vector3 way = motion_length * random_direction(rng);
    way.x() = std::abs(way.x());
    const Vector3 axis = random_direction(rng);
    const auto at = [&](double fraction) {
      Pose pose = turned(axis, fraction * turn) * facing;
      pose.translation() = middle + fraction * way - pose.linear() * tool_middle;
      return pose;
    };
    motions.push_back({at(-0.5), at(0.5)});
  }
  return motions;
}

Pose random_pose(Rng& rng) {
  const auto within = [&rng](double width) { return rng.uniform(-0.5 * width, 0.5 * width); };
  const double x = within(breadth), y = within(breadth), z = within(breadth);
  const double roll = within(breadth_of_turns), yaw = within(breadth_of_turns);
  return geometry::pose_from({x, y, z, roll, 0.0, yaw});
}

/// Holds every point of the mesh at every pose.
geometry::Box region(const Mesh& mesh, const Vector3& middle) {
  double reach = 0.0;
  for (const Vector3& vertex : mesh.vertices) reach = std::max(reach, vertex.norm());
  return geometry::Box{middle, middle}.inflated(0.5 * breadth + reach);
}

Mesh model(const std::string& name) {
  return geometry::load_mesh(TACTUS_SOURCE_DIR "/examples/models/" + name + "/" + name + ".stl");
}

}  // namespace

Target socket() { return {"socket", model("socket")}; }

std::shared_ptr<const contact::RobotBodies> plug_alone() {
  const Carrier carrier = free_flyer();
  return std::make_shared<const contact::RobotBodies>(carrier.model, carrier.tool_link, model("plug"));
}

Setting setting(const Carrier& carrier, Target target, double turn, std::size_t n, std::size_t pairs,
                std::uint64_t seed) {
  Rng rng(seed);
  Setting made;
  made.bodies = std::make_shared<const contact::RobotBodies>(
      carrier.model, carrier.tool_link, model("plug"), region(target.mesh, carrier.base_from_motions.translation()));
  made.target = std::move(target);
  made.motions = carrier.follow(carrier, tool_motions(rng, turn), n);
  for (std::size_t i = 0; i < pairs / motion_count; ++i)
    made.base_from_target.push_back(carrier.base_from_motions * random_pose(rng));
  return made;
}

}  // namespace tactus::bench
