// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include "contact/reference.hpp"
#include "contact/target_contact.hpp"
#include "support/rng.hpp"

/// Random cases for the laws of contact: shapes of every sort, an arm that carries one of them, its motions, and poses
/// of a target of which half are within a millimetre of touching.
namespace tactus::test {

using contact::BodyPath;
using contact::TargetContact;
using geometry::Mesh;
using geometry::Pose;
using geometry::Vector3;
using reference::Part;
using reference::Placed;
using reference::Shape;
using robot::JointVector;
using support::Rng;

Shape box(double x, double y, double z);

/// A box without its bottom: a surface.
Shape open_box(double x, double y, double z);

/// Three slides and two turns, a tool at the tip.
struct Arm {
  std::shared_ptr<const robot::RobotModel> model;
  int tip = 0;
  std::vector<Part> parts;  ///< that move, the tool first
};

struct Scene {
  Scene(const Shape& tool, Shape its_target, double its_margin);

  Arm arm;
  Shape target;
  double margin;
  TargetContact contact;
};

struct Motion {
  Motion(const Scene& scene, const std::vector<JointVector>& waypoints);

  BodyPath path;
  reference::Track track;
};

struct Pairing {
  const char* name;
  Shape tool, target;
  double margin;
};

const std::vector<Pairing>& pairings();
std::string name_of_pairing(std::size_t pairing);

/// Made when it is first asked for.
const Scene& scene_of(std::size_t pairing);

Vector3 random_direction(Rng& rng);

/// Any orientation, at most `reach` m off.
Pose random_pose(Rng& rng, double reach);

/// Steps of uneven length, some of none: straight or turning, or leaps from anywhere to anywhere.
std::vector<JointVector> random_waypoints(Rng& rng);

/// A pose with a vertex of the target on a vertex of the robot somewhere on the way, drawn back until the two only just
/// touch, and then moved by at most a millimetre.
Pose pose_near_touching(const Scene& scene, const Motion& motion, Rng& rng);

/// Some vertex of the target is anywhere around the tool, or in it.
Pose pose_anywhere(const Scene& scene, const Motion& motion, Rng& rng);

/// Whether a nanometre decides.
bool is_close_call(const Scene& scene, const Motion& motion, const Pose& pose, double radius, std::size_t from,
                   const std::optional<std::size_t>& answer);

/// How far a point of the mesh is carried between two poses.
double largest_displacement(const Mesh& mesh, const Pose& a, const Pose& b);

/// The laws over all pairings: `GetParam()` is one's index.
class ContactLaw : public testing::TestWithParam<int> {
 protected:
  const Scene& scene() const { return scene_of(static_cast<std::size_t>(GetParam())); }
  Rng rng{static_cast<std::uint64_t>(GetParam()) + 100};
};

}  // namespace tactus::test
