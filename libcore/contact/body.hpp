// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "contact/ball_tree.hpp"
#include "geometry/distance_field.hpp"

namespace tactus::contact {

/// A rigid part of the robot that may touch the target: a tree of balls that covers its surface, its triangles, and the
/// signed distance to them. Const, shared.
class Body {
 public:
  /// The mesh is in the body's frame; `piece_radius` in metres, see `BallTree`.
  Body(const Mesh& mesh, double piece_radius);

  const BallTree& balls() const { return balls_; }
  const geometry::TriangleTree& tree() const { return tree_; }
  const Mesh& mesh() const { return mesh_; }
  const kernel::Extent& extent() const { return extent_; }  ///< the box of its vertices

  /// Signed distance to the body's surface, sampled finely enough for swept voxels.
  const geometry::DistanceField& field() const { return *field_; }

 private:
  Mesh mesh_;
  geometry::TriangleTree tree_;
  BallTree balls_;
  kernel::Extent extent_;
  std::shared_ptr<const geometry::DistanceField> field_;
};

}  // namespace tactus::contact
