// SPDX-License-Identifier: BSD-3-Clause
#include "solver/predictions.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace tactus::solver {

std::size_t least_group(std::size_t count, int dimensions) {
  const double left = dimensions > 0 ? std::pow(static_cast<double>(count), 1.0 - 1.0 / dimensions) : 1.0;
  return static_cast<std::size_t>(std::max(1.0, std::round(0.5 * left)));
}

Predictions::Row& Predictions::row(const action::MotionPtr& motion) {
  const auto [entry, is_new] = rows_.try_emplace(motion.get());
  const std::vector<std::int32_t> unknown(is_new ? poses_.size() : 0, -1);
  if (is_new) entry->second = {motion, unknown, unknown};
  return entry->second;
}

std::size_t Predictions::first_contact(const action::MotionPtr& motion, std::size_t pose) {
  std::int32_t& stored = row(motion).first_contact[pose];
  if (stored < 0)
    stored = static_cast<std::int32_t>(
        task_->target_contact().first_contact(motion->bodies, poses_[pose]).value_or(motion->path.size()));
  return static_cast<std::size_t>(stored);
}

std::size_t Predictions::first_near(const action::MotionPtr& motion, std::size_t pose) {
  std::int32_t& stored = row(motion).first_near[pose];
  if (stored < 0 && blur_ > 0.0)
    stored = static_cast<std::int32_t>(
        task_->target_contact().first_within(motion->bodies, poses_[pose], blur_).value_or(motion->path.size()));
  if (stored < 0) stored = static_cast<std::int32_t>(first_contact(motion, pose));
  return static_cast<std::size_t>(stored);
}

const std::vector<std::int32_t>& Predictions::first_nears(const action::MotionPtr& motion) {
  for (std::size_t pose = 0; pose < poses_.size(); ++pose) first_near(motion, pose);
  return rows_.at(motion.get()).first_near;
}

bool Predictions::are_mostly_near(const action::MotionPtr& motion, const std::vector<std::size_t>& poses,
                                  std::size_t waypoint) {
  const auto near =
      std::count_if(poses.begin(), poses.end(), [&](std::size_t pose) { return first_near(motion, pose) <= waypoint; });
  return 2 * static_cast<std::size_t>(near) > poses.size();
}

const std::vector<std::int32_t>& Predictions::first_contacts(const action::MotionPtr& motion) {
  for (std::size_t pose = 0; pose < poses_.size(); ++pose) first_contact(motion, pose);
  return rows_.at(motion.get()).first_contact;
}

std::vector<Group> Predictions::split(const action::MotionPtr& motion, const support::Bitset& members,
                                      std::size_t least) {
  std::map<std::size_t, std::vector<std::size_t>> touched;
  members.for_each([&](std::size_t pose) { touched[first_contact(motion, pose)].push_back(pose); });
  std::vector<Group> groups;
  for (auto& [waypoint, poses] : touched) {
    if (waypoint == motion->path.size() || groups.empty() ||
        (groups.back().poses.size() >= least && !are_mostly_near(motion, poses, groups.back().first)))
      groups.push_back({waypoint, waypoint, {}});
    groups.back().last = waypoint;
    groups.back().poses.insert(groups.back().poses.end(), poses.begin(), poses.end());
  }
  for (Group& group : groups) std::sort(group.poses.begin(), group.poses.end());
  return groups;
}

support::Bitset Predictions::subset(const action::MotionPtr& motion, const support::Bitset& members, std::size_t first,
                                    std::size_t last) {
  support::Bitset kept(members.size());
  members.for_each([&](std::size_t pose) {
    const std::size_t at = first_contact(motion, pose);
    if (at >= first && at <= last) kept.set(pose);
  });
  return kept;
}

}  // namespace tactus::solver
