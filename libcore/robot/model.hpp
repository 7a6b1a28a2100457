// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "geometry/mesh.hpp"

namespace tactus::robot {

using geometry::Pose;
using JointVector = Eigen::VectorXd;  ///< radians or metres, dof x 1, in the order of `RobotModel::joints`

enum class JointKind { fixed, revolute, continuous, prismatic };

/// A link and the joint that carries it; links stand in an order in which every parent comes before its children.
struct Link {
  std::string name;
  int parent = -1;  ///< index of the parent link; -1 for the root
  Pose parent_from_joint = Pose::Identity();
  JointKind joint_kind = JointKind::fixed;
  geometry::Vector3 axis = geometry::Vector3::UnitX();  ///< of the joint, unit, in the joint's frame
  int joint = -1;                                       ///< index into the joint vector that moves it; -1 if fixed
  double multiplier = 1.0, offset = 0.0;                ///< mimic: value = multiplier * q[joint] + offset
  std::vector<geometry::Mesh> shapes;                   ///< collision shapes, in the link's frame, metres
};

/// One independent joint (mimic and fixed ones are none).
struct Joint {
  std::string name;
  JointKind kind = JointKind::revolute;
  double lower = 0.0, upper = 0.0;  ///< rad or m; continuous joints have -inf, inf
  double velocity = 0.0;            ///< rad/s or m/s, > 0; what follows the joint (mimic) keeps its own limit, too
};

/// A pair of links that need not be checked against each other (indices, first < second).
using LinkPair = std::pair<int, int>;

/// A robot as read from a URDF: const after loading, shared by any number of threads.
struct RobotModel {
  std::string name;
  std::vector<Link> links;
  std::vector<Joint> joints;             ///< dof of them
  std::vector<LinkPair> disabled_pairs;  ///< from the SRDF, if one was given
  int dof() const { return static_cast<int>(joints.size()); }
  int find_link(const std::string& name) const;  ///< -1 if there is none
};

struct ModelSource {
  std::filesystem::path urdf;
  std::map<std::string, std::filesystem::path>
      package_roots;           ///< package name -> folder; "" -> folders, divided by ':', that hold others
  std::filesystem::path srdf;  ///< empty: none
};

/// Reads and validates a URDF and its collision meshes. Boxes, cylinders and spheres become closed meshes that enclose
/// them. Only links with their collisions and joints are read; visuals, inertias and extensions may be anything. Meshes
/// are named by `package://` (below the package's root, never outside), `file://`, an absolute path, or a path from the
/// URDF's folder.
///
/// Joints must be fixed, revolute, continuous or prismatic, with a velocity limit > 0; a continuous joint without one
/// gets 1 rad/s. That, a mimic joint that may leave its own limits (those of the joint it follows hold) and a robot
/// without collisions are logged as warnings.
///
/// Throws `file_not_found`, `file_unreadable` or `bad_robot` with everything that is wrong (see `support::Problem`):
/// malformed XML, more than 8 MiB or 64 nested elements, a collision element that the parser dropped, cycles, two
/// parents, missing mimic targets, NaN, zero axes, lower > upper, negative sizes, meshes that are missing, broken or
/// outside the package roots, unknown links in the SRDF.
RobotModel load_model(const ModelSource& source);

}  // namespace tactus::robot
