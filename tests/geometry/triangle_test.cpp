// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/triangle.hpp"

#include <gtest/gtest.h>

#include "contact/reference.hpp"
#include "support/rng.hpp"

namespace tactus::geometry {
namespace {

using support::Rng;

Vector3 random_point(Rng& rng, double spread = 1.0) {
  return spread * Vector3(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
}

/// Of any shape: fat, thin, or nearly a line.
Corners random_triangle(Rng& rng) {
  Corners t{random_point(rng), random_point(rng), random_point(rng)};
  const double thin = rng.below(3) == 0 ? 1e-3 : 1.0;
  t[2] = t[0] + rng.uniform() * (t[1] - t[0]) + thin * (t[2] - t[0]);
  const Vector3 by = random_point(rng, 0.7);
  for (Vector3& corner : t) corner += by;
  return t;
}

TEST(ClosestPoint, LiesInTheTriangleAsFarAsTheOracleSays) {
  Rng rng(1);
  for (int i = 0; i < 5000; ++i) {
    const Corners t = random_triangle(rng);
    const Vector3 p = random_point(rng, 2.0), nearest = closest_point(t, p);
    EXPECT_NEAR((nearest - p).norm(), reference::triangle_from_point(t, p), 1e-9);
    EXPECT_LT(reference::triangle_from_point(t, nearest), 1e-9);
  }
}

TEST(ClosestPoint, OfAPointOfTheTriangleIsThatPoint) {
  Rng rng(2);
  for (int i = 0; i < 500; ++i) {
    const Corners t = random_triangle(rng);
    double u = rng.uniform(), v = rng.uniform();
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    const Vector3 p = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
    EXPECT_LT((closest_point(t, p) - p).norm(), 1e-9);
    for (const Vector3& corner : t) EXPECT_LT((closest_point(t, corner) - corner).norm(), 1e-12);
  }
}

TEST(TriangleDistance, IsThatOfTheOracleBothWays) {
  Rng rng(3);
  int crossed = 0;
  for (int i = 0; i < 5000; ++i) {
    const Corners a = random_triangle(rng), b = random_triangle(rng);
    const double expected = reference::triangle_from_triangle(a, b);
    EXPECT_NEAR(distance(a, b), expected, 1e-9);
    EXPECT_NEAR(distance(b, a), expected, 1e-9);
    crossed += expected == 0.0;
  }
  EXPECT_GT(crossed, 200);
}

TEST(TriangleDistance, OfNeighboursIsZero) {
  Rng rng(4);
  for (int i = 0; i < 500; ++i) {
    const Corners a = random_triangle(rng);
    EXPECT_LT(distance(a, {a[1], a[0], random_point(rng)}), 1e-9);
    EXPECT_LT(distance(a, {a[2], random_point(rng), random_point(rng)}), 1e-9);
    EXPECT_LT(distance(a, a), 1e-9);
  }
}

TEST(TriangleDistance, OfParallelTrianglesIsTheirGap) {
  const Corners a{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
  for (const double gap : {1e-9, 1e-5, 0.5}) {
    Corners b = a;
    for (Vector3& corner : b) corner.z() += gap;
    EXPECT_NEAR(distance(a, b), gap, 1e-15);
    for (Vector3& corner : b) corner.x() += 2.0;
    EXPECT_NEAR(distance(a, b), std::hypot(1.0, gap), 1e-12);
  }
}

TEST(Crossing, SaysFromWhichSideARayGoesThrough) {
  Rng rng(5);
  int through = 0;
  for (int i = 0; i < 20000; ++i) {
    const Corners t = random_triangle(rng);
    const Vector3 origin = random_point(rng), direction = random_point(rng).normalized();
    const bool meets = test::segment_meets(origin, origin + 100.0 * direction, t[0], t[1], t[2]);
    const Vector3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    EXPECT_EQ(crossing(t, origin, direction), meets ? (normal.dot(direction) > 0.0 ? 1 : -1) : 0);
    through += meets;
  }
  EXPECT_GT(through, 200);
}

TEST(Crossing, AlongAClosedMeshSumsToInsideOrOutside) {
  Rng rng(6);
  const Mesh ball = sphere_mesh(0.8, 5);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 p = random_point(rng), direction = random_point(rng).normalized();
    int sum = 0;
    for (const Triangle& t : ball.triangles) sum += crossing(corners(ball, t), p, direction);
    EXPECT_EQ(sum, test::winds_about(ball, p) ? 1 : 0);
  }
}

TEST(Corners, MoveAndAreBounded) {
  Rng rng(7);
  const Pose pose = pose_from({0.1, 0.2, 0.3, 0.4, 0.5, 0.6});
  for (int i = 0; i < 100; ++i) {
    const Corners t = random_triangle(rng), there = transformed(t, pose);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_TRUE(there[k].isApprox(pose * t[k]));
      EXPECT_TRUE(bounds(t).contains(t[k]));
    }
  }
}

}  // namespace
}  // namespace tactus::geometry
