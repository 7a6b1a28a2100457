// SPDX-License-Identifier: BSD-3-Clause
#include "solver/predictions.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "support/parallel.hpp"
#include "support/rng.hpp"

namespace tactus::solver {

using action::MotionPtr;

std::size_t least_group(std::size_t count, int dimensions) {
  const double left = dimensions > 0 ? std::pow(static_cast<double>(count), 1.0 - 1.0 / dimensions) : 1.0;
  return static_cast<std::size_t>(std::max(1.0, std::round(0.5 * left)));
}

Predictions::Predictions(std::shared_ptr<const action::Task> task, std::vector<geometry::Pose> poses, double blur,
                         std::vector<double> misses, int threads, support::Cancellation cancellation)
    : task_(std::move(task)),
      poses_(std::move(poses)),
      misses_(std::move(misses)),
      blur_(blur),
      threads_(threads),
      cancellation_(cancellation, &time_limit_) {
  misses_.resize(poses_.size(), 0.0);
}

Predictions::Row& Predictions::row(const MotionPtr& motion) {
  const auto [entry, is_new] = rows_.try_emplace(motion.get());
  const std::vector<std::int32_t> unknown(is_new ? poses_.size() : 0, -1);
  if (is_new) entry->second = {motion, unknown, unknown};
  entry->second.asked_for = true;
  return entry->second;
}

void Predictions::take_over(const Predictions& earlier) {
  if (earlier.blur_ != blur_) return;
  std::unordered_map<std::uint64_t, std::size_t> before;
  for (std::size_t pose = 0; pose < earlier.poses_.size(); ++pose) before.emplace(earlier.key_of(pose), pose);
  std::vector<std::pair<std::size_t, std::size_t>> same;  // here, and there
  for (std::size_t pose = 0; pose < poses_.size(); ++pose)
    if (const auto there = before.find(key_of(pose)); there != before.end() &&
                                                      earlier.poses_[there->second].matrix() == poses_[pose].matrix() &&
                                                      earlier.misses_[there->second] == misses_[pose])
      same.emplace_back(pose, there->second);
  for (const auto& [motion, row] : earlier.rows_) {
    if (!row.asked_for || row.motion.use_count() == 1) continue;
    Row& taken = rows_[motion];
    taken = {row.motion, std::vector<std::int32_t>(poses_.size(), -1), std::vector<std::int32_t>(poses_.size(), -1)};
    for (const auto& [here, there] : same) {
      taken.first_contact[here] = row.first_contact[there];
      taken.first_near[here] = row.first_near[there];
    }
  }
}

std::uint64_t Predictions::key_of(std::size_t pose) const {
  std::uint64_t key = std::bit_cast<std::uint64_t>(misses_[pose]);
  for (const double value : poses_[pose].affine().reshaped())
    key = support::mix(key ^ std::bit_cast<std::uint64_t>(value));
  return key;
}

void Predictions::begins_as(const MotionPtr& part, const MotionPtr& whole) {
  const auto end = static_cast<std::int32_t>(part->path.size());
  Row known = row(whole);
  for (std::vector<std::int32_t>* firsts : {&known.first_contact, &known.first_near})
    for (std::int32_t& first : *firsts) first = std::min(first, end);
  known.motion = part;
  rows_[part.get()] = std::move(known);
}

/// What is not known yet of these poses.
void Predictions::look_at(Row& row, const support::Bitset& poses) const {
  std::vector<std::size_t> unknown;
  poses.for_each([&](std::size_t pose) {
    if (row.first_contact[pose] < 0) unknown.push_back(pose);
  });
  support::for_ranges(unknown.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) first_contact(row, unknown[i]);
  });
}

std::size_t Predictions::first_contact(const MotionPtr& motion, std::size_t pose) {
  return first_contact(row(motion), pose);
}

std::size_t Predictions::first_contact(Row& row, std::size_t pose) const {
  std::int32_t& stored = row.first_contact[pose];
  if (stored < 0) {
    cancellation_.check();
    const MotionPtr& motion = row.motion;
    const contact::TargetContact& target = task_->target_contact();
    double deeper = motion->kind == action::Kind::insertion ? 0.0 : misses_[pose];
    if (may_graze(motion)) deeper = std::max(deeper, 0.5 * blur_);
    const double within = target.margin() - deeper;
    const bool is_near_before = motion->anchored && blur_ > 0.0 && within <= blur_;  // and will be asked for
    const std::size_t from = is_near_before ? std::max<std::size_t>(1, first_near(row, pose)) : 1;
    stored = static_cast<std::int32_t>(
        target.first_within(motion->bodies, poses_[pose], within, from).value_or(motion->path.size()));
  }
  return static_cast<std::size_t>(stored);
}

