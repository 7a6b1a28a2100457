// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>

namespace tactus::geometry {

using Vector3 = Eigen::Vector3d;
using Pose = Eigen::Isometry3d;

/// x, y, z in metres, roll, pitch, yaw in radians (URDF's: about the fixed axes x, then y, then z).
using PoseVector = std::array<double, 6>;

Pose pose_from(const PoseVector& xyzrpy);

/// The inverse of `pose_from`: pitch in [-pi/2, pi/2], roll and yaw in (-pi, pi].
PoseVector pose_vector(const Pose& pose);

/// x y z qx qy qz qw, as in the C ABI. The quaternion is normalised; it must not be zero.
Pose pose_from_quaternion(const double (&xyzq)[7]);
void to_quaternion(const Pose& pose, double (&xyzq)[7]);

/// The angle in [0, pi] by which `a` is turned against `b`.
double angle_between(const Pose& a, const Pose& b);

/// Straight in position, slerp in rotation; `fraction` in [0, 1].
Pose interpolate(const Pose& from, const Pose& to, double fraction);

/// Rotation vector (axis times angle) of a rotation, angle in [0, pi].
Vector3 rotation_vector(const Eigen::Matrix3d& rotation);

}  // namespace tactus::geometry
