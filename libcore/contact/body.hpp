// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "geometry/distance_field.hpp"

namespace tactus::contact {

using geometry::Corners;
using geometry::Mesh;
using geometry::Pose;
using geometry::Vector3;

/// A ball that holds a part of a surface.
struct SurfaceBall {
  Vector3 centre;       ///< of a leaf: a point of the surface
  double radius = 0.0;  ///< m
  int next = 0;         ///< the node after this one's subtree, in depth-first order
  int triangle = -1;    ///< of a leaf: the triangle whose piece it holds; -1: an inner node
  int shell = -1;       ///< of a leaf: the connected shell of that triangle
};

/// A rigid part of the robot that may touch the target: its triangles, and a tree of balls that covers its surface.
/// Const, shared.
class Body {
 public:
  /// `leaf_radius`: pieces of the surface are cut until a ball of this radius (m) holds each. The mesh is in the body's
  /// frame.
  Body(const Mesh& mesh, double leaf_radius);

  const std::vector<SurfaceBall>& balls() const { return balls_; }  ///< depth-first, the root first
  const std::vector<int>& leaves() const { return leaves_; }        ///< indices of the leaves among the balls
  const Corners& triangle(int index) const { return triangles_[index]; }
  const geometry::TriangleTree& tree() const { return tree_; }
  const geometry::Sphere& bounding_sphere() const { return sphere_; }
  const Mesh& mesh() const { return mesh_; }

  /// Signed distance to the body's surface, sampled finely enough for swept voxels.
  const geometry::DistanceField& field() const { return *field_; }

 private:
  Mesh mesh_;
  geometry::TriangleTree tree_;
  geometry::Sphere sphere_;
  std::vector<Corners> triangles_;
  std::vector<SurfaceBall> balls_;
  std::vector<int> leaves_;
  std::shared_ptr<const geometry::DistanceField> field_;
};

}  // namespace tactus::contact
