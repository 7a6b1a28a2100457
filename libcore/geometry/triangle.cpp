// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/triangle.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::geometry {
namespace {

double segment_distance_squared(const Vector3& p1, const Vector3& q1, const Vector3& p2, const Vector3& q2) {
  const Vector3 d1 = q1 - p1, d2 = q2 - p2, r = p1 - p2;
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(r), c = d1.dot(r), b = d1.dot(d2);
  const double denominator = a * e - b * b;
  double s = denominator > 0.0 ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  double t = e > 0.0 ? (b * s + f) / e : 0.0;
  if (t < 0.0 || t > 1.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = a > 0.0 ? std::clamp((b * t - c) / a, 0.0, 1.0) : 0.0;
  }
  return (p1 + s * d1 - p2 - t * d2).squaredNorm();
}

/// Whether the segment from `p` to `q` goes through the triangle's plane inside the triangle.
bool pierces(const Corners& t, const Vector3& p, const Vector3& q) {
  const Vector3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double hp = normal.dot(p - t[0]), hq = normal.dot(q - t[0]);
  if ((hp > 0.0) == (hq > 0.0)) return false;
  const Vector3 x = p + (hp / (hp - hq)) * (q - p);
  for (int i = 0; i < 3; ++i)
    if ((t[(i + 1) % 3] - t[i]).cross(x - t[i]).dot(normal) < 0.0) return false;
  return true;
}

}  // namespace

Vector3 closest_point(const Corners& t, const Vector3& p) {
  const Vector3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return t[0];
  const Vector3 bp = p - t[1];
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return t[1];
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return t[0] + (d1 / (d1 - d3)) * ab;
  const Vector3 cp = p - t[2];
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return t[2];
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return t[0] + (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
    return t[1] + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (t[2] - t[1]);
  const double scale = 1.0 / (va + vb + vc);
  return t[0] + (vb * scale) * ab + (vc * scale) * ac;
}

double distance(const Corners& a, const Corners& b) {
  for (int i = 0; i < 3; ++i)
    if (pierces(a, b[i], b[(i + 1) % 3]) || pierces(b, a[i], a[(i + 1) % 3])) return 0.0;
  double squared = 1e300;
  for (int i = 0; i < 3; ++i) {
    squared = std::min(squared, (closest_point(a, b[i]) - b[i]).squaredNorm());
    squared = std::min(squared, (closest_point(b, a[i]) - a[i]).squaredNorm());
    for (int j = 0; j < 3; ++j)
      squared = std::min(squared, segment_distance_squared(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
  }
  return std::sqrt(squared);
}

int crossing(const Corners& t, const Vector3& origin, const Vector3& direction) {
  const Vector3 e1 = t[1] - t[0], e2 = t[2] - t[0];
  const Vector3 h = direction.cross(e2);
  const double determinant = e1.dot(h);
  if (determinant == 0.0) return 0;
  const Vector3 s = origin - t[0];
  const double u = s.dot(h) / determinant;
  if (u < 0.0 || u > 1.0) return 0;
  const Vector3 q = s.cross(e1);
  const double v = direction.dot(q) / determinant;
  if (v < 0.0 || u + v > 1.0 || e2.dot(q) / determinant <= 0.0) return 0;
  return determinant > 0.0 ? -1 : 1;
}

}  // namespace tactus::geometry
