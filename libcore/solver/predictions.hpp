// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <unordered_map>

#include "action/motion.hpp"
#include "support/bitset.hpp"

namespace tactus::solver {

/// Where each of a planning call's poses is first touched on each motion, computed once. One thread.
class Predictions {
 public:
  Predictions(std::shared_ptr<const action::Task> task, std::vector<geometry::Pose> poses)
      : task_(std::move(task)), poses_(std::move(poses)) {}

  const std::vector<geometry::Pose>& poses() const { return poses_; }

  /// The waypoint of the first contact; the path's size if there is none.
  std::size_t first_contact(const action::MotionPtr& motion, std::size_t pose);

  /// The same of every pose.
  const std::vector<std::int32_t>& first_contacts(const action::MotionPtr& motion);

  /// The members of a set of poses by their first contact, ascending.
  std::map<std::size_t, std::vector<std::size_t>> split(const action::MotionPtr& motion,
                                                        const support::Bitset& members);

  /// Those of a set whose first contact is at `waypoint`.
  support::Bitset subset(const action::MotionPtr& motion, const support::Bitset& members, std::size_t waypoint);

 private:
  struct Row {
    action::MotionPtr motion;                 ///< kept, so that no address is used twice
    std::vector<std::int32_t> first_contact;  ///< by pose; -1: not computed yet
  };

  std::shared_ptr<const action::Task> task_;
  std::vector<geometry::Pose> poses_;
  std::unordered_map<const action::Motion*, Row> rows_;
};

}  // namespace tactus::solver
