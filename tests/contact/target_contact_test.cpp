// SPDX-License-Identifier: BSD-3-Clause
#include "contact/target_contact.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <set>

#include "contact/reference.hpp"
#include "contact/swept_voxels.hpp"
#include "support/rng.hpp"

namespace tactus {
namespace {

using contact::BodyPath;
using contact::ContactInterval;
using contact::RobotBodies;
using contact::SweptVoxels;
using contact::TargetContact;
using geometry::Mesh;
using geometry::Pose;
using geometry::Vector3;
using geometry::VoxelGrid;
using reference::Part;
using reference::Placed;
using reference::Shape;
using robot::JointKind;
using robot::JointVector;
using support::Bitset;
using support::Rng;

// --- shapes

Mesh moved(const Mesh& mesh, const Vector3& by) { return geometry::transformed(mesh, Pose(Eigen::Translation3d(by))); }

Shape box(double x, double y, double z) { return {{geometry::box_mesh({x, y, z})}, {}}; }

/// Two boxes that overlap.
Shape bracket() {
  return {{moved(geometry::box_mesh({0.05, 0.02, 0.012}), {0.011, 0.0, 0.0}),
           moved(geometry::box_mesh({0.011, 0.018, 0.06}), {-0.007, 0.0, 0.024})},
          {}};
}

Shape tube(double outer, double inner, double length, int sides) {
  const std::array<std::pair<double, double>, 4> profile{
      {{outer, -0.5 * length}, {outer, 0.5 * length}, {inner, 0.5 * length}, {inner, -0.5 * length}}};
  Mesh mesh;
  for (const auto& [radius, z] : profile)
    for (int i = 0; i < sides; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / sides;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < sides; ++i) {
      const int a = k * sides + i, b = k * sides + (i + 1) % sides;
      const int c = (k + 1) % 4 * sides + (i + 1) % sides, d = (k + 1) % 4 * sides + i;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return {{mesh}, {}};
}

/// A box without its bottom: a surface.
Shape open_box(double x, double y, double z) {
  Mesh mesh = geometry::box_mesh({x, y, z});
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 2);
  return {{}, {mesh}};
}

Shape box_and_speck() {
  return {{geometry::box_mesh({0.05, 0.02, 0.02}), moved(geometry::box_mesh({0.003, 0.002, 0.004}), {0.0, 0.0, 0.09})},
          {}};
}

Shape box_and_hood() {
  return {{geometry::box_mesh({0.05, 0.04, 0.04})},
          {moved(open_box(0.04, 0.05, 0.03).sheets.front(), {0.0, 0.0, 0.04})}};
}

// --- an arm: three slides and two turns, a tool at its tip

struct Arm {
  std::shared_ptr<const robot::RobotModel> model;
  int tip = 0;
  std::vector<Part> parts;  ///< that move, the tool first
};

Arm arm_with(const Shape& tool) {
  robot::RobotModel model;
  const auto add = [&](const std::string& name, JointKind kind, const Vector3& axis, const Vector3& origin,
                       const Shape& shape) {
    robot::Link link;
    link.name = name;
    link.parent = static_cast<int>(model.links.size()) - 1;
    link.parent_from_joint.translation() = origin;
    link.joint_kind = kind;
    link.axis = axis.normalized();
    link.shapes = shape.pieces();
    if (kind != JointKind::fixed) {
      link.joint = model.dof();
      model.joints.push_back({name + "_joint", kind, -4.0, 4.0, 1.0});
    }
    model.links.push_back(link);
  };
  const Shape beam = box(0.05, 0.3, 0.04), wrist = tube(0.025, 0.015, 0.04, 8);
  add("base", JointKind::fixed, Vector3::UnitX(), Vector3::Zero(), box(0.2, 0.2, 0.1));
  add("beam", JointKind::prismatic, Vector3::UnitX(), {0.0, 0.0, 0.2}, beam);
  add("slide", JointKind::prismatic, Vector3::UnitY(), Vector3::Zero(), {});
  add("ram", JointKind::prismatic, Vector3::UnitZ(), {0.0, 0.0, -0.1}, {});
  add("wrist", JointKind::revolute, Vector3::UnitZ(), Vector3::Zero(), wrist);
  add("tip", JointKind::revolute, {0.0, 1.0, 0.3}, {0.02, 0.0, -0.09}, {});
  return {std::make_shared<const robot::RobotModel>(model), 5, {{5, tool}, {4, wrist}, {1, beam}}};
}

Vector3 random_direction(Rng& rng) { return Vector3(rng.normal(), rng.normal(), rng.normal()).normalized(); }

Pose random_pose(Rng& rng, double reach) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(rng.uniform(0.0, std::numbers::pi), random_direction(rng)).toRotationMatrix();
  pose.translation() = reach * rng.uniform() * random_direction(rng);
  return pose;
}

/// Steps of uneven length, some of none: straight or turning, or leaps from anywhere to anywhere.
std::vector<JointVector> random_waypoints(Rng& rng) {
  const auto kind = rng.below(3);
  const std::size_t count = 2 + rng.below(kind == 2 ? 6 : 24);
  JointVector q(5), step(5);
  const Vector3 way = random_direction(rng) * rng.uniform(0.0005, 0.005);
  const double turn = kind == 1 ? 0.06 : 0.0;
  q << rng.uniform(-0.1, 0.1), rng.uniform(-0.1, 0.1), rng.uniform(-0.1, 0.1), rng.uniform(-3.0, 3.0),
      rng.uniform(-1.0, 1.0);
  step << way, rng.uniform(-turn, turn), rng.uniform(-turn, turn);
  std::vector<JointVector> waypoints{q};
  while (waypoints.size() < count) {
    q += rng.below(8) == 0 ? 0.0 * step : rng.uniform(0.2, 2.0) * step;
    if (kind == 2)
      for (int j = 0; j < 5; ++j) q[j] = rng.uniform(-0.08, 0.08) * (j < 3 ? 1.0 : 20.0);
    waypoints.push_back(q);
  }
  return waypoints;
}

struct Scene {
  Scene(const Shape& tool, Shape its_target, double its_margin)
      : arm(arm_with(tool)),
        target(std::move(its_target)),
        margin(its_margin),
        contact(std::make_shared<RobotBodies>(arm.model, arm.tip, tool.mesh()), target.mesh(), margin) {}

