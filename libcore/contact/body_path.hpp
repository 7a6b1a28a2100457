// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/body.hpp"
#include "robot/kinematics.hpp"

namespace tactus::contact {

/// The bodies of a robot that may touch the target: the tool, and every link that has a shape and moves. Const, shared.
class RobotBodies {
 public:
  /// `tool` stands in the tool link's frame. The tool is body 0, then the links from the tip to the base. `region`
  /// (base frame) holds every point that a target may occupy: where a body is clear of it nothing is looked up.
  RobotBodies(std::shared_ptr<const robot::RobotModel> model, int tool_link, const Mesh& tool,
              const geometry::Box& region = everywhere);

  static const geometry::Box everywhere;

  std::size_t size() const { return bodies_.size(); }
  const Body& body(std::size_t b) const { return *bodies_[b]; }
  int link(std::size_t b) const { return links_[b]; }
  int tool_link() const { return tool_link_; }
  const geometry::Box& region() const { return region_; }
  const robot::RobotModel& model() const { return *model_; }

  /// Pose of every body in the base frame at `q`, appended to `poses`.
  void append_poses(const robot::JointVector& q, std::vector<Pose>& poses) const;

 private:
  std::shared_ptr<const robot::RobotModel> model_;
  int tool_link_;
  geometry::Box region_;
  std::vector<std::unique_ptr<const Body>> bodies_;
  std::vector<int> links_;
};

/// Where the bodies are at each waypoint of a joint path, and how far they can have moved by then.
class BodyPath {
 public:
  BodyPath() = default;
  BodyPath(const RobotBodies& bodies, const std::vector<robot::JointVector>& waypoints);

  std::size_t size() const { return bodies_ == 0 ? 0 : poses_.size() / bodies_; }  ///< waypoints
  std::size_t bodies() const { return bodies_; }
  const Pose& base_from_body(std::size_t waypoint, std::size_t body) const { return poses_[waypoint * bodies_ + body]; }
  /// No point of the body has moved farther than `travelled(j, b) - travelled(i, b)` between the waypoints i < j.
  /// Metres.
  double travelled(std::size_t waypoint, std::size_t body) const { return travelled_[waypoint * bodies_ + body]; }

  /// The poses of a body at the waypoints [16 k, 16 k + 16), for the kernels; past the end the last is repeated.
  const kernel::PoseBlock& pose_block(std::size_t k, std::size_t body) const { return blocks_[k * bodies_ + body]; }

  /// Outside these waypoints the body is farther than `region_margin` from the bodies' region.
  struct Range {
    std::size_t begin = 0, end = 0;
  };
  const Range& near_region(std::size_t body) const { return near_region_[body]; }
  static constexpr double region_margin = 0.03;  ///< m

 private:
  void fill_blocks();

  std::size_t bodies_ = 0;
  std::vector<Pose> poses_;
  std::vector<double> travelled_;
  std::vector<kernel::PoseBlock> blocks_;
  std::vector<Range> near_region_;
};

}  // namespace tactus::contact
