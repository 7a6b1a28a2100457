// SPDX-License-Identifier: BSD-3-Clause
#include "bench/sheet.hpp"

#include <numbers>

namespace tactus::bench {
namespace {

using geometry::Mesh;
using geometry::Pose;
using geometry::Vector3;
using std::numbers::pi;

constexpr double width = 0.03;  // m, of the strip
constexpr int cells = 8;        // across its width
constexpr int corners = 2 * (cells + 1);

/// The middle of the sheet seen from its edge, in the x-y plane.
struct Station {
  Vector3 point, normal;
};

/// Draws the stations of a strip as a pen does that goes ahead and turns left.
class Pen {
 public:
  Pen& straight(double length, int steps) { return go(length, 0.0, steps); }
  Pen& bend(double radius, double angle, int steps) { return go(radius * angle, angle, steps); }
  const std::vector<Station>& stations() const { return stations_; }

 private:
  Pen& go(double length, double turn, int steps) {
    const double step_turn = turn / steps;
    // the chord of the arc that one step covers
    const double chord = turn == 0.0 ? length / steps : 2.0 * (length / turn) * std::sin(0.5 * step_turn);
    for (int i = 0; i < steps; ++i) {
      const double along = heading_ + 0.5 * step_turn;
      const Vector3 point = stations_.back().point + chord * Vector3(std::cos(along), std::sin(along), 0.0);
      heading_ += step_turn;
      stations_.push_back({point, Vector3(-std::sin(heading_), std::cos(heading_), 0.0)});
    }
    return *this;
  }

  double heading_ = 0.0;
  std::vector<Station> stations_{{Vector3::Zero(), Vector3::UnitY()}};
};

void add_quad(Mesh& mesh, int a, int b, int c, int d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

/// Around each station the corners of a cut through the strip: up along one face, down along the other.
Mesh strip(const std::vector<Station>& stations, bool closed) {
  Mesh mesh;
  for (const Station& station : stations)
    for (int k = 0; k < corners; ++k) {
      const bool up = k <= cells;
      const double across = static_cast<double>(up ? k : corners - 1 - k) / cells - 0.5;
      mesh.vertices.push_back(station.point + (up ? 0.5 : -0.5) * sheet_thickness * station.normal +
                              across * width * Vector3::UnitZ());
    }
  const int count = static_cast<int>(stations.size());
  for (int s = 0; s < (closed ? count : count - 1); ++s)
    for (int k = 0; k < corners; ++k) {
      const int here = s * corners, next = (s + 1) % count * corners, after = (k + 1) % corners;
      add_quad(mesh, here + k, here + after, next + after, next + k);
    }
  const int last = (count - 1) * corners;
  for (int k = 0; !closed && k < cells; ++k) {
    const int back = corners - 1 - k;
    add_quad(mesh, k, back, back - 1, k + 1);
    add_quad(mesh, last + k, last + k + 1, last + back - 1, last + back);
  }
  geometry::orient_outward(mesh);
  return geometry::transformed(mesh, Pose(Eigen::Translation3d(-geometry::bounds(mesh).centre())));
}

}  // namespace

Mesh hook() { return strip(Pen().straight(0.08, 16).bend(0.025, 200.0 / 180.0 * pi, 24).stations(), false); }

Mesh ring() {
  std::vector<Station> stations = Pen().bend(0.045, 2.0 * pi, 48).stations();
  stations.pop_back();  // the first once more
  return strip(stations, true);
}

Mesh bracket() {
  constexpr double radius = 0.005, side = 0.06;
  return strip(Pen()
                   .straight(side - radius, 11)
                   .bend(radius, 0.5 * pi, 6)
                   .straight(side - 2.0 * radius, 10)
                   .bend(radius, 0.5 * pi, 6)
                   .straight(side - radius, 11)
                   .stations(),
               false);
}

}  // namespace tactus::bench
