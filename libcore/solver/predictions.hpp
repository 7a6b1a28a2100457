// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unordered_map>
#include <vector>

#include "action/motion.hpp"
#include "support/bitset.hpp"
#include "support/cancellation.hpp"

namespace tactus::solver {

/// Poses of which a motion's outcome says nothing more than that they are first touched at `first` to `last`.
struct Group {
  std::size_t first = 0, last = 0;  ///< waypoints; the path's size for those that are not touched
  std::vector<std::size_t> poses;   ///< that may have given it, ascending
  double expected = 0.0;            ///< how many of them: those that it grazes count half, and half as not touched
};

/// As far as a contact tells some poses apart: were `count` of them laid out evenly in so many dimensions, a contact
/// would take one of these away, and leave count^((d-1)/d). The half of that, so that where poses are few a contact
/// does not seem to say all there is to know.
std::size_t least_group(std::size_t count, int dimensions);

/// Where each of a planning call's poses is first touched on each motion, computed once. To be asked by one thread.
class Predictions {
 public:
  /// `blur`: m before a reported stop within which the contact may lie. `misses`: m by which each pose may be off; the
  /// target counts as touched where the robot goes deeper into it than that, but for insertions: a pose that grazes the
  /// robot where it is would be touched by whatever it does next. Empty: none is off.
  ///
  /// A small motion grazes a target into which it does not go by half the blur, and to which it comes as near as the
  /// blur: one that goes along what the robot has just touched, mostly. Whether that ends in a contact says nothing of
  /// use about where the target is.
  ///
  /// `threads` that look at the poses of a motion, as in `support::for_ranges`; the answers are the same. All that
  /// looks at poses throws `Cancelled` or `OutOfTime` when it is to end; what was found until then is kept.
  Predictions(std::shared_ptr<const action::Task> task, std::vector<geometry::Pose> poses, double blur = 0.0,
              std::vector<double> misses = {}, int threads = 1, support::Cancellation cancellation = {});

  const std::vector<geometry::Pose>& poses() const { return poses_; }
  const support::Cancellation& cancellation() const { return cancellation_; }

  /// Of all that asks `cancellation()`, which throws `OutOfTime` when it is over. There is none at first.
  support::TimeLimit& time_limit() { return time_limit_; }

  /// What was found for an earlier planning call, of the poses that are the same and off by as much, on the motions
  /// that it asked for and somebody else still holds. The same answers as without.
  void take_over(const Predictions& earlier);

  /// `part` is how `whole`, which is anchored, begins: it need not be looked at again.
  void begins_as(const action::MotionPtr& part, const action::MotionPtr& whole);

  /// The waypoint of the first contact that counts; the path's size if there is none.
  std::size_t first_contact(const action::MotionPtr& motion, std::size_t pose);

  /// The same of every pose.
  const std::vector<std::int32_t>& first_contacts(const action::MotionPtr& motion);

  /// The first waypoint at which each pose is within the blur.
  const std::vector<std::int32_t>& first_nears(const action::MotionPtr& motion);

  /// The members of a set of poses by their first contact, ascending; first contacts that few poses share are put
  /// together with the next until they have `least` poses, and with those of which most come within the blur at the
  /// first; but never with those that are not touched.
  std::vector<Group> split(const action::MotionPtr& motion, const support::Bitset& members, std::size_t least = 1);

  /// `least_group` of those of a set that the motion touches.
  std::size_t least_told_apart(const action::MotionPtr& motion, const support::Bitset& members, int dimensions);

  /// Those of a set whose first contact is at `first` to `last`.
  support::Bitset subset(const action::MotionPtr& motion, const support::Bitset& members, std::size_t first,
                         std::size_t last);

 private:
  struct Row {
    action::MotionPtr motion;                 ///< kept, so that no address is used twice
    std::vector<std::int32_t> first_contact;  ///< by pose; -1: not computed yet
    std::vector<std::int32_t> first_near;     ///< within the blur; as above
    bool asked_for = false;                   ///< since it was taken over
  };

  Row& row(const action::MotionPtr& motion);
  void look_at(Row& row, const support::Bitset& poses) const;
  std::size_t first_contact(Row& row, std::size_t pose) const;
  std::size_t first_near(Row& row, std::size_t pose) const;
  std::uint64_t key_of(std::size_t pose) const;
  bool may_graze(const action::MotionPtr& motion) const { return blur_ > 0.0 && !motion->anchored; }
  std::size_t grazed(Row& row, std::size_t pose) const;
  bool are_mostly_near(Row& row, const std::vector<std::size_t>& poses, std::size_t waypoint) const;

  std::shared_ptr<const action::Task> task_;
  std::vector<geometry::Pose> poses_;
  std::vector<double> misses_;  ///< by pose
  double blur_;
  int threads_;
  support::TimeLimit time_limit_;
  support::Cancellation cancellation_;
  std::unordered_map<const action::Motion*, Row> rows_;
};

}  // namespace tactus::solver
