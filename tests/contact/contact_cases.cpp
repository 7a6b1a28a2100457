// SPDX-License-Identifier: BSD-3-Clause
#include "contact/contact_cases.hpp"

#include <map>
#include <numbers>

namespace tactus::test {
namespace {

using robot::JointKind;

Mesh moved(const Mesh& mesh, const Vector3& by) { return geometry::transformed(mesh, Pose(Eigen::Translation3d(by))); }

/// Two boxes that overlap.
Shape bracket() {
  return {{moved(geometry::box_mesh({0.05, 0.02, 0.012}), {0.011, 0.0, 0.0}),
           moved(geometry::box_mesh({0.011, 0.018, 0.06}), {-0.007, 0.0, 0.024})},
          {}};
}

Shape tube(double outer, double inner, double length, int sides) {
  const std::array<std::pair<double, double>, 4> profile{
      {{outer, -0.5 * length}, {outer, 0.5 * length}, {inner, 0.5 * length}, {inner, -0.5 * length}}};
  Mesh mesh;
  for (const auto& [radius, z] : profile)
    for (int i = 0; i < sides; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / sides;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < sides; ++i) {
      const int a = k * sides + i, b = k * sides + (i + 1) % sides;
      const int c = (k + 1) % 4 * sides + (i + 1) % sides, d = (k + 1) % 4 * sides + i;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return {{mesh}, {}};
}

Shape box_and_speck() {
  return {{geometry::box_mesh({0.05, 0.02, 0.02}), moved(geometry::box_mesh({0.003, 0.002, 0.004}), {0.0, 0.0, 0.09})},
          {}};
}

Shape box_and_hood() {
  return {{geometry::box_mesh({0.05, 0.04, 0.04})},
          {moved(open_box(0.04, 0.05, 0.03).sheets.front(), {0.0, 0.0, 0.04})}};
}

Arm arm_with(const Shape& tool) {
  robot::RobotModel model;
  const auto add = [&](const std::string& name, JointKind kind, const Vector3& axis, const Vector3& origin,
                       const Shape& shape) {
    robot::Link link;
    link.name = name;
    link.parent = static_cast<int>(model.links.size()) - 1;
    link.parent_from_joint.translation() = origin;
    link.joint_kind = kind;
    link.axis = axis.normalized();
    link.shapes = shape.pieces();
    if (kind != JointKind::fixed) {
      link.joint = model.dof();
      model.joints.push_back({name + "_joint", kind, -4.0, 4.0, 1.0});
    }
    model.links.push_back(link);
  };
  const Shape beam = box(0.05, 0.3, 0.04), wrist = tube(0.025, 0.015, 0.04, 8);
  add("base", JointKind::fixed, Vector3::UnitX(), Vector3::Zero(), box(0.2, 0.2, 0.1));
  add("beam", JointKind::prismatic, Vector3::UnitX(), {0.0, 0.0, 0.2}, beam);
  add("slide", JointKind::prismatic, Vector3::UnitY(), Vector3::Zero(), {});
  add("ram", JointKind::prismatic, Vector3::UnitZ(), {0.0, 0.0, -0.1}, {});
  add("wrist", JointKind::revolute, Vector3::UnitZ(), Vector3::Zero(), wrist);
  add("tip", JointKind::revolute, {0.0, 1.0, 0.3}, {0.02, 0.0, -0.09}, {});
  return {std::make_shared<const robot::RobotModel>(model), 5, {{5, tool}, {4, wrist}, {1, beam}}};
}

}  // namespace

Shape box(double x, double y, double z) { return {{geometry::box_mesh({x, y, z})}, {}}; }

Shape open_box(double x, double y, double z) {
  Mesh mesh = geometry::box_mesh({x, y, z});
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 2);
  return {{}, {mesh}};
}

Vector3 random_direction(Rng& rng) { return Vector3(rng.normal(), rng.normal(), rng.normal()).normalized(); }

Pose random_pose(Rng& rng, double reach) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(rng.uniform(0.0, std::numbers::pi), random_direction(rng)).toRotationMatrix();
  pose.translation() = reach * rng.uniform() * random_direction(rng);
  return pose;
}

std::vector<JointVector> random_waypoints(Rng& rng) {
  const auto kind = rng.below(3);
  const std::size_t count = 2 + rng.below(kind == 2 ? 6 : 24);
  JointVector q(5), step(5);
  const Vector3 way = random_direction(rng) * rng.uniform(0.0005, 0.005);
  const double turn = kind == 1 ? 0.06 : 0.0;
  q << rng.uniform(-0.1, 0.1), rng.uniform(-0.1, 0.1), rng.uniform(-0.1, 0.1), rng.uniform(-3.0, 3.0),
      rng.uniform(-1.0, 1.0);
  step << way, rng.uniform(-turn, turn), rng.uniform(-turn, turn);
  std::vector<JointVector> waypoints{q};
  while (waypoints.size() < count) {
    q += rng.below(8) == 0 ? 0.0 * step : rng.uniform(0.2, 2.0) * step;
    if (kind == 2)
      for (int j = 0; j < 5; ++j) q[j] = rng.uniform(-0.08, 0.08) * (j < 3 ? 1.0 : 20.0);
    waypoints.push_back(q);
  }
  return waypoints;
}