  Arm arm;
  Shape target;
  double margin;
  TargetContact contact;
};

struct Motion {
  Motion(const Scene& scene, const std::vector<JointVector>& waypoints)
      : path(scene.contact.bodies(), waypoints),
        track(reference::track(*scene.arm.model, scene.arm.parts, waypoints)) {}

  BodyPath path;
  reference::Track track;
};

struct Pairing {
  const char* name;
  Shape tool, target;
  double margin;
};

const std::vector<Pairing>& pairings() {
  static const std::vector<Pairing> all = [] {
    const Shape peg = box(0.012, 0.016, 0.08), rod{{geometry::cylinder_mesh(0.009, 0.07, 16)}, {}};
    const Shape knob{{geometry::sphere_mesh(0.015, 5)}, {}};
    return std::vector<Pairing>{
        {"PegAndBracket", peg, bracket(), 1e-5},
        {"RodAndTube", rod, tube(0.025, 0.012, 0.04, 12), 1e-5},
        {"BracketAndTube", bracket(), tube(0.02, 0.011, 0.05, 9), 1e-3},
        {"TubeAndPegWithoutMargin", tube(0.03, 0.014, 0.02, 10), peg, 0.0},
        {"KnobInsideBox", knob, box(0.12, 0.09, 0.08), 1e-5},
        {"SpeckInsideTool", box(0.08, 0.06, 0.09), box(0.004, 0.003, 0.005), 1e-5},
        {"PegAndOpenBox", peg, open_box(0.06, 0.05, 0.03), 1e-5},
        {"OpenBoxAndRod", open_box(0.06, 0.05, 0.03), rod, 1e-4},
        {"KnobAndBoxWithSpeck", knob, box_and_speck(), 1e-5},
        {"BoxWithHoodAndKnob", box_and_hood(), knob, 1e-5},
        {"SmallBoxAndBoxWithHood", box(0.01, 0.012, 0.008), box_and_hood(), 1e-5},
    };
  }();
  return all;
}

/// Made when it is first asked for.
const Scene& scene_of(std::size_t pairing) {
  static std::map<std::size_t, Scene> made;
  return made.try_emplace(pairing, pairings()[pairing].tool, pairings()[pairing].target, pairings()[pairing].margin)
      .first->second;
}

/// A pose with a vertex of the target on a vertex of the robot somewhere on the way, drawn back until the two only just
/// touch, and then moved by at most a millimetre.
Pose pose_near_touching(const Scene& scene, const Motion& motion, Rng& rng) {
  const std::vector<Placed>& robot = motion.track[1 + rng.below(motion.track.size() - 1)];
  const Placed& part = robot[rng.below(2) == 0 ? 0 : rng.below(robot.size())];
  const std::vector<Vector3> of_target = scene.target.mesh().vertices;
  Pose pose = random_pose(rng, 0.0);
  const Vector3 direction = random_direction(rng);
  const Vector3 start =
      part.triangles[rng.below(part.triangles.size())][0] - pose.linear() * of_target[rng.below(of_target.size())];
  double touching = 0.0, free = 1.0;
  while (free - touching > 1e-9) {
    const double middle = 0.5 * (touching + free);
    pose.translation() = start + middle * direction;
    (reference::first_contact(motion.track, Placed(scene.target, pose), scene.margin) ? touching : free) = middle;
  }
  const double shift = std::pow(10.0, rng.uniform(-8.0, -3.0));
  pose.translation() = start + (touching + (rng.below(2) == 0 ? shift : -shift)) * direction;
  return pose;
}

/// Some vertex of the target is anywhere around the tool, or in it.
Pose pose_anywhere(const Scene& scene, const Motion& motion, Rng& rng) {
  const std::vector<Vector3> of_target = scene.target.mesh().vertices;
  Pose pose = random_pose(rng, 0.06);
  pose.translation() += motion.track[rng.below(motion.track.size())].front().ball.centre -
                        pose.linear() * of_target[rng.below(of_target.size())];
  return pose;
}

/// Whether a nanometre decides.
bool is_close_call(const Scene& scene, const Motion& motion, const Pose& pose, double radius, std::size_t from,
                   const std::optional<std::size_t>& answer) {
  for (int i = 0; i < 6; ++i) {
    Pose shifted = pose;
    shifted.translation()[i / 2] += i % 2 == 0 ? 1e-9 : -1e-9;
    if (reference::first_contact(motion.track, Placed(scene.target, shifted), radius, from) == answer) return true;
  }
  return false;
}

class TargetContactLaw : public testing::TestWithParam<int> {
 protected:
  const Scene& scene() const { return scene_of(static_cast<std::size_t>(GetParam())); }
  Rng rng{static_cast<std::uint64_t>(GetParam()) + 100};
};

TEST_P(TargetContactLaw, FirstContactIsThatOfEveryPairOfTriangles) {
  int close_calls = 0, contacts = 0, cases = 0;
  const TargetContact& contact = scene().contact;
  for (int m = 0; m < 30; ++m) {
    const Motion motion(scene(), random_waypoints(rng));
    for (int k = 0; k < 4; ++k, ++cases) {
      const Pose pose = k < 2 ? pose_near_touching(scene(), motion, rng) : pose_anywhere(scene(), motion, rng);
      const auto plain = reference::first_contact(motion.track, Placed(scene().target, pose), scene().margin);
      const auto found = contact.first_contact(motion.path, pose);
      contacts += plain.has_value();
      if (found != plain) {
        ASSERT_TRUE(is_close_call(scene(), motion, pose, scene().margin, 1, found))
            << "motion " << m << ", case " << k << ": found " << found.value_or(999) << ", not " << plain.value_or(999)
            << " of " << motion.path.size();
        ++close_calls;
      }
      if (found) {
        ASSERT_TRUE(contact.touches(motion.path, *found, pose));
        ASSERT_FALSE(*found > 1 && contact.touches(motion.path, *found - 1, pose));
      }
    }
  }
  EXPECT_LE(close_calls, 2);
  EXPECT_GT(contacts, cases / 5);
  EXPECT_LT(contacts, cases * 4 / 5);
}

/// Exact up to the margin; for wider reaches early by no more than the header says.
TEST_P(TargetContactLaw, FirstWithinIsThatOfEveryPairOfTriangles) {
  constexpr double largest_leaf_radius = 0.01;
  int close_calls = 0;
  for (int m = 0; m < 40; ++m) {
    const Motion motion(scene(), random_waypoints(rng));
    const Pose pose = m % 2 == 0 ? pose_near_touching(scene(), motion, rng) : pose_anywhere(scene(), motion, rng);
    for (const double radius : {0.0, rng.uniform(0.0, 0.002), rng.uniform(0.0, 0.1)}) {
      const std::size_t from = rng.below(motion.path.size() + 2);
      const auto plain = reference::first_contact(motion.track, Placed(scene().target, pose), radius, from);
      const auto found = scene().contact.first_within(motion.path, pose, radius, from);
      if (found == plain) continue;
      if (radius > scene().contact.margin()) {
        const double err = 2.0 * std::max(largest_leaf_radius, 0.4 * radius) + 1e-9;
        const auto earliest = reference::first_contact(motion.track, Placed(scene().target, pose), radius + err, from);
        EXPECT_LE(found.value_or(999), plain.value_or(999));
        EXPECT_GE(found.value_or(999), earliest.value_or(999)) << "motion " << m << ", radius " << radius;
        continue;
      }
      ASSERT_TRUE(is_close_call(scene(), motion, pose, radius, from, found))
          << "motion " << m << ", radius " << radius << ": found " << found.value_or(999) << ", not "
          << plain.value_or(999) << " of " << motion.path.size() << " from " << from;
      ++close_calls;
    }
  }
  EXPECT_LE(close_calls, 1);
}

double farthest_vertex(const Mesh& mesh) {
  double farthest = 0.0;
  for (const Vector3& v : mesh.vertices) farthest = std::max(farthest, v.norm());
  return farthest;
}

double largest_displacement(const Mesh& mesh, const Pose& a, const Pose& b) {
  double largest = 0.0;
  for (const Vector3& v : mesh.vertices) largest = std::max(largest, (a * v - b * v).norm());
  return largest;
}

/// An interval has to hold for each pose of a cell, and for one pose with no more radius than it needs.
TEST_P(TargetContactLaw, EveryPoseOfACellHasItsFirstContactInTheInterval) {
  const Mesh mesh = scene().target.mesh();
  int certain = 0, later = 0;
  const auto expect_inside = [&](const ContactInterval& interval, const Motion& motion, const Pose& pose) {
    const auto plain = reference::first_contact(motion.track, Placed(scene().target, pose), scene().margin);
    const std::size_t first = plain.value_or(motion.path.size());
    EXPECT_LE(interval.earliest, first);
    EXPECT_GE(interval.latest, first);
    certain += interval.latest < motion.path.size();
    later += interval.earliest > 1;
  };
  for (int m = 0; m < 40; ++m) {
    const Motion motion(scene(), random_waypoints(rng));
    const Pose near = m % 2 == 0 ? pose_near_touching(scene(), motion, rng) : pose_anywhere(scene(), motion, rng);
    const geometry::PoseVector centre = geometry::pose_vector(near);
    geometry::PoseVector half{};
    for (std::size_t d = 0; d < 6; ++d) half[d] = rng.below(4) == 0 ? 0.0 : rng.uniform(0.0, d < 3 ? 0.003 : 0.04);
    const double angle = half[3] + half[4] + half[5];
    const double radius = std::hypot(half[0], half[1], half[2]) + 2.0 * std::sin(0.5 * angle) * farthest_vertex(mesh);
    const ContactInterval interval = scene().contact.first_contact_interval(motion.path, near, radius);
    for (int k = 0; k < 8; ++k) {
      geometry::PoseVector drawn = centre;
      for (std::size_t d = 0; d < 6; ++d)
        drawn[d] += half[d] * (k < 4 ? rng.uniform(-1.0, 1.0) : 2.0 * static_cast<double>(rng.below(2)) - 1.0);
      const Pose pose = geometry::pose_from(drawn);
      const double displacement = largest_displacement(mesh, near, pose) + 1e-12;
      ASSERT_LE(displacement, radius + 1e-11);
      expect_inside(interval, motion, pose);
      expect_inside(scene().contact.first_contact_interval(motion.path, near, displacement), motion, pose);
    }
  }
  EXPECT_GT(later, 40);
  if (!scene().target.solids.empty()) {
    EXPECT_GT(certain, 10);
  } else {
    EXPECT_EQ(certain, 0) << "a surface has no depth";
  }
}

/// As far away in any direction as the radius allows, the pose itself still belongs to the interval.
TEST_P(TargetContactLaw, TheRadiusOfAnIntervalMayBeUsedUp) {
  for (int m = 0; m < 25; ++m) {
    const Motion motion(scene(), random_waypoints(rng));
    const Pose pose = pose_near_touching(scene(), motion, rng);
    const auto plain = reference::first_contact(motion.track, Placed(scene().target, pose), scene().margin);
    const std::size_t first = plain.value_or(motion.path.size());
    for (int k = 0; k < 40; ++k) {
      const double radius = std::pow(10.0, rng.uniform(-3.5, -1.5));
      Pose centre = pose;
      centre.translation() += radius * random_direction(rng);
      const ContactInterval interval = scene().contact.first_contact_interval(motion.path, centre, radius + 1e-9);
      ASSERT_LE(interval.earliest, first);
      ASSERT_GE(interval.latest, first);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, TargetContactLaw, testing::Range(0, 11),
                         [](const auto& scene) { return pairings()[static_cast<std::size_t>(scene.param)].name; });

TEST(TargetContact, APathOfOneWaypointHasNoContact) {
  const Scene& scene = scene_of(0);
  const JointVector q = JointVector::Zero(5);
  const BodyPath path(scene.contact.bodies(), {q});
  const Pose pose(Eigen::Translation3d(path.base_from_body(0, 0).translation()));
  EXPECT_TRUE(scene.contact.touches(path, 0, pose));
  EXPECT_FALSE(scene.contact.first_contact(path, pose));
  EXPECT_FALSE(scene.contact.first_contact(BodyPath(), pose));
}

TEST(TargetContact, AToolInsideAClosedBoxTouchesItAndInsideAnOpenOneDoesNot) {
  JointVector q = JointVector::Zero(5);
  for (const double size : {0.0004, 0.01}) {
    const double room = 3.0 * size;
    for (const bool open : {false, true}) {
      const Scene scene(box(size, size, size), open ? open_box(room, room, room) : box(room, room, room), 1e-5);
      const BodyPath path(scene.contact.bodies(), {q, q});
      const Pose pose(Eigen::Translation3d(path.base_from_body(0, 0).translation()));
      EXPECT_EQ(scene.contact.first_contact(path, pose).has_value(), !open) << size;
    }
  }
}

// --- paths

TEST(BodyPath, NoPointMovesFartherThanTravelled) {
  Rng rng(3);
  const Scene& scene = scene_of(0);
  for (int m = 0; m < 60; ++m) {
    const Motion motion(scene, random_waypoints(rng));
    const std::size_t n = motion.path.size();
    for (std::size_t b = 0; b < scene.arm.parts.size(); ++b)
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j)
          ASSERT_LE(
              largest_displacement(scene.arm.parts[b].shape.mesh(), motion.track[i][b].pose, motion.track[j][b].pose),
              motion.path.travelled(j, b) - motion.path.travelled(i, b) + 1e-12);
  }
}

TEST(BodyPath, TravelledIsTheLengthOfAWayWithoutTurns) {
  const Scene& scene = scene_of(0);
  JointVector from = JointVector::Zero(5), to = from;
  to.head<3>() << 0.03, -0.04, 0.12;
  const BodyPath path(scene.contact.bodies(), {from, 0.5 * (from + to), to});
  for (std::size_t b = 0; b < 2; ++b) EXPECT_NEAR(path.travelled(2, b), 0.13, 1e-12);
  EXPECT_NEAR(path.travelled(2, 2), 0.03, 1e-12) << "the beam moves along x only";
}

// --- voxels

/// Around the tool's way, at a place that no face of a shape is aligned with.
VoxelGrid grid_around(const Motion& motion, double pitch) {
  geometry::Box box;
  for (const std::vector<Placed>& robot : motion.track) box.add(robot.front().ball.centre);
  return VoxelGrid(box.inflated(0.0611), pitch);
}

TEST(SweptVoxels, AreThoseWhoseCentreSomeBodyHolds) {
  Rng rng(4);
  std::size_t total = 0;
  for (const std::size_t s : {0U, 2U, 3U, 7U}) {
    const Scene& scene = scene_of(s);
    for (int m = 0; m < 2; ++m) {
      std::vector<JointVector> waypoints = random_waypoints(rng);
      if (waypoints.size() > 10) waypoints.resize(10);
      const Motion motion(scene, waypoints);
      const VoxelGrid grid = grid_around(motion, 0.0073);
      const SweptVoxels swept = contact::swept_voxels(scene.contact.bodies(), motion.path, grid);
      ASSERT_EQ(swept.entered.size(), waypoints.size());

      std::set<std::size_t> plain;
      for (std::size_t i = 0; i < waypoints.size(); ++i) {
        for (std::size_t v = 0; v < grid.size(); ++v)
          for (const Placed& part : motion.track[i])
            if (holds(*part.shape, part.pose.inverse() * grid.centre(v))) plain.insert(v);
        ASSERT_EQ(swept.entered_by(i), plain.size()) << "waypoint " << i;
        const std::set<std::size_t> found(swept.voxels.begin(),
                                          swept.voxels.begin() + static_cast<std::ptrdiff_t>(swept.entered_by(i)));
        ASSERT_EQ(found, plain) << "waypoint " << i;
      }
      EXPECT_EQ(swept.voxels.size(), plain.size());
      total += plain.size();
    }
  }
  EXPECT_GT(total, 500U);
}

/// All that belongs there, and little more: the look-up of distances may err by a few millimetres.
TEST(ContactCandidates, AreTheVoxelsAroundTheSurfaceThatTheRobotHasNotFilledBefore) {
  constexpr double slack = 0.001, error = 0.008;
  Rng rng(5);
  const Scene& scene = scene_of(2);
  for (int m = 0; m < 6; ++m) {
    const Motion motion(scene, random_waypoints(rng));
    const VoxelGrid grid = grid_around(motion, 0.006);
    const std::size_t stop = 1 + rng.below(motion.path.size() - 1);
    const Bitset found = contact::contact_candidates(scene.contact.bodies(), motion.path, stop, grid, slack);
    const double near = grid.half_diagonal() + slack;
    for (std::size_t v = 0; v < grid.size(); ++v) {
      bool belongs = false, may = false;
      for (std::size_t b = 0; b < scene.arm.parts.size(); ++b) {
        const Placed &part = motion.track[stop][b], &before = motion.track[stop - 1][b];
        const Vector3 p = grid.centre(v);
        if (reference::gap(part.ball, {p, 0.0}) > near + error) continue;
        const double away = surface_from_point(part, p);
        const double depth = holds(*before.shape, before.pose.inverse() * p) ? surface_from_point(before, p) : 0.0;
        belongs = belongs || (away <= near && depth <= near);
        may = may || (away <= near + error && depth <= near + error);
      }
      ASSERT_TRUE(found.test(v) || !belongs);
      ASSERT_TRUE(!found.test(v) || may);
    }
    EXPECT_GT(found.count(), 0U);
  }
}

TEST(DistanceTo, IsTheNearestMemberOfAll) {
  Rng rng(6);
  for (const std::array<int, 3> shape :
       {std::array{17, 9, 13}, std::array{1, 21, 8}, std::array{11, 1, 1}, std::array{1, 1, 1}, std::array{5, 4, 40}})
    for (const double density : {0.0, 0.002, 0.05, 0.6, 1.0}) {
      const double pitch = 0.004;
      const VoxelGrid grid({Vector3::Zero(), pitch * Vector3(shape[0], shape[1], shape[2])}, pitch);
      ASSERT_EQ(grid.shape(), shape);
      Bitset members(grid.size());
      for (std::size_t v = 0; v < grid.size(); ++v)
        if (rng.uniform() < density) members.set(v);
      const std::vector<float> found = contact::distance_to(members, grid);
      ASSERT_EQ(found.size(), grid.size());
      for (std::size_t v = 0; v < grid.size(); ++v) {
        double nearest = 1e30;
        members.for_each([&](std::size_t m) { nearest = std::min(nearest, (grid.centre(m) - grid.centre(v)).norm()); });
        ASSERT_NEAR(found[v], nearest, 1e-6 * nearest) << "voxel " << v << ", density " << density;
      }
    }
}

}  // namespace
}  // namespace tactus
