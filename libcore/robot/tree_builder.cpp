// SPDX-License-Identifier: BSD-3-Clause
#include "robot/tree_builder.hpp"

#include <algorithm>
#include <limits>

#include "support/log.hpp"

namespace tactus::robot {
namespace {

using geometry::Vector3;

constexpr double unstated_velocity = 1.0;  // rad/s, of a continuous joint without limits

void warn(const std::string& text) { support::log(support::LogLevel::warning, text); }

Vector3 vector_from(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

JointKind kind_of(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::REVOLUTE:
      return JointKind::revolute;
    case urdf::Joint::CONTINUOUS:
      return JointKind::continuous;
    case urdf::Joint::PRISMATIC:
      return JointKind::prismatic;
    default:
      return JointKind::fixed;
  }
}

double velocity_of(const urdf::Joint& joint) {
  if (joint.limits != nullptr) return joint.limits->velocity;
  warn("joint " + joint.name + " states no velocity limit; 1 rad/s is assumed");
  return unstated_velocity;
}

Joint independent(const urdf::Joint& joint) {
  Joint made{joint.name, kind_of(joint), 0.0, 0.0, velocity_of(joint)};
  const bool endless = made.kind == JointKind::continuous;
  made.lower = endless ? -std::numeric_limits<double>::infinity() : joint.limits->lower;
  made.upper = endless ? std::numeric_limits<double>::infinity() : joint.limits->upper;
  return made;
}

class TreeBuilder {
 public:
  TreeBuilder(const urdf::ModelInterface& parsed, const UrdfOutline& outline) {
    for (const JointOutline& joint : outline.joints) below_[joint.parent].push_back(parsed.getJoint(joint.name).get());
    model_.name = parsed.getName();
    model_.links.emplace_back().name = parsed.getRoot()->name;
    add_children(0);
    for (const auto& [link, joint] : followers_) follow(model_.links[static_cast<std::size_t>(link)], *joint);
  }

  RobotModel take() { return std::move(model_); }

 private:
  void add_children(int parent) {
    const auto joints = below_.find(model_.links[static_cast<std::size_t>(parent)].name);
    if (joints == below_.end()) return;
    for (const urdf::Joint* joint : joints->second) {
      add_link(*joint, parent);
      add_children(static_cast<int>(model_.links.size()) - 1);
    }
  }

  void add_link(const urdf::Joint& joint, int parent) {
    Link& link = model_.links.emplace_back();
    link.name = joint.child_link_name;
    link.parent = parent;
    link.parent_from_joint = pose_from(joint.parent_to_joint_origin_transform);
    link.joint_kind = kind_of(joint);
    if (link.joint_kind == JointKind::fixed) return;
    link.axis = vector_from(joint.axis).normalized();
    if (joint.mimic != nullptr) {
      followers_.emplace_back(static_cast<int>(model_.links.size()) - 1, &joint);
    } else {
      link.joint = model_.dof();
      model_.joints.push_back(independent(joint));
    }
  }

  void follow(Link& link, const urdf::Joint& joint) {
    const auto named = [&](const Joint& candidate) { return candidate.name == joint.mimic->joint_name; };
    const auto leader = std::find_if(model_.joints.begin(), model_.joints.end(), named);
    link.joint = static_cast<int>(leader - model_.joints.begin());
    link.multiplier = joint.mimic->multiplier;
    link.offset = joint.mimic->offset;
    if (joint.limits == nullptr) return;
    if (link.multiplier != 0.0)
      leader->velocity = std::min(leader->velocity, joint.limits->velocity / std::abs(link.multiplier));
    const double at_lower = link.multiplier * leader->lower + link.offset;
    const double at_upper = link.multiplier * leader->upper + link.offset;
    const auto [low, high] = std::minmax(at_lower, at_upper);
    if (link.joint_kind != JointKind::continuous &&
        (low < joint.limits->lower - 1e-6 || high > joint.limits->upper + 1e-6))
      warn("joint " + joint.name + " leaves its own limits when it follows " + leader->name + "; those of " +
           leader->name + " hold");
  }

  RobotModel model_;
  std::map<std::string, std::vector<const urdf::Joint*>> below_;  ///< the joints that each link carries
  std::vector<std::pair<int, const urdf::Joint*>> followers_;     ///< mimic joints and the links they move
};

}  // namespace

Pose pose_from(const urdf::Pose& p) {
  Pose pose = Pose::Identity();
  pose.translation() = vector_from(p.position);
  pose.linear() =
      Eigen::Quaterniond(p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z).normalized().toRotationMatrix();
  return pose;
}

RobotModel build_tree(const urdf::ModelInterface& parsed, const UrdfOutline& outline) {
  return TreeBuilder(parsed, outline).take();
}

}  // namespace tactus::robot