const std::vector<Pairing>& pairings() {
  static const std::vector<Pairing> all = [] {
    const Shape peg = box(0.012, 0.016, 0.08), rod{{geometry::cylinder_mesh(0.009, 0.07, 16)}, {}};
    const Shape knob{{geometry::sphere_mesh(0.015, 5)}, {}};
    return std::vector<Pairing>{
        {"PegAndBracket", peg, bracket(), 1e-5},
        {"RodAndTube", rod, tube(0.025, 0.012, 0.04, 12), 1e-5},
        {"BracketAndTube", bracket(), tube(0.02, 0.011, 0.05, 9), 1e-3},
        {"TubeAndPegWithoutMargin", tube(0.03, 0.014, 0.02, 10), peg, 0.0},
        {"KnobInsideBox", knob, box(0.12, 0.09, 0.08), 1e-5},
        {"SpeckInsideTool", box(0.08, 0.06, 0.09), box(0.004, 0.003, 0.005), 1e-5},
        {"PegAndOpenBox", peg, open_box(0.06, 0.05, 0.03), 1e-5},
        {"OpenBoxAndRod", open_box(0.06, 0.05, 0.03), rod, 1e-4},
        {"KnobAndBoxWithSpeck", knob, box_and_speck(), 1e-5},
        {"BoxWithHoodAndKnob", box_and_hood(), knob, 1e-5},
        {"SmallBoxAndBoxWithHood", box(0.01, 0.012, 0.008), box_and_hood(), 1e-5},
    };
  }();
  return all;
}

const Scene& scene_of(std::size_t pairing) {
  static std::map<std::size_t, Scene> made;
  return made.try_emplace(pairing, pairings()[pairing].tool, pairings()[pairing].target, pairings()[pairing].margin)
      .first->second;
}

Pose pose_near_touching(const Scene& scene, const Motion& motion, Rng& rng) {
  const std::vector<Placed>& robot = motion.track[1 + rng.below(motion.track.size() - 1)];
  const Placed& part = robot[rng.below(2) == 0 ? 0 : rng.below(robot.size())];
  const std::vector<Vector3> of_target = scene.target.mesh().vertices;
  Pose pose = random_pose(rng, 0.0);
  const Vector3 direction = random_direction(rng);
  const Vector3 start =
      part.triangles[rng.below(part.triangles.size())][0] - pose.linear() * of_target[rng.below(of_target.size())];
  double touching = 0.0, free = 1.0;
  while (free - touching > 1e-9) {
    const double middle = 0.5 * (touching + free);
    pose.translation() = start + middle * direction;
    (reference::first_contact(motion.track, Placed(scene.target, pose), scene.margin) ? touching : free) = middle;
  }
  const double shift = std::pow(10.0, rng.uniform(-8.0, -3.0));
  pose.translation() = start + (touching + (rng.below(2) == 0 ? shift : -shift)) * direction;
  return pose;
}

Pose pose_anywhere(const Scene& scene, const Motion& motion, Rng& rng) {
  const std::vector<Vector3> of_target = scene.target.mesh().vertices;
  Pose pose = random_pose(rng, 0.06);
  pose.translation() += motion.track[rng.below(motion.track.size())].front().ball.centre -
                        pose.linear() * of_target[rng.below(of_target.size())];
  return pose;
}

bool is_close_call(const Scene& scene, const Motion& motion, const Pose& pose, double radius, std::size_t from,
                   const std::optional<std::size_t>& answer) {
  for (int i = 0; i < 6; ++i) {
    Pose shifted = pose;
    shifted.translation()[i / 2] += i % 2 == 0 ? 1e-9 : -1e-9;
    if (reference::first_contact(motion.track, Placed(scene.target, shifted), radius, from) == answer) return true;
  }
  return false;
}

Scene::Scene(const Shape& tool, Shape its_target, double its_margin)
    : arm(arm_with(tool)),
      target(std::move(its_target)),
      margin(its_margin),
      contact(std::make_shared<contact::RobotBodies>(arm.model, arm.tip, tool.mesh()), target.mesh(), margin) {}

Motion::Motion(const Scene& scene, const std::vector<JointVector>& waypoints)
    : path(scene.contact.bodies(), waypoints), track(reference::track(*scene.arm.model, scene.arm.parts, waypoints)) {}

std::string name_of_pairing(std::size_t pairing) { return pairings()[pairing].name; }

double largest_displacement(const Mesh& mesh, const Pose& a, const Pose& b) {
  double largest = 0.0;
  for (const Vector3& v : mesh.vertices) largest = std::max(largest, (a * v - b * v).norm());
  return largest;
}

}  // namespace tactus::test
