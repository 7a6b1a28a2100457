// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mesh.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "contact/plain_contact.hpp"
#include "geometry/triangle_tree.hpp"
#include "support/rng.hpp"

namespace tactus::geometry {
namespace {

using support::Rng;

constexpr double pi = std::numbers::pi;

Mesh moved(const Mesh& mesh, const Vector3& by) { return transformed(mesh, Pose(Eigen::Translation3d(by))); }

/// Every triangle with corners of its own, as in an STL file.
Mesh in_pieces(const Mesh& mesh) {
  Mesh pieces;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::int32_t>(pieces.vertices.size());
    for (const std::int32_t i : t) pieces.vertices.push_back(mesh.vertices[static_cast<std::size_t>(i)]);
    pieces.triangles.push_back({first, first + 1, first + 2});
  }
  return pieces;
}

TEST(Shapes, AreClosedAndFaceOutwards) {
  for (const Mesh& mesh : {box_mesh({0.1, 0.2, 0.3}), cylinder_mesh(0.1, 0.2, 7), sphere_mesh(0.1, 5)}) {
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_GT(signed_volume(mesh), 0.0);
  }
  EXPECT_NEAR(signed_volume(box_mesh({0.1, 0.2, 0.3})), 0.006, 1e-15);
  EXPECT_NEAR(signed_volume(cylinder_mesh(0.1, 0.2, 400)), pi * 0.01 * 0.2, 1e-6);
  EXPECT_NEAR(signed_volume(sphere_mesh(0.1, 200)), 4.0 / 3.0 * pi * 0.001, 1e-6);
}

TEST(Shapes, EncloseWhatTheyStandFor) {
  Rng rng(1);
  const Mesh cylinder = cylinder_mesh(0.1, 0.2, 9), sphere = sphere_mesh(0.1, 6);
  for (int i = 0; i < 2000; ++i) {
    const double angle = rng.uniform(0.0, 2.0 * pi), z = rng.uniform(-0.0999, 0.0999);
    EXPECT_TRUE(test::winds_about(cylinder, {0.0999 * std::cos(angle), 0.0999 * std::sin(angle), z}));
    EXPECT_TRUE(test::winds_about(sphere, 0.0999 * Vector3(rng.normal(), rng.normal(), rng.normal()).normalized()));
  }
}

TEST(Diameter, IsTheGreatestDistanceOfTwoVertices) {
  Rng rng(2);
  for (int i = 0; i < 100; ++i) {
    Mesh mesh;
    for (std::uint64_t k = 3 + rng.below(40); k > 0; --k)
      mesh.vertices.emplace_back(rng.normal(), rng.normal(), 0.1 * rng.normal());
    double longest = 0.0;
    for (const Vector3& a : mesh.vertices)
      for (const Vector3& b : mesh.vertices) longest = std::max(longest, (a - b).norm());
    EXPECT_DOUBLE_EQ(diameter(mesh), longest);
  }
  EXPECT_NEAR(diameter(box_mesh({0.3, 0.4, 1.2})), 1.3, 1e-12);
}

TEST(Bounds, HoldEveryVertex) {
  Rng rng(3);
  for (int i = 0; i < 50; ++i) {
    Mesh mesh;
    for (int k = 0; k < 20; ++k) mesh.vertices.emplace_back(rng.normal(), rng.normal(), rng.normal());
    const Box box = bounds(mesh);
    const Sphere sphere = bounding_sphere(mesh);
    for (const Vector3& v : mesh.vertices) {
      EXPECT_TRUE(box.contains(v));
      EXPECT_LE((v - sphere.centre).norm(), sphere.radius + 1e-12);
    }
    EXPECT_FALSE(box.inflated(-1e-6).contains(mesh.vertices[0]) && box.inflated(-1e-6).contains(mesh.vertices[1]) &&
                 box.size().minCoeff() < 1e-6);
  }
  EXPECT_TRUE(Box{}.empty());
  EXPECT_FALSE(bounds(box_mesh({1, 1, 1})).empty());
}

TEST(Box, DistanceAndOverlap) {
  const Box box{{0, 0, 0}, {1, 2, 3}};
  EXPECT_EQ(box.distance({0.5, 0.5, 0.5}), 0.0);
  EXPECT_DOUBLE_EQ(box.distance({4.0, 1.0, 7.0}), 5.0);
  EXPECT_TRUE(box.overlaps({{1, 2, 3}, {4, 4, 4}}));
  EXPECT_FALSE(box.overlaps({{1.001, 0, 0}, {2, 2, 2}}));
  EXPECT_TRUE(box.centre().isApprox(Vector3(0.5, 1.0, 1.5)));
}

TEST(Closed, MeansThatEveryEdgeHasItsOpposite) {
  const Mesh box = box_mesh({1, 1, 1});
  EXPECT_TRUE(is_closed(in_pieces(box)));
  for (std::size_t i = 0; i < box.triangles.size(); ++i) {
    Mesh open = box, flipped = box;
    open.triangles.erase(open.triangles.begin() + static_cast<std::ptrdiff_t>(i));
    std::swap(flipped.triangles[i][0], flipped.triangles[i][1]);
    EXPECT_FALSE(is_closed(open));
    EXPECT_FALSE(is_closed(flipped));
  }
  EXPECT_FALSE(is_closed({}));
}

TEST(MergedVertices, AreEachThereOnceAndNoTriangleHasOneTwice) {
  Mesh pieces = in_pieces(box_mesh({0.1, 0.2, 0.3}));
  pieces.triangles.push_back({0, 1, 1});
  pieces.vertices.push_back(0.5 * (pieces.vertices[0] + pieces.vertices[1]));
  pieces.triangles.push_back({0, static_cast<std::int32_t>(pieces.vertices.size()) - 1, 1});
  const Mesh merged = merged_vertices(pieces);
  EXPECT_EQ(merged.vertices.size(), 9u);
  EXPECT_EQ(merged.triangles.size(), 13u);
  EXPECT_EQ(std::count_if(merged.triangles.begin(), merged.triangles.end(),
                          [&](const Triangle& t) { return has_area(merged, t); }),
            12);
  EXPECT_TRUE(is_closed(merged));
  EXPECT_NEAR(signed_volume(merged), 0.006, 1e-15);
}

/// As exporters write them: a vertex in the middle of an edge, of the triangle on one side of it alone, and a triangle
/// without area between.
TEST(IsClosed, WhereATriangleWithoutAreaClosesTheGapAtAVertexOnAnEdge) {
  Mesh split = box_mesh({0.1, 0.2, 0.3});
  const Triangle whole = split.triangles.front();
  const auto middle = static_cast<std::int32_t>(split.vertices.size());
  split.vertices.push_back(
      0.5 * (split.vertices[static_cast<std::size_t>(whole[0])] + split.vertices[static_cast<std::size_t>(whole[1])]));
  split.triangles.front() = {whole[0], middle, whole[2]};
  split.triangles.push_back({middle, whole[1], whole[2]});
  EXPECT_FALSE(is_closed(split));
  split.triangles.push_back({whole[0], whole[1], middle});
  EXPECT_TRUE(is_closed(split));
  const TriangleTree tree(split);
  EXPECT_TRUE(tree.contains(Vector3::Zero()));
  EXPECT_NEAR(tree.distance(Vector3(0.02, 0, 0)), 0.03, 1e-12);
  ASSERT_EQ(shells(merged_vertices(in_pieces(split))).size(), 1u);
}

TEST(MergedVertices, TakeMinusZeroForZero) {
  Mesh mesh;
  mesh.vertices = {{0.0, 0.0, 0.0}, {-0.0, -0.0, 0.0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 3}, {1, 2, 4}};
  EXPECT_EQ(merged_vertices(mesh).vertices.size(), 4u);
}

TEST(Shells, ComeApartAndTogether) {
  Mesh all = box_mesh({0.1, 0.1, 0.1});
  append(all, moved(sphere_mesh(0.05, 4), {0.5, 0, 0}));
  append(all, moved(cylinder_mesh(0.05, 0.1, 5), {0, 0.5, 0}));
  const std::vector<Mesh> parts = shells(merged_vertices(in_pieces(all)));
  ASSERT_EQ(parts.size(), 3u);
  double volume = 0.0;
  for (const Mesh& part : parts) {
    EXPECT_TRUE(is_closed(part));
    volume += signed_volume(part);
  }
  EXPECT_NEAR(volume, signed_volume(all), 1e-12);
}

TEST(OrientOutward, TurnsClosedShellsThatAreInsideOutAndNoOthers) {
  const auto inside_out = [](Mesh mesh) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
  };
  Mesh all = box_mesh({0.1, 0.1, 0.1});
  append(all, moved(inside_out(box_mesh({0.2, 0.2, 0.2})), {1, 0, 0}));
  Mesh sheet = moved(inside_out(box_mesh({0.1, 0.1, 0.1})), {0, 1, 0});
  sheet.triangles.pop_back();
  append(all, sheet);
  orient_outward(all);
  const std::vector<Mesh> parts = shells(all);
  ASSERT_EQ(parts.size(), 3u);
  int closed = 0;
  for (const Mesh& part : parts) {
    if (!is_closed(part)) {
      EXPECT_EQ(part.triangles.size(), 11u);
      continue;
    }
    EXPECT_GT(signed_volume(part), 0.0);
    ++closed;
  }
  EXPECT_EQ(closed, 2);
}

}  // namespace
}  // namespace tactus::geometry
