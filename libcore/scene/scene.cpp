// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::scene {
namespace {

constexpr double angle_step = 0.1;  // rad between the turns at which the target's box is taken

/// Offsets from the centre of a range at which it is sampled: both ends, and no farther than `step` apart.
std::vector<double> samples(double width, double step) {
  if (width == 0.0) return {0.0};
  const int intervals = static_cast<int>(std::ceil(width / step));
  std::vector<double> offsets;
  for (int i = 0; i <= intervals; ++i) offsets.push_back(width * (static_cast<double>(i) / intervals - 0.5));
  return offsets;
}

double reach_of(const Mesh& mesh) {
  double reach = 0.0;
  for (const Vector3& v : mesh.vertices) reach = std::max(reach, v.norm());
  return reach;
}

}  // namespace

bool Scene::is_seated(const Pose& base_from_tool, const Pose& base_from_target, const PoseVector& half) const {
  const auto is_at = [&](const Pose& target_from_seated) {
    const Vector3 got = base_from_tool * target_from_seated.inverse().translation();
    return (base_from_target.translation() - got).norm() + cell_radius(half, 0.0) <= target.position_tolerance &&
           geometry::angle_between(base_from_target * target_from_seated, base_from_tool) + half[3] + half[4] +
                   half[5] <=
               target.angle_tolerance;
  };
  return std::any_of(target.target_from_seated.begin(), target.target_from_seated.end(), is_at);
}

Box target_region(const Scene& scene, const Pose& frame_from_base) {
  const Prior& prior = scene.prior;
  Box about_origin;  // of the target turned in every way, its origin staying where it is
  double gap = 0.0;
  for (int d = 3; d < 6; ++d) gap += prior.width[d] > 0.0 ? 0.5 * angle_step : 0.0;
  for (const double roll : samples(prior.width[3], angle_step))
    for (const double pitch : samples(prior.width[4], angle_step))
      for (const double yaw : samples(prior.width[5], angle_step)) {
        const Pose turned = geometry::pose_from(
            {0.0, 0.0, 0.0, prior.centre[3] + roll, prior.centre[4] + pitch, prior.centre[5] + yaw});
        for (const Vector3& v : scene.target.mesh.vertices)
          about_origin.add(frame_from_base.linear() * (turned.linear() * v));
      }
  about_origin = about_origin.inflated(reach_of(scene.target.mesh) * (1.0 - std::cos(gap)));

  Box origins;
  for (int corner = 0; corner < 8; ++corner) {
    Vector3 p;
    for (int d = 0; d < 3; ++d) p[d] = prior.centre[d] + prior.width[d] * (corner >> d & 1 ? 0.5 : -0.5);
    origins.add(frame_from_base * p);
  }
  return {origins.low + about_origin.low, origins.high + about_origin.high};
}

Pose SearchFrame::base_from_tool(const Vector3& position, double turn) const {
  Pose search_from_placed = Pose::Identity();
  search_from_placed.translation() = position;
  search_from_placed.linear() =
      Eigen::AngleAxisd(turn, Vector3::UnitZ()).toRotationMatrix() * search_from_tool.linear();
  return base_from_search * search_from_placed;
}

Eigen::Matrix3d SearchFrame::tool_axes(const Pose& base_from_tool) const {
  const Vector3 axis = base_from_tool.linear() * (search_from_tool.linear().transpose() * Vector3::UnitZ());
  const Eigen::Matrix3d axes = base_from_search.linear();
  return Eigen::Quaterniond::FromTwoVectors(axes.col(2), axis).toRotationMatrix() * axes;
}

SearchFrame search_frame(const Scene& scene, double clearance) {
  const Pose base_from_target = scene.prior.central_pose();
  const Pose base_from_seated = scene.seated(base_from_target);
  const Vector3 z = base_from_target.linear() * scene.target.approach_axis;
  Vector3 x = base_from_seated.linear().col(0);
  if (std::abs(x.dot(z)) > 0.9) x = base_from_seated.linear().col(1);
  x = (x - x.dot(z) * z).normalized();

  SearchFrame frame;
  frame.base_from_search.translation() = base_from_target.translation();
  frame.base_from_search.linear() << x, z.cross(x), z;
  frame.search_from_tool.linear() = frame.base_from_search.linear().transpose() * base_from_seated.linear();
  frame.region = target_region(scene, frame.base_from_search.inverse());
  for (const Vector3& v : scene.tool.vertices) frame.tool_extent.add(frame.search_from_tool * v);
  frame.standoff = frame.region.low.z() - clearance - frame.tool_extent.high.z();
  return frame;
}

}  // namespace tactus::scene