std::size_t Predictions::first_near(Row& row, std::size_t pose) const {
  std::int32_t& stored = row.first_near[pose];
  if (stored < 0) cancellation_.check();
  if (stored < 0 && blur_ > 0.0)
    stored = static_cast<std::int32_t>(task_->target_contact()
                                           .first_within(row.motion->bodies, poses_[pose], blur_)
                                           .value_or(row.motion->path.size()));
  if (stored < 0) stored = static_cast<std::int32_t>(first_contact(row, pose));
  return static_cast<std::size_t>(stored);
}

const std::vector<std::int32_t>& Predictions::first_nears(const MotionPtr& motion) {
  Row& known = row(motion);
  support::for_ranges(poses_.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pose = begin; pose < end; ++pose) first_near(known, pose);
  });
  return known.first_near;
}

bool Predictions::are_mostly_near(Row& row, const std::vector<std::size_t>& poses, std::size_t waypoint) const {
  const auto near =
      std::count_if(poses.begin(), poses.end(), [&](std::size_t pose) { return first_near(row, pose) <= waypoint; });
  return 2 * static_cast<std::size_t>(near) > poses.size();
}

const std::vector<std::int32_t>& Predictions::first_contacts(const MotionPtr& motion) {
  Row& known = row(motion);
  look_at(known, support::Bitset(poses_.size(), true));
  return known.first_contact;
}

/// Where a pose that is not touched is grazed first; the path's size if it is not.
std::size_t Predictions::grazed(Row& row, std::size_t pose) const {
  return may_graze(row.motion) ? first_near(row, pose) : row.motion->path.size();
}

std::vector<Group> Predictions::split(const MotionPtr& motion, const support::Bitset& members, std::size_t least) {
  const std::size_t untouched = motion->path.size();
  Row& known = row(motion);
  look_at(known, members);
  std::map<std::size_t, std::vector<std::size_t>> touched;
  std::map<std::size_t, double> expected;
  members.for_each([&](std::size_t pose) {
    const std::size_t at = first_contact(known, pose);
    const std::size_t or_at = at == untouched ? grazed(known, pose) : at;
    for (const std::size_t waypoint : {at, or_at}) expected[waypoint] += 0.5;
    touched[at].push_back(pose);
    if (or_at != at) touched[or_at].push_back(pose);
  });
  const auto is_sure = [&](std::size_t waypoint, const std::vector<std::size_t>& poses) {
    return std::any_of(poses.begin(), poses.end(),
                       [&](std::size_t pose) { return first_contact(known, pose) == waypoint; });
  };
  std::vector<Group> groups;
  bool holds_sure = false;
  for (auto& [waypoint, poses] : touched) {
    const bool adds_sure = is_sure(waypoint, poses);
    if (waypoint == untouched || groups.empty() ||
        (holds_sure && adds_sure && groups.back().poses.size() >= least &&
         !are_mostly_near(known, poses, groups.back().first))) {
      groups.push_back({waypoint, waypoint, {}});
      holds_sure = false;
    }
    holds_sure = holds_sure || adds_sure;
    groups.back().last = waypoint;
    groups.back().poses.insert(groups.back().poses.end(), poses.begin(), poses.end());
    groups.back().expected += expected[waypoint];
  }
  for (Group& group : groups) std::sort(group.poses.begin(), group.poses.end());
  return groups;
}

std::size_t Predictions::least_told_apart(const MotionPtr& motion, const support::Bitset& members, int dimensions) {
  Row& known = row(motion);
  look_at(known, members);
  std::size_t touched = 0;
  members.for_each([&](std::size_t pose) { touched += first_contact(known, pose) < motion->path.size(); });
  return least_group(touched, dimensions);
}

support::Bitset Predictions::subset(const MotionPtr& motion, const support::Bitset& members, std::size_t first,
                                    std::size_t last) {
  Row& known = row(motion);
  support::Bitset kept(members.size());
  members.for_each([&](std::size_t pose) {
    const std::size_t at = first_contact(known, pose);
    const auto is_within = [&](std::size_t waypoint) { return waypoint >= first && waypoint <= last; };
    if (is_within(at) || (at == motion->path.size() && is_within(grazed(known, pose)))) kept.set(pose);
  });
  return kept;
}

}  // namespace tactus::solver
