// SPDX-License-Identifier: BSD-3-Clause
#include "belief/small_task.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "action/insertion.hpp"
#include "action/primitives.hpp"
#include "action/probes.hpp"

namespace tactus::test {
namespace {

using robot::JointKind;

constexpr double quarter_turn = 0.5 * std::numbers::pi;

Mesh box_at(const Vector3& size, const Vector3& centre) {
  return geometry::transformed(geometry::box_mesh(size), Pose(Eigen::Translation3d(centre)));
}

/// Four corners of a square of half width `half`, at `x`, counter-clockwise seen from +x.
void add_square(Mesh& mesh, double x, double half) {
  mesh.vertices.insert(mesh.vertices.end(), {{x, -half, -half}, {x, half, -half}, {x, half, half}, {x, -half, half}});
}

void add_quad(Mesh& mesh, std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

void add_link(robot::RobotModel& model, const std::string& name, JointKind kind, const Vector3& axis, double reach,
              std::vector<Mesh> shapes) {
  robot::Link link;
  link.name = name;
  link.parent = static_cast<int>(model.links.size()) - 1;
  link.joint_kind = kind;
  link.axis = axis;
  link.shapes = std::move(shapes);
  if (kind != JointKind::fixed) {
    link.joint = model.dof();
    model.joints.push_back({name + "_joint", kind, -reach, reach, 1.0});
  }
  model.links.push_back(std::move(link));
}

std::shared_ptr<const robot::RobotModel> gantry() {
  auto model = std::make_shared<robot::RobotModel>();
  model->name = "gantry";
  add_link(*model, "base", JointKind::fixed, Vector3::UnitX(), 0.0, {});
  add_link(*model, "x", JointKind::prismatic, Vector3::UnitX(), 0.6, {});
  add_link(*model, "y", JointKind::prismatic, Vector3::UnitY(), 0.3, {});
  add_link(*model, "ram", JointKind::prismatic, Vector3::UnitZ(), 0.3, {box_at({0.1, 0.04, 0.04}, {-0.14, 0.0, 0.0})});
  add_link(*model, "wrist", JointKind::revolute, Vector3::UnitX(), 3.3,
           {box_at({0.04, 0.03, 0.02}, {-0.055, 0.0, 0.0})});
  add_link(*model, "pitch", JointKind::revolute, Vector3::UnitY(), 1.0, {});
  add_link(*model, "hand", JointKind::revolute, Vector3::UnitZ(), 1.0, {});
  return model;
}

const action::MotionPtr& pick(const std::vector<action::MotionPtr>& motions, support::Rng& rng) {
  return motions[rng.below(motions.size())];
}

action::MotionPtr random_motion(const action::Task& task, action::ActionLibrary& library, const JointVector& q,
                                support::Rng& rng) {
  const auto kind = rng.below(4);
  if (kind == 0) return action::insertion(task, task.scene().prior.sample(rng), q);
  const std::vector<action::MotionPtr> motions =
      kind == 1 ? library.primitives_at(q) : action::probes(task, task.frame().region, q, 3);
  return motions.empty() ? nullptr : pick(motions, rng);
}

}  // namespace

std::vector<Mesh> tool_pieces() {
  return {box_at({0.02, 0.024, 0.024}, {-0.01, 0.0, 0.0}), box_at({0.0215, 0.012, 0.012}, {0.00575, 0.0, 0.0})};
}

Mesh socket() {
  Mesh mesh;
  add_square(mesh, -0.012, 0.018);   // 0 .. 3: front
  add_square(mesh, 0.012, 0.018);    // 4 .. 7: back
  add_square(mesh, -0.012, 0.0065);  // 8 .. 11: mouth
  add_square(mesh, 0.004, 0.0065);   // 12 .. 15: bottom
  add_quad(mesh, 4, 5, 6, 7);
  add_quad(mesh, 15, 14, 13, 12);
  for (std::int32_t i = 0; i < 4; ++i) {
    const std::int32_t j = (i + 1) % 4;
    add_quad(mesh, i, j, 4 + j, 4 + i);
    add_quad(mesh, i, 8 + i, 8 + j, j);
    add_quad(mesh, 8 + i, 12 + i, 12 + j, 8 + j);
  }
  geometry::orient_outward(mesh);
  return mesh;
}

scene::Scene small_scene(const SmallTask& small) {
  scene::Scene scene;
  scene.robot = gantry();
  scene.tool_link = scene.robot->find_link("hand");
  for (const Mesh& piece : tool_pieces()) geometry::append(scene.tool, piece);
  scene.start = joints({0.34, 0.01, -0.02, 0.0, 0.0, 0.0});
  scene.world.push_back({"post", box_at({0.02, 0.02, 0.3}, {0.46, 0.125, 0.0})});
  scene.target.mesh = socket();
  scene.target.target_from_seated.clear();
  for (int seat = 0; seat < small.seats; ++seat)
    scene.target.target_from_seated.push_back(geometry::pose_from({-0.013, 0, 0, quarter_turn * seat, 0, 0}));
  scene.prior.centre = {0.45, 0.0, 0.01, 0.1, 0.0, 0.0};
  scene.prior.width = {small.depth_width, small.position_width, small.position_width, small.roll_width, 0.0, 0.0};
  scene.prior.guesses = small.guesses;
  return scene;
}

std::shared_ptr<const action::Task> small_task(const SmallTask& small) {
  action::TaskOptions options;
  options.actions.primitive_lengths = {0.02, 0.06};
  options.actions.primitive_angles = {0.2};
  options.actions.probe_depth = {0.015};
  options.sensing = small.sensing;
  const scene::Scene scene = small_scene(small);
  options.sites = belief::CellTables::sites(belief::CellBelief::shape(scene.prior, {}), 0.001);
  return std::make_shared<const action::Task>(scene, options);
}

std::shared_ptr<const belief::Model> small_model(belief::Kind kind, const SmallTask& small) {
  return small_model(small_task(small), kind, small);
}

std::shared_ptr<const belief::Model> small_model(std::shared_ptr<const action::Task> task, belief::Kind kind,
                                                 const SmallTask& small) {
  belief::Options options;
  options.kind = kind;
  options.voxel_size = small.voxel_size;
  options.delta = small.delta;
  options.cells.most = small.most_cells;
  return std::make_shared<const belief::Model>(std::move(task), options);
}

JointVector joints(std::initializer_list<double> values) {
  return Eigen::Map<const JointVector>(values.begin(), static_cast<Eigen::Index>(values.size()));
}

PoseVector random_pose(const scene::Prior& prior, support::Rng& rng) {
  PoseVector v = prior.centre;
  for (std::size_t d = 0; d < 6; ++d) v[d] += prior.width[d] * rng.uniform(-0.5, 0.5);
  return v;
}

action::Action random_action(const action::Task& task, action::ActionLibrary& library, const JointVector& q,
                             support::Rng& rng) {
  for (int tries = 0; tries < 100; ++tries) {
    const action::MotionPtr motion = random_motion(task, library, q, rng);
    if (!motion) continue;
    if (const auto action = library.realise(q, *motion, support::Deadline::unlimited())) return *action;
  }
  throw std::runtime_error("no action in a hundred tries");
}

action::Action insertion_at(const action::Task& task, action::ActionLibrary& library, const JointVector& q,
                            const Pose& base_from_target) {
  const action::MotionPtr motion = action::insertion(task, base_from_target, q);
  if (!motion) throw std::runtime_error("no insertion");
  const auto action = library.realise(q, *motion, support::Deadline::unlimited());
  if (!action) throw std::runtime_error("no way to the insertion");
  return *action;
}

action::Action action_along(const action::Task& task, const std::vector<JointVector>& waypoints) {
  return action::make_action(task, action::Kind::move, waypoints, 0, {{0, {0.1, 0.5, 4.0}}});
}

action::Action action_round(const action::Task& task, const std::vector<JointVector>& corners) {
  constexpr double step = 0.004;
  std::vector<JointVector> path{corners.front()};
  for (const JointVector& corner : corners) {
    const JointVector from = path.back();
    const int count = static_cast<int>(std::ceil((corner - from).norm() / step - 1e-9));
    for (int k = 1; k <= count; ++k) path.push_back(from + static_cast<double>(k) / count * (corner - from));
  }
  return action_along(task, path);
}

}  // namespace tactus::test
