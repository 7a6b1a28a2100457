// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scene/normal_over_boxes.hpp"

namespace tactus::scene {

using geometry::Pose;
using geometry::PoseVector;

/// Roughly where the target is, with this share of the probability.
struct Guess {
  Normal normal;
  double share;  ///< > 0
};

/// Where the target may be: a box over x, y, z (m), roll, pitch, yaw (rad) of its frame in the robot's base frame. A
/// width of 0 fixes a dimension. What the shares of the guesses leave of 1 is uniform; what of a guess lies outside the
/// box is cut off.
struct Prior {
  PoseVector centre{};
  PoseVector width{};            ///< full widths, >= 0, angles at most 2 pi
  std::vector<Guess> guesses{};  ///< of this width; their shares come to less than 1

  Pose central_pose() const { return geometry::pose_from(centre); }

  /// How likely a pose of the box is, 1 being what it is without guesses. Not made up for what is cut off: over the box
  /// it has a mean of at most 1. O(guesses).
  double density(const PoseVector& pose) const;

  /// Draws by the density, exactly. By rejection: a draw takes 1 / (1 - shares) tries on average at worst.
  Pose sample(support::Rng& rng) const;

  /// Whether `pose` lies in the box, to `tolerance` (m and rad); angles modulo 2 pi.
  bool contains(const PoseVector& pose, double tolerance = 1e-9) const;

  /// Whether some numbers in the box describe the pose (`box_holds`).
  bool contains(const Pose& base_from_target, double tolerance = 1e-9) const;
};

/// What a prior says of boxes of one size. A guess that is narrower than the boxes counts in the one in which it lies,
/// wherever in there.
class PriorOverBoxes {
 public:
  /// Boxes of half the widths `half`.
  PriorOverBoxes(const Prior& prior, const PoseVector& half);

  /// The mean of the prior's density over the box about `centre` (`NormalOverBoxes`). O(guesses), 0.2 us each.
  double density(const PoseVector& centre) const;

 private:
  struct Share {
    NormalOverBoxes normal;
    double share;
  };
  double uniform_ = 1.0, volume_;
  std::vector<Share> guesses_;
};

/// Whether some x, y, z, roll, pitch, yaw within `half` of `centre` describe the pose, to `tolerance` (m and rad):
/// angles modulo whole turns, and in every way in which roll, pitch and yaw describe the same rotation. Never for a
/// pose that is not finite.
bool box_holds(const PoseVector& centre, const PoseVector& half, const Pose& pose, double tolerance = 1e-9);

/// `angle` moved by multiples of 2 pi to lie nearest to `to`.
double nearest_angle(double angle, double to);

/// How far a point at most `reach` metres from the frame's origin can move when each of the six numbers changes by up
/// to `half` of it: half the diagonal of the translations plus the chords of the turns. The radius of a cell of poses.
double cell_radius(const PoseVector& half, double reach);

}  // namespace tactus::scene
