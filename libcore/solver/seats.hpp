// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <unordered_map>
#include <vector>

#include "action/motion.hpp"
#include "support/bitset.hpp"
#include "support/cancellation.hpp"

namespace tactus::solver {

/// An insertion attempt at a supposed pose, as far as it need be known to weigh it: over the retreat plane, or from
/// where the tool is (`near_insertion`).
struct Attempt {
  geometry::Pose base_from_start = geometry::Pose::Identity();   ///< of the tool, on the retreat plane
  geometry::Pose base_from_seated = geometry::Pose::Identity();  ///< of the tool
  double cost = 0.0;                                             ///< from the one to the other, in units of cost
  geometry::Vector3 axis() const {
    return (base_from_seated.translation() - base_from_start.translation()).normalized();
  }
};

/// Where the tool is seated at each of a planning call's poses, and the attempts to get it there. Every pose has the
/// seats of the target; those of one pose are counted one after another. One thread.
class Seats {
 public:
  /// `plane`: the height in the search frame of the retreat plane from which attempts set out. What takes time throws
  /// `Cancelled` or `OutOfTime` when `cancellation` does.
  Seats(std::shared_ptr<const action::Task> task, std::vector<geometry::Pose> poses, double plane,
        support::Cancellation cancellation);

  /// Cost of getting the tool to the best seat of a pose, the straight way: never more than what it comes to.
  double direct_cost(const geometry::Pose& base_from_tool, std::size_t pose) const;

  /// Attempts at the seats of `members` that have the most others near by, each for a different group of poses, up to
  /// `most` groups; if `nears`, from where the tool is at `q`, and by the retreat plane at the first few, or where it
  /// can't get there else. Where several seats of a pose are as good the nearest counts, and the others if the arm
  /// can't get there.
  std::vector<action::MotionPtr> attempts(const support::Bitset& members, const robot::JointVector& q, std::size_t most,
                                          bool nears);

  /// By pose: the attempt at its first seat from the retreat plane, as `action::insertion` has it, and the poses whose
  /// first seat it may serve.
  std::vector<Attempt> first_attempts() const;
  std::vector<support::Bitset> served_at_first() const;

 private:
  std::size_t each() const { return task_->scene().target.target_from_seated.size(); }  ///< seats of a pose
  void find_neighbours();
  Attempt attempt_at(std::size_t seat) const;
  double direct_cost_to(const geometry::Pose& base_from_tool, std::size_t seat) const;
  std::vector<std::size_t> nearest_first(const support::Bitset& members, const robot::JointVector& q) const;
  std::size_t densest(const std::vector<std::size_t>& order, const support::Bitset& left) const;
  support::Bitset served(std::size_t seat, const support::Bitset& left) const;
  action::MotionPtr insertion_at(std::size_t seat, const robot::JointVector& near);
  action::MotionPtr near_insertion_at(std::size_t seat, const robot::JointVector& q);

  std::shared_ptr<const action::Task> task_;
  std::vector<geometry::Pose> poses_;
  double plane_;
  support::Cancellation cancellation_;
  std::vector<geometry::Pose> base_from_seated_;  ///< by seat, of the tool link
  std::vector<support::Bitset> neighbours_;       ///< by seat: those that one attempt may serve, itself among them
  std::unordered_map<std::size_t, action::MotionPtr> insertions_;
  std::map<std::pair<std::uint64_t, std::size_t>, action::MotionPtr> near_insertions_;  ///< by where from, and seat
};

}  // namespace tactus::solver
