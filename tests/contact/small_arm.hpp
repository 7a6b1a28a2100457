// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "robot/model.hpp"
#include "support/rng.hpp"

namespace tactus::test {

using Model = std::shared_ptr<const robot::RobotModel>;

/// A six-jointed arm of boxes and cylinders, about 1.2 m long, with a plate as its tool; it stands at the origin and
/// points up when all joints are zero.
Model small_arm();

/// The maker's UR10e without its SRDF; null when its files are not on this machine. They are looked for in the folder
/// that the environment variable TACTUS_TEST_MODELS names, by default in `../shared/models` beside the sources.
Model makers_ur10e();

/// Uniform inside the limits.
robot::JointVector random_configuration(const robot::RobotModel& model, support::Rng& rng);

/// Joint values from a list.
robot::JointVector joints(std::initializer_list<double> values);

}  // namespace tactus::test
