// SPDX-License-Identifier: BSD-3-Clause
#include "contact/solid.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBB.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <utility>

#include "support/error.hpp"

namespace tactus::contact {

using geometry::Box;
using geometry::Mesh;
using geometry::Pose;
using geometry::Vector3;
using support::Error;
using support::Status;

struct Solid::Tree {
  fcl::BVHModel<fcl::OBBd> model;
};

namespace {

void check_mesh(const Mesh& mesh, const std::string& name) {
  const auto count = static_cast<std::int32_t>(mesh.vertices.size());
  for (const Vector3& vertex : mesh.vertices)
    if (!vertex.allFinite()) throw Error(Status::bad_mesh, name + ": found a vertex that is not finite");
  for (const geometry::Triangle& triangle : mesh.triangles)
    for (const std::int32_t corner : triangle)
      if (corner < 0 || corner >= count)
        throw Error(Status::bad_mesh, name + ": found a triangle with vertex " + std::to_string(corner) +
                                          ", expected one of 0 .. " + std::to_string(count - 1));
}

void build(fcl::BVHModel<fcl::OBBd>& model, const Mesh& mesh, const std::string& name) {
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const geometry::Triangle& t : mesh.triangles)
    if (geometry::has_area(mesh, t))
      triangles.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                             static_cast<std::size_t>(t[2]));
  const bool built = model.beginModel() == fcl::BVH_OK && model.addSubModel(mesh.vertices, triangles) == fcl::BVH_OK &&
                     model.endModel() == fcl::BVH_OK;
  if (!built) throw Error(Status::bad_mesh, name + ": the collision tree could not be built");
  model.computeLocalAABB();
}

}  // namespace

Solid::Solid(const Mesh& mesh, const std::string& name) {
  check_mesh(mesh, name);
  const Mesh merged = geometry::merged_vertices(mesh);
  if (!geometry::has_area(merged))
    throw Error(Status::bad_mesh, name + ": found no triangle with an area, expected at least one");
  auto tree = std::make_shared<Tree>();
  build(tree->model, merged, name);
  tree_ = std::move(tree);
  for (const Mesh& shell : geometry::shells(merged)) {
    box_.add(geometry::bounds(shell));
    for (const Vector3& vertex : shell.vertices) reach_ = std::max(reach_, vertex.norm());
    shells_.push_back({geometry::TriangleTree(shell), shell.vertices.front()});
  }
}

// Only asked when no surfaces cross, so that one vertex speaks for its shell.
bool Solid::holds_part_of(const Solid& other, const Pose& this_from_other) const {
  for (const Shell& inner : other.shells_) {
    const Vector3 point = this_from_other * inner.vertex;
    for (const Shell& outer : shells_)
      if (inner.tree.box().size().maxCoeff() <= outer.tree.box().size().norm() && outer.tree.contains(point))
        return true;
  }
  return false;
}

bool touching(const Solid& a, const Pose& root_from_a, const Solid& b, const Pose& root_from_b) {
  static const fcl::CollisionRequestd yes_or_no(1, false);
  fcl::CollisionResultd result;
  if (fcl::collide(&a.tree_->model, root_from_a, &b.tree_->model, root_from_b, yes_or_no, result) > 0) return true;
  const Pose a_from_b = root_from_a.inverse() * root_from_b;
  return a.holds_part_of(b, a_from_b) || b.holds_part_of(a, a_from_b.inverse());
}

Box moved_box(const Box& box, const Pose& pose) {
  const Vector3 centre = pose * box.centre();
  const Vector3 half = pose.linear().cwiseAbs() * (0.5 * box.size());
  return {centre - half, centre + half};
}

}  // namespace tactus::contact
