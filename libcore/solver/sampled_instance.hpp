// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "action/task.hpp"
#include "solver/instance.hpp"
#include "support/rng.hpp"

namespace tactus::solver {

struct SampleOptions {
  std::size_t poses = 15;
  std::size_t configurations = 60;  ///< at most
  std::size_t motions = 6;          ///< sweeps and pokes, at most; beside them an insertion attempt at each pose
  double discount = 0.999;
};

/// A small instance of a task. Poses are drawn from the prior, those that an insertion attempt seats. Motions are the
/// attempts, the sweeps and pokes that together tell the poses apart best, and from where these end the most telling
/// small moves. To keep the configurations few, the robot backs off after a contact to the nearest of a few waypoints
/// of the motion, and after an attempt that failed to its home; the ways count.
///
/// Throws `invalid_argument` for options out of range, `motion_infeasible` if hardly any pose can be inserted at.
Instance sampled_instance(const action::Task& task, const SampleOptions& options, support::Rng& rng);

}  // namespace tactus::solver
