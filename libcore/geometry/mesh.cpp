// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace tactus::geometry {
namespace {

constexpr double pi = std::numbers::pi;

std::array<double, 3> key_of(const Vector3& v) { return {v.x() + 0.0, v.y() + 0.0, v.z() + 0.0}; }

bool has_a_corner_twice(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// Union-find over vertices joined by triangles.
std::vector<int> component_of_vertices(const Mesh& mesh) {
  std::vector<int> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  auto root = [&](int v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Triangle& t : mesh.triangles) {
    parent[root(t[1])] = root(t[0]);
    parent[root(t[2])] = root(t[0]);
  }
  for (std::size_t v = 0; v < parent.size(); ++v) parent[v] = root(static_cast<int>(v));
  return parent;
}

bool every_edge_has_its_opposite(const Mesh& mesh) {
  std::map<std::pair<int, int>, int> balance;
  for (const Triangle& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  return std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
}

}  // namespace

Mesh box_mesh(const Vector3& size) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(0.5 * size.cwiseProduct(Vector3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

Mesh cylinder_mesh(double radius, double length, int sides) {
  Mesh mesh;
  const double circumscribed = radius / std::cos(pi / sides);
  for (const double z : {-0.5 * length, 0.5 * length})
    for (int i = 0; i < sides; ++i) {
      const double angle = 2.0 * pi * i / sides;
      mesh.vertices.emplace_back(circumscribed * std::cos(angle), circumscribed * std::sin(angle), z);
    }
  const int bottom = 2 * sides, top = bottom + 1;
  mesh.vertices.emplace_back(0.0, 0.0, -0.5 * length);
  mesh.vertices.emplace_back(0.0, 0.0, 0.5 * length);
  for (int i = 0; i < sides; ++i) {
    const int next = (i + 1) % sides;
    mesh.triangles.push_back({i, next, sides + i});
    mesh.triangles.push_back({next, sides + next, sides + i});
    mesh.triangles.push_back({bottom, next, i});
    mesh.triangles.push_back({top, sides + i, sides + next});
  }
  return mesh;
}

Mesh sphere_mesh(double radius, int rings) {
  Mesh mesh;
  const int sides = 2 * rings;
  const double circumscribed = radius / (std::cos(0.5 * pi / rings) * std::cos(pi / sides));
  mesh.vertices.emplace_back(0.0, 0.0, circumscribed);
  for (int ring = 1; ring < rings; ++ring)
    for (int i = 0; i < sides; ++i) {
      const double polar = pi * ring / rings, angle = 2.0 * pi * i / sides;
      mesh.vertices.push_back(circumscribed * Vector3(std::sin(polar) * std::cos(angle),
                                                      std::sin(polar) * std::sin(angle), std::cos(polar)));
    }
  const int last = static_cast<int>(mesh.vertices.size());
  mesh.vertices.emplace_back(0.0, 0.0, -circumscribed);
  auto at = [&](int ring, int i) { return 1 + (ring - 1) * sides + i % sides; };
  for (int i = 0; i < sides; ++i) {
    mesh.triangles.push_back({0, at(1, i), at(1, i + 1)});
    for (int ring = 1; ring < rings - 1; ++ring) {
      mesh.triangles.push_back({at(ring, i), at(ring + 1, i), at(ring, i + 1)});
      mesh.triangles.push_back({at(ring, i + 1), at(ring + 1, i), at(ring + 1, i + 1)});
    }
    mesh.triangles.push_back({at(rings - 1, i), last, at(rings - 1, i + 1)});
  }
  return mesh;
}

Mesh transformed(const Mesh& mesh, const Pose& pose) {
  Mesh result = mesh;
  for (Vector3& v : result.vertices) v = pose * v;
  return result;
}

void append(Mesh& mesh, const Mesh& other) {
  const auto base = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Triangle& t : other.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

Box bounds(const Mesh& mesh) {
  Box box;
  for (const Vector3& v : mesh.vertices) box.add(v);
  return box;
}

double largest_displacement(const Box& box, const Pose& from, const Pose& to) {
  const Eigen::Matrix3d turn = to.linear() - from.linear();
  const Vector3 centre = turn * box.centre() + (to.translation() - from.translation());
  const Vector3 half = 0.5 * box.size();
  double largest = 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    const Vector3 offset =
        turn * Vector3(half.x(), corner & 1 ? half.y() : -half.y(), corner & 2 ? half.z() : -half.z());
    largest = std::max({largest, (centre + offset).squaredNorm(), (centre - offset).squaredNorm()});
  }
  return std::sqrt(largest);
}

Sphere bounding_sphere(const Mesh& mesh) {
  Sphere sphere{bounds(mesh).centre(), 0.0};
  for (const Vector3& v : mesh.vertices) sphere.radius = std::max(sphere.radius, (v - sphere.centre).norm());
  return sphere;
}

double diameter(const Mesh& mesh) {
  const Sphere sphere = bounding_sphere(mesh);
  std::vector<std::pair<double, const Vector3*>> outermost_first;
  for (const Vector3& v : mesh.vertices) outermost_first.emplace_back((v - sphere.centre).norm(), &v);
  std::sort(outermost_first.begin(), outermost_first.end(), std::greater<>());
  double longest = 0.0;
  for (std::size_t i = 0; i < outermost_first.size(); ++i)
    for (std::size_t j = i + 1; j < outermost_first.size(); ++j) {
      if (outermost_first[i].first + outermost_first[j].first <= longest) break;
      longest = std::max(longest, (*outermost_first[i].second - *outermost_first[j].second).norm());
    }
  return longest;
}

double signed_volume(const Mesh& mesh) {
  double six_volumes = 0.0;
  for (const Triangle& t : mesh.triangles)
    six_volumes += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]]));
  return six_volumes / 6.0;
}

