// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/mesh.hpp"

namespace tactus::geometry {

using Corners = std::array<Vector3, 3>;

inline Corners corners(const Mesh& mesh, const Triangle& t) {
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

inline Corners transformed(const Corners& c, const Pose& pose) { return {pose * c[0], pose * c[1], pose * c[2]}; }

inline Box bounds(const Corners& c) { return {c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2])}; }

/// The point of the triangle nearest to `p`.
Vector3 closest_point(const Corners& triangle, const Vector3& p);

/// The distance between two triangles; 0 if they cross or touch.
double distance(const Corners& a, const Corners& b);

/// +1 or -1 if the ray from `origin` along `direction` goes through the triangle against or along its normal; 0 if it
/// passes.
int crossing(const Corners& triangle, const Vector3& origin, const Vector3& direction);

}  // namespace tactus::geometry
