// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "robot/model.hpp"

namespace tactus::robot {

/// The moving joints between the root and one link, with what is fixed between them multiplied out: what an inverse has
/// to go through again and again. Of fixed size, so that nothing is allocated on the way.
class Chain {
 public:
  static constexpr int most_joints = 16;
  using Values =
      Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_joints, 1>;  ///< of the independent joints, columns() x 1
  using Jacobian =
      Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, most_joints>;  ///< 6 x columns(), as `jacobian` has it

  /// Throws `invalid_argument` if more than `most_joints` joints move the link, or there is no such link.
  Chain(const RobotModel& model, int link);

  int columns() const { return columns_; }
  int joint(int column) const { return joints_[static_cast<std::size_t>(column)]; }  ///< index into the joint vector
  /// True if a whole turn of the joint changes nothing: it turns, and no other joint follows it.
  bool turns_freely(int column) const { return turns_freely_[static_cast<std::size_t>(column)]; }

  Pose forward(const Values& values) const;
  /// The link's pose and how it moves.
  Pose forward(const Values& values, Jacobian& jacobian) const;

 private:
  struct Segment {
    Pose before;  ///< of the joint's frame, from the frame of the segment before
    geometry::Vector3 axis;
    bool turning;
    int column;
    double multiplier, offset;
  };
  Pose through(const Segment& segment, double value) const;
  int column_of(int joint);

  std::array<Segment, most_joints> segments_;
  std::array<int, most_joints> joints_{};
  std::array<bool, most_joints> turns_freely_{};
  int count_ = 0, columns_ = 0;
  Pose tip_ = Pose::Identity();  ///< of the link, from the last segment
};

}  // namespace tactus::robot
