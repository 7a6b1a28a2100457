// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "robot/model.hpp"
#include "support/rng.hpp"

namespace tactus::robot {

// Joint vectors are dof x 1 in the order of `model.joints`, links are indices into `model.links`, the root's frame is
// that of `model.links[0]`. A vector of the wrong size or an unknown link throws `invalid_argument`. Everything here
// may be called by any number of threads.

/// Pose of every link in the root's frame, in the order of `model.links`. O(links), allocates only to grow
/// `root_from_link`.
void forward(const RobotModel& model, const JointVector& q, std::vector<Pose>& root_from_link);
/// Pose of one link in the root's frame. O(depth).
Pose forward(const RobotModel& model, const JointVector& q, int link);

/// Geometric Jacobian of the origin of `link`, moved by `link_from_tip`: rows are linear (m), then angular (rad)
/// velocity in the root's frame; a column counts all that follows the joint (mimic). 6 x dof.
Eigen::MatrixXd jacobian(const RobotModel& model, const JointVector& q, int link,
                         const Pose& link_from_tip = Pose::Identity());

/// False also if a value is NaN.
bool inside_limits(const RobotModel& model, const JointVector& q, double tolerance = 1e-9);

/// The longest way any point within `reach[i]` metres of link i's origin may move between two configurations, over all
/// links: an upper bound, from the joints' displacements and the distances from their axes at both ends. Metres. A link
/// of negative reach has no points.
///
/// It holds on the way as well: at every configuration whose joints are between those of `from` and `to`, each point is
/// within the bound of where it is at `from`, and of where it is at `to`. O(links x depth), does not allocate once
/// warm.
double motion_bound(const RobotModel& model, const std::vector<double>& reach, const JointVector& from,
                    const JointVector& to);

struct InverseOptions {
  double position_tolerance = 1e-6;  ///< m
  double angle_tolerance = 1e-6;     ///< rad
  int iterations = 100;              ///< of damped least squares, from one seed
};

/// A configuration inside the limits near `seed` whose `link` stands at `root_from_link`, to the tolerances; none if
/// the descent from `seed` does not get there. Damped least squares with the limits as a box; deterministic. A joint
/// whose limits leave room for a whole turn goes where it has to and is then wound back, to the value inside its limits
/// nearest to `seed`: at the end of its range that is almost a turn away, so who follows a path looks at the step.
/// Joints that do not move `link` keep the seed's value (brought inside its limits). Throws `invalid_argument` for
/// numbers that are not finite or if more than 16 joints move the link.
std::optional<JointVector> inverse(const RobotModel& model, int link, const Pose& root_from_link,
                                   const JointVector& seed, const InverseOptions& options = {});

/// The same from `seed` and then from `restarts` random seeds; of what is found, up to `keep` different solutions, the
/// nearest to `seed` first. Whole turns that the limits leave room for make different solutions: each is given as
/// found, and turned the nearest to `seed`.
std::vector<JointVector> inverse_all(const RobotModel& model, int link, const Pose& root_from_link,
                                     const JointVector& seed, support::Rng& rng, int restarts = 50, int keep = 16,
                                     const InverseOptions& options = {});

}  // namespace tactus::robot
