// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/pose.hpp"

#include <cmath>

namespace tactus::geometry {
namespace {

constexpr double gimbal_lock = 1e-12;  // of the pitch's cosine: roll and yaw show no more than their sum

}  // namespace

Pose pose_from(const PoseVector& v) {
  Pose pose = Pose::Identity();
  pose.translation() = Vector3(v[0], v[1], v[2]);
  pose.linear() = (Eigen::AngleAxisd(v[5], Vector3::UnitZ()) * Eigen::AngleAxisd(v[4], Vector3::UnitY()) *
                   Eigen::AngleAxisd(v[3], Vector3::UnitX()))
                      .toRotationMatrix();
  return pose;
}

PoseVector pose_vector(const Pose& pose) {
  const Eigen::Matrix3d r = pose.rotation();
  const Vector3 t = pose.translation();
  const double cosine = std::hypot(r(2, 1), r(2, 2)), pitch = std::atan2(-r(2, 0), cosine);
  const double roll = cosine > gimbal_lock ? std::atan2(r(2, 1), r(2, 2)) : 0.0;
  const double s = std::sin(roll), c = std::cos(roll);
  return {t.x(), t.y(), t.z(), roll, pitch, std::atan2(s * r(0, 2) - c * r(0, 1), c * r(1, 1) - s * r(1, 2))};
}

Pose pose_from_quaternion(const double (&v)[7]) {
  Pose pose = Pose::Identity();
  pose.translation() = Vector3(v[0], v[1], v[2]);
  pose.linear() = Eigen::Quaterniond(v[6], v[3], v[4], v[5]).normalized().toRotationMatrix();
  return pose;
}

void to_quaternion(const Pose& pose, double (&v)[7]) {
  const Eigen::Quaterniond q(pose.rotation());
  for (int i = 0; i < 3; ++i) v[i] = pose.translation()[i];
  v[3] = q.x();
  v[4] = q.y();
  v[5] = q.z();
  v[6] = q.w();
}

double angle_between(const Pose& a, const Pose& b) {
  return rotation_vector(a.rotation().transpose() * b.rotation()).norm();
}

Pose interpolate(const Pose& from, const Pose& to, double fraction) {
  Pose pose = Pose::Identity();
  pose.translation() = (1.0 - fraction) * from.translation() + fraction * to.translation();
  pose.linear() =
      Eigen::Quaterniond(from.rotation()).slerp(fraction, Eigen::Quaterniond(to.rotation())).toRotationMatrix();
  return pose;
}

Vector3 rotation_vector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

}  // namespace tactus::geometry
