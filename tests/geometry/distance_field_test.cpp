// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/distance_field.hpp"

#include <gtest/gtest.h>

#include "contact/reference.hpp"
#include "support/rng.hpp"

namespace tactus::geometry {
namespace {

using reference::Placed;
using reference::Shape;
using support::Rng;

Mesh moved(const Mesh& mesh, const Vector3& by) { return transformed(mesh, Pose(Eigen::Translation3d(by))); }

Mesh without_a_side(Mesh mesh) {
  mesh.triangles.resize(mesh.triangles.size() - 2);
  return mesh;
}

struct Case {
  const char* name;
  Shape shape;
  double spacing;
  double border;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

class FieldLaw : public ::testing::TestWithParam<Case> {};

/// The distance to the surface with the sign of the inside, by the oracle. Inner surfaces count as surface.
double signed_distance(const Placed& placed, const Vector3& p) {
  const double away = reference::surface_from_point(placed, p);
  return reference::holds(*placed.shape, p) ? -away : away;
}

Vector3 random_point(const Box& box, Rng& rng) {
  Vector3 p;
  for (int d = 0; d < 3; ++d) p[d] = rng.uniform(box.low[d], box.high[d]);
  return p;
}

TEST_P(FieldLaw, ExactIsTheDistanceAndBoundsHoldIt) {
  const Case& c = GetParam();
  const Mesh mesh = c.shape.mesh();
  const DistanceField field(mesh, c.spacing, c.border);
  const Placed placed(c.shape, Pose::Identity());
  Rng rng(1);
  for (int i = 0; i < 4000; ++i) {
    const Box box = bounds(mesh).inflated(i % 4 == 0 ? 0.3 : i % 4 == 1 ? 1.5 * c.border : 0.5 * c.border);
    const Vector3 p = random_point(box, rng);
    const double exact = signed_distance(placed, p);
    ASSERT_NEAR(field.exact(p), exact, 1e-9);
    const DistanceBounds at = field.bounds(p);
    ASSERT_LE(at.lower, exact + 1e-12);
    ASSERT_GE(at.upper, exact - 1e-12);
    const DistanceBounds narrow = field.narrow_bounds(p);
    ASSERT_LE(narrow.lower, exact + 1e-12);
    ASSERT_GE(narrow.upper, exact - 1e-12);
    ASSERT_GE(narrow.lower, at.lower - 1e-12);
    ASSERT_LE(narrow.upper, at.upper + 1e-12);
    if (bounds(mesh).inflated(c.border).contains(p)) {
      ASSERT_LE(at.upper - at.lower, 1.74 * field.spacing());
    }
  }
}

TEST_P(FieldLaw, BoundsHoldFarAway) {
  const Case& c = GetParam();
  const DistanceField field(c.shape.mesh(), c.spacing, c.border);
  const Placed placed(c.shape, Pose::Identity());
  Rng rng(2);
  for (int i = 0; i < 300; ++i) {
    const Vector3 p = rng.uniform(1.0, 50.0) * Vector3(rng.normal(), rng.normal(), rng.normal()).normalized();
    const double exact = signed_distance(placed, p);
    ASSERT_LE(field.bounds(p).lower, exact + 1e-9);
    ASSERT_GE(field.bounds(p).upper, exact - 1e-9);
    ASSERT_GT(field.bounds(p).lower, 0.5 * exact - 0.3);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, FieldLaw,
    ::testing::Values(
        Case{"box", {{box_mesh({0.05, 0.04, 0.03})}, {}}, 0.003, 0.01},
        Case{"ball", {{sphere_mesh(0.03, 5)}, {}}, 0.004, 0.02},
        Case{"two_that_overlap",
             {{box_mesh({0.05, 0.02, 0.02}), moved(box_mesh({0.021, 0.019, 0.05}), {0.011, 0.001, 0.017})}, {}},
             0.003,
             0.01},
        Case{"two_apart",
             {{box_mesh({0.02, 0.02, 0.02}), moved(box_mesh({0.01, 0.01, 0.01}), {0.05, 0.01, 0.0})}, {}},
             0.004,
             0.01},
        Case{"plate", {{box_mesh({0.06, 0.04, 0.001})}, {}}, 0.004, 0.01},
        Case{"open", {{}, {without_a_side(box_mesh({0.05, 0.04, 0.03}))}}, 0.003, 0.01},
        Case{"box_and_sheet",
             {{box_mesh({0.04, 0.04, 0.02})}, {moved(without_a_side(box_mesh({0.03, 0.03, 0.03})), {0.01, 0.0, 0.03})}},
             0.004,
             0.01}),
    [](const auto& chosen) { return std::string(chosen.param.name); });

TEST(DistanceField, GrowsItsSpacingUntilTheSamplesFit) {
  const DistanceField field(box_mesh({0.1, 0.1, 0.1}), 0.0005, 0.01, 2000);
  EXPECT_GT(field.spacing(), 0.0005);
  EXPECT_LE(field.bytes(), 2000 * sizeof(float));
  EXPECT_LT(field.bounds(Vector3::Zero()).lower, -0.03);
  EXPECT_NEAR(field.exact(Vector3::Zero()), -0.05, 1e-12);
}

/// Its bound is one-sided: farther away than asked it is as good as the bound.
TEST(TriangleTree, DistancesAreRightBelowTheBoundAndTheBoundAbove) {
  Rng rng(3);
  const Mesh mesh = sphere_mesh(0.05, 6);
  const TriangleTree tree(mesh);
  const Shape shape{{mesh}, {}};
  const Placed placed(shape, Pose::Identity());
  for (int i = 0; i < 1000; ++i) {
    const Vector3 p = random_point(tree.box().inflated(0.05), rng);
    const double exact = reference::surface_from_point(placed, p), bound = rng.uniform(0.0, 0.06);
    EXPECT_NEAR(tree.distance(p, bound), std::min(exact, bound), 1e-12);
    EXPECT_EQ(tree.is_nearer(p, bound), exact < bound);
    EXPECT_EQ(tree.contains(p), reference::holds(shape, p));
    Corners t;
    for (Vector3& corner : t) corner = p + 0.02 * Vector3(rng.normal(), rng.normal(), rng.normal());
    double nearest = 1e300;
    for (const reference::Corners& other : placed.triangles)
      nearest = std::min(nearest, reference::triangle_from_triangle(t, other));
    EXPECT_TRUE(tree.within(t, nearest + 1e-9));
    EXPECT_EQ(tree.within(t, 0.99 * nearest), nearest == 0.0);
  }
}

}  // namespace
}  // namespace tactus::geometry