bool is_closed(const Mesh& mesh) {
  Mesh merged = merged_vertices(mesh);
  if (!has_area(merged)) return false;
  if (every_edge_has_its_opposite(merged)) return true;
  std::erase_if(merged.triangles, [&](const Triangle& t) { return !has_area(merged, t); });
  return every_edge_has_its_opposite(merged);
}

Mesh merged_vertices(const Mesh& mesh) {
  Mesh merged;
  std::map<std::array<double, 3>, std::int32_t> index_of;
  std::vector<std::int32_t> renamed;
  for (const Vector3& v : mesh.vertices) {
    const auto [entry, is_new] = index_of.try_emplace(key_of(v), static_cast<std::int32_t>(merged.vertices.size()));
    if (is_new) merged.vertices.push_back(v);
    renamed.push_back(entry->second);
  }
  for (const Triangle& t : mesh.triangles) {
    const Triangle candidate{renamed[t[0]], renamed[t[1]], renamed[t[2]]};
    if (!has_a_corner_twice(candidate)) merged.triangles.push_back(candidate);
  }
  return merged;
}

bool has_area(const Mesh& mesh, const Triangle& t) {
  const Vector3& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm() >= 1e-16;
}

bool has_area(const Mesh& mesh) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](const Triangle& t) { return has_area(mesh, t); });
}

std::vector<Mesh> shells(const Mesh& mesh) {
  const std::vector<int> component = component_of_vertices(mesh);
  std::map<int, Mesh> by_component;
  std::vector<std::int32_t> renamed(mesh.vertices.size(), -1);
  for (const Triangle& t : mesh.triangles) {
    Mesh& shell = by_component[component[t[0]]];
    Triangle local{};
    for (int i = 0; i < 3; ++i) {
      if (renamed[t[i]] < 0) {
        renamed[t[i]] = static_cast<std::int32_t>(shell.vertices.size());
        shell.vertices.push_back(mesh.vertices[t[i]]);
      }
      local[i] = renamed[t[i]];
    }
    shell.triangles.push_back(local);
  }
  std::vector<Mesh> result;
  for (auto& [root, shell] : by_component)
    if (has_area(shell)) result.push_back(std::move(shell));
  return result;
}

void orient_outward(Mesh& mesh) {
  Mesh oriented;
  for (Mesh& shell : shells(mesh)) {
    if (is_closed(shell) && signed_volume(shell) < 0.0)
      for (Triangle& t : shell.triangles) std::swap(t[1], t[2]);
    append(oriented, shell);
  }
  mesh = std::move(oriented);
}

}  // namespace tactus::geometry
