// SPDX-License-Identifier: BSD-3-Clause
#include "solver/predictions.hpp"

namespace tactus::solver {

std::size_t Predictions::first_contact(const action::MotionPtr& motion, std::size_t pose) {
  auto [entry, is_new] = rows_.try_emplace(motion.get());
  if (is_new) entry->second = {motion, std::vector<std::int32_t>(poses_.size(), -1)};
  std::int32_t& stored = entry->second.first_contact[pose];
  if (stored < 0)
    stored = static_cast<std::int32_t>(
        task_->target_contact().first_contact(motion->bodies, poses_[pose]).value_or(motion->path.size()));
  return static_cast<std::size_t>(stored);
}

const std::vector<std::int32_t>& Predictions::first_contacts(const action::MotionPtr& motion) {
  for (std::size_t pose = 0; pose < poses_.size(); ++pose) first_contact(motion, pose);
  return rows_.at(motion.get()).first_contact;
}

std::map<std::size_t, std::vector<std::size_t>> Predictions::split(const action::MotionPtr& motion,
                                                                   const support::Bitset& members) {
  std::map<std::size_t, std::vector<std::size_t>> groups;
  members.for_each([&](std::size_t pose) { groups[first_contact(motion, pose)].push_back(pose); });
  return groups;
}

support::Bitset Predictions::subset(const action::MotionPtr& motion, const support::Bitset& members,
                                    std::size_t waypoint) {
  support::Bitset kept(members.size());
  members.for_each([&](std::size_t pose) {
    if (first_contact(motion, pose) == waypoint) kept.set(pose);
  });
  return kept;
}

}  // namespace tactus::solver
