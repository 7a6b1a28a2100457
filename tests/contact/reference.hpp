// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "contact/plain_contact.hpp"
#include "robot/kinematics.hpp"

/// Contact of a robot with a target as plainly as it can be written: every waypoint, every body, every pair of
/// triangles, and rays for containment. Passed over is only what a ball around it or a plane shows to be too far away.
/// Shares no geometry with the library.
namespace tactus::reference {

using geometry::Mesh;
using geometry::Pose;
using geometry::Vector3;
using test::segment_meets;

struct Shape {
  std::vector<Mesh> solids;  ///< closed, united where they overlap
  std::vector<Mesh> sheets;  ///< mere surfaces

  std::vector<Mesh> pieces() const {
    std::vector<Mesh> all = solids;
    all.insert(all.end(), sheets.begin(), sheets.end());
    return all;
  }

  Mesh mesh() const {
    Mesh all;
    for (const Mesh& piece : pieces()) geometry::append(all, piece);
    return all;
  }
};

/// A tool or a link with its shape.
struct Part {
  int link = 0;
  Shape shape;
};

// --- distances

inline double segment_from_point(const Vector3& a, const Vector3& b, const Vector3& p) {
  const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + s * (b - a) - p).norm();
}

/// At an end of one of the two, or where the common perpendicular of the lines meets both.
inline double segment_from_segment(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  double nearest = std::min({segment_from_point(a, b, c), segment_from_point(a, b, d), segment_from_point(c, d, a),
                             segment_from_point(c, d, b)});
  const Vector3 u = b - a, v = d - c, perpendicular = u.cross(v);
  const double s = (c - a).cross(v).dot(perpendicular) / perpendicular.squaredNorm();
  const double t = (c - a).cross(u).dot(perpendicular) / perpendicular.squaredNorm();
  if (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) nearest = std::min(nearest, (a + s * u - c - t * v).norm());
  return nearest;
}

using Corners = std::array<Vector3, 3>;

/// Over the inside of the triangle its height, else the distance to a side.
inline double triangle_from_point(const Corners& t, const Vector3& p) {
  const Vector3 normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  bool over = true;
  double nearest = 1e300;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 &a = t[i], &b = t[(i + 1) % 3];
    over = over && normal.cross(b - a).dot(p - a) >= 0.0;
    nearest = std::min(nearest, segment_from_point(a, b, p));
  }
  return over ? std::abs(normal.dot(p - t[0])) : nearest;
}

inline double triangle_from_triangle(const Corners& s, const Corners& t) {
  double nearest = 1e300;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (segment_meets(s[i], s[j], t[0], t[1], t[2]) || segment_meets(t[i], t[j], s[0], s[1], s[2])) return 0.0;
    nearest = std::min({nearest, triangle_from_point(s, t[i]), triangle_from_point(t, s[i])});
    for (std::size_t k = 0; k < 3; ++k)
      nearest = std::min(nearest, segment_from_segment(s[i], s[j], t[k], t[(k + 1) % 3]));
  }
  return nearest;
}

/// Whether all of `t` lies farther than `margin` on one side of the plane of `s`.
inline bool beside(const Corners& s, const Corners& t, double margin) {
  const Vector3 normal = (s[1] - s[0]).cross(s[2] - s[0]).normalized();
  const auto [low, high] = std::minmax({normal.dot(t[0] - s[0]), normal.dot(t[1] - s[0]), normal.dot(t[2] - s[0])});
  return low > margin || high < -margin;
}

inline bool touch(const Corners& s, const Corners& t, double margin) {
  return !beside(s, t, margin) && !beside(t, s, margin) && triangle_from_triangle(s, t) <= margin;
}

/// Whether a ray from the point leaves one of the solids an odd number of times.
inline bool holds(const Shape& shape, const Vector3& p) {
  const Vector3 far = p + Vector3(7.1, 3.7, 11.3);
  return std::any_of(shape.solids.begin(), shape.solids.end(), [&](const Mesh& solid) {
    bool odd = false;
    for (const auto& t : solid.triangles)
      odd ^= segment_meets(p, far, test::corner(solid, t, 0), test::corner(solid, t, 1), test::corner(solid, t, 2));
    return odd;
  });
}

// --- shapes in their places

struct Ball {
  Vector3 centre = Vector3::Zero();
  double radius = 0.0;
};

inline double gap(const Ball& a, const Ball& b) { return (a.centre - b.centre).norm() - a.radius - b.radius; }

template <typename Points>
Ball ball_around(const Points& points) {
  Ball ball;
  for (const Vector3& p : points) ball.centre += p / static_cast<double>(points.size());
  for (const Vector3& p : points) ball.radius = std::max(ball.radius, (p - ball.centre).norm());
  return ball;
}

struct Placed {
  Placed(const Shape& its_shape, const Pose& its_pose) : shape(&its_shape), pose(its_pose) {
    const Mesh mesh = geometry::transformed(shape->mesh(), pose);
    ball = ball_around(mesh.vertices);
    for (const Mesh& piece : shape->pieces()) starts.push_back(pose * piece.vertices.front());
    for (const auto& t : mesh.triangles) {
      triangles.push_back({test::corner(mesh, t, 0), test::corner(mesh, t, 1), test::corner(mesh, t, 2)});
      balls.push_back(ball_around(triangles.back()));
    }
  }

  const Shape* shape;
  Pose pose;
  Ball ball;
  std::vector<Corners> triangles;
  std::vector<Ball> balls;
  std::vector<Vector3> starts;  ///< a vertex of each piece
};

/// Whether a piece of `inner` begins inside `outer`.
inline bool holds_part(const Placed& outer, const Placed& inner) {
  const Pose outer_from_base = outer.pose.inverse();
  return std::any_of(inner.starts.begin(), inner.starts.end(),
                     [&](const Vector3& p) { return holds(*outer.shape, outer_from_base * p); });
}

inline bool touch(const Placed& a, const Placed& b, double margin) {
  if (gap(a.ball, b.ball) > margin) return false;
  if (holds_part(a, b) || holds_part(b, a)) return true;
  for (std::size_t i = 0; i < a.triangles.size(); ++i) {
    if (gap(a.balls[i], b.ball) > margin) continue;
    for (std::size_t j = 0; j < b.triangles.size(); ++j)
      if (gap(a.balls[i], b.balls[j]) <= margin && touch(a.triangles[i], b.triangles[j], margin)) return true;
  }
  return false;
}

/// The distance of a point from the surface.
inline double surface_from_point(const Placed& placed, const Vector3& p) {
  double nearest = 1e300;
  for (const Corners& t : placed.triangles) nearest = std::min(nearest, triangle_from_point(t, p));
  return nearest;
}

/// The parts of a robot at every waypoint.
using Track = std::vector<std::vector<Placed>>;

inline Track track(const robot::RobotModel& model, const std::vector<Part>& parts,
                   const std::vector<robot::JointVector>& waypoints) {
  Track result;
  for (const robot::JointVector& q : waypoints) {
    result.emplace_back();
    for (const Part& part : parts) result.back().emplace_back(part.shape, robot::forward(model, q, part.link));
  }
  return result;
}

inline bool touches(const std::vector<Placed>& robot, const Placed& target, double margin) {
  return std::any_of(robot.begin(), robot.end(), [&](const Placed& part) { return touch(part, target, margin); });
}

inline std::optional<std::size_t> first_contact(const Track& track, const Placed& target, double margin,
                                                std::size_t from = 1) {
  for (std::size_t i = from; i < track.size(); ++i)
    if (touches(track[i], target, margin)) return i;
  return std::nullopt;
}

}  // namespace tactus::reference
