// SPDX-License-Identifier: BSD-3-Clause
#include "contact/body_path.hpp"

#include <algorithm>

#include "contact/solid.hpp"
#include "support/error.hpp"

namespace tactus::contact {
namespace {

constexpr double tool_piece_radius = 0.002;
constexpr double link_piece_radius = 0.01;

bool moves(const robot::RobotModel& model, int link) {
  for (; link >= 0; link = model.links[link].parent)
    if (model.links[link].joint >= 0) return true;
  return false;
}

/// A body is cut into pieces: of one whose unit was mistaken there would be millions of times as many.
std::unique_ptr<const Body> cut_up(const Mesh& mesh, double piece_radius, const std::string& name) {
  constexpr double most_pieces = 4e6;
  double area = 0.0;
  for (const geometry::Triangle& t : mesh.triangles) {
    const geometry::Corners c = geometry::corners(mesh, t);
    area += 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm();
  }
  if (area > most_pieces * piece_radius * piece_radius)
    throw support::Error(support::Status::bad_mesh,
                         name + ": found a mesh " + std::to_string(geometry::bounds(mesh).size().maxCoeff()) +
                             " m long, expected one of a robot's size in metres; is a scale of 0.001 missing?");
  return std::make_unique<Body>(mesh, piece_radius);
}

}  // namespace

const geometry::Box RobotBodies::everywhere{Vector3::Constant(-1e300), Vector3::Constant(1e300)};

RobotBodies::RobotBodies(std::shared_ptr<const robot::RobotModel> model, int tool_link, const Mesh& tool,
                         const geometry::Box& region)
    : model_(std::move(model)), tool_link_(tool_link), region_(region) {
  bodies_.push_back(cut_up(tool, tool_piece_radius, "tool"));
  links_.push_back(tool_link);
  for (int link = static_cast<int>(model_->links.size()) - 1; link >= 0; --link) {
    Mesh mesh;
    for (const Mesh& shape : model_->links[link].shapes) geometry::append(mesh, shape);
    if (mesh.triangles.empty() || !moves(*model_, link)) continue;
    bodies_.push_back(cut_up(mesh, link_piece_radius, "link '" + model_->links[link].name + "'"));
    links_.push_back(link);
  }
}

void RobotBodies::append_poses(const robot::JointVector& q, std::vector<Pose>& poses) const {
  std::vector<Pose> base_from_link;
  robot::forward(*model_, q, base_from_link);
  for (const int link : links_) poses.push_back(base_from_link[link]);
}

BodyPath::BodyPath(const RobotBodies& bodies, const std::vector<robot::JointVector>& waypoints)
    : bodies_(bodies.size()) {
  poses_.reserve(bodies_ * waypoints.size());
  for (const robot::JointVector& q : waypoints) bodies.append_poses(q, poses_);
  travelled_.assign(poses_.size(), 0.0);
  for (std::size_t i = bodies_; i < poses_.size(); ++i)
    travelled_[i] = travelled_[i - bodies_] + geometry::largest_displacement(bodies.body(i % bodies_).tree().box(),
                                                                             poses_[i - bodies_], poses_[i]);
  fill_blocks();
  const geometry::Box near = bodies.region().inflated(region_margin);
  for (std::size_t body = 0; body < bodies_; ++body) {
    Range range{size(), 0};
    for (std::size_t i = 0; i < size(); ++i) {
      if (!moved_box(bodies.body(body).tree().box(), base_from_body(i, body)).overlaps(near)) continue;
      range.begin = std::min(range.begin, i);
      range.end = i + 1;
    }
    near_region_.push_back(range);
  }
}

void BodyPath::fill_blocks() {
  const std::size_t waypoints = size(), lanes = kernel::lanes;
  blocks_.resize((waypoints + lanes - 1) / lanes * bodies_);
  for (std::size_t i = 0; i < blocks_.size() / std::max<std::size_t>(1, bodies_) * lanes; ++i)
    for (std::size_t body = 0; body < bodies_; ++body) {
      const kernel::Placement pose = placement(base_from_body(std::min(i, waypoints - 1), body));
      kernel::PoseBlock& block = blocks_[i / lanes * bodies_ + body];
      for (int k = 0; k < 9; ++k) block.rotation[k][i % lanes] = pose.rotation[k];
      for (int k = 0; k < 3; ++k) block.translation[k][i % lanes] = pose.translation[k];
    }
}

}  // namespace tactus::contact
