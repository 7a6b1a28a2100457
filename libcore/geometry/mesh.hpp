// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/pose.hpp"

namespace tactus::geometry {

using Triangle = std::array<std::int32_t, 3>;

/// Triangles in metres. Closed meshes (see `is_closed`) count as solids with outward normals, open ones as their
/// surface.
struct Mesh {
  std::vector<Vector3> vertices;
  std::vector<Triangle> triangles;  ///< indices into `vertices`, counter-clockwise seen from outside
};

struct Box {
  Vector3 low = Vector3::Constant(1e300);
  Vector3 high = Vector3::Constant(-1e300);
  bool empty() const { return low.x() > high.x(); }
  void add(const Vector3& point) { low = low.cwiseMin(point), high = high.cwiseMax(point); }
  void add(const Box& box) { low = low.cwiseMin(box.low), high = high.cwiseMax(box.high); }
  Box inflated(double by) const { return {low - Vector3::Constant(by), high + Vector3::Constant(by)}; }
  bool overlaps(const Box& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
  bool contains(const Vector3& p) const {
    return (low.array() <= p.array()).all() && (p.array() <= high.array()).all();
  }
  double distance(const Vector3& p) const { return (low - p).cwiseMax(p - high).cwiseMax(0.0).norm(); }
  Vector3 centre() const { return 0.5 * (low + high); }
  Vector3 size() const { return high - low; }
};

struct Sphere {
  Vector3 centre = Vector3::Zero();
  double radius = 0.0;
};

Mesh box_mesh(const Vector3& size);  ///< centred on the origin
Mesh cylinder_mesh(double radius, double length,
                   int sides = 32);               ///< about z, centred; the polygon encloses the circle
Mesh sphere_mesh(double radius, int rings = 16);  ///< centred; the polyhedron encloses the sphere
Mesh transformed(const Mesh& mesh, const Pose& pose);
void append(Mesh& mesh, const Mesh& other);

Box bounds(const Mesh& mesh);
/// How far a point of a box in a moving frame is displaced at most between two poses of the frame: a rigid displacement
/// is largest at a corner.
double largest_displacement(const Box& box, const Pose& from, const Pose& to);
Sphere bounding_sphere(const Mesh& mesh);  ///< about the centre of the bounding box
double diameter(const Mesh& mesh);         ///< D_max of the paper: the greatest distance between two of its points
double signed_volume(const Mesh& mesh);
/// Every edge has exactly one opposite, after equal vertices are merged: of all triangles, or of those that have an
/// area.
bool is_closed(const Mesh& mesh);
/// Vertices with equal coordinates made one; triangles that have a corner twice then are dropped. Others without area
/// stay: exporters close the gap with them where a vertex stands on another triangle's edge.
Mesh merged_vertices(const Mesh& mesh);
bool has_area(const Mesh& mesh, const Triangle& triangle);  ///< its corners are not on a line
bool has_area(const Mesh& mesh);                            ///< some triangle has
/// The triangles' connected shells, each as a mesh of its own, without those that have no area. `mesh` has merged
/// vertices.
std::vector<Mesh> shells(const Mesh& mesh);
/// Turns shells that are inside out (negative volume) right. Only closed shells are touched.
void orient_outward(Mesh& mesh);

}  // namespace tactus::geometry
