// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/mesh.hpp"

/// Contact of meshes as plainly as it can be written: every edge of the one against every triangle of the other, and
/// winding numbers. Shares no code with the library; right for meshes in general position.
namespace tactus::test {

using geometry::Mesh;
using geometry::Vector3;

inline const Vector3& corner(const Mesh& mesh, const geometry::Triangle& triangle, std::size_t i) {
  return mesh.vertices[static_cast<std::size_t>(triangle[i])];
}

/// Six times the signed volume of a tetrahedron.
inline double volume(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  return (b - a).cross(c - a).dot(d - a);
}

inline bool segment_meets(const Vector3& p, const Vector3& q, const Vector3& a, const Vector3& b, const Vector3& c) {
  if ((volume(a, b, c, p) > 0) == (volume(a, b, c, q) > 0)) return false;
  const bool first = volume(p, q, a, b) > 0;
  return first == (volume(p, q, b, c) > 0) && first == (volume(p, q, c, a) > 0);
}

inline bool edges_meet_triangles(const Mesh& a, const Mesh& b) {
  for (const auto& s : a.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      for (const auto& t : b.triangles)
        if (segment_meets(corner(a, s, i), corner(a, s, (i + 1) % 3), corner(b, t, 0), corner(b, t, 1),
                          corner(b, t, 2)))
          return true;
  return false;
}

/// Whether the triangles wind about the point: the sum of their solid angles (van Oosterom and Strackee).
inline bool winds_about(const Mesh& mesh, const Vector3& point) {
  double angle = 0.0;
  for (const auto& t : mesh.triangles) {
    const Vector3 a = corner(mesh, t, 0) - point, b = corner(mesh, t, 1) - point, c = corner(mesh, t, 2) - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return std::abs(angle) > 2.0 * std::numbers::pi;
}

/// Two closed meshes of one shell each.
inline bool plain_contact(const Mesh& a, const Mesh& b) {
  return edges_meet_triangles(a, b) || edges_meet_triangles(b, a) || winds_about(a, b.vertices.front()) ||
         winds_about(b, a.vertices.front());
}

}  // namespace tactus::test
