// SPDX-License-Identifier: BSD-3-Clause
#include "contact/link_pairs.hpp"

#include <algorithm>

namespace tactus::contact {

using robot::Link;
using robot::LinkPair;
using robot::RobotModel;

namespace {

const Link& link_at(const RobotModel& model, int index) { return model.links[static_cast<std::size_t>(index)]; }

// For each link, the first link of the rigid group it belongs to.
std::vector<int> rigid_groups(const RobotModel& model) {
  std::vector<int> group(model.links.size());
  for (int i = 0; i < static_cast<int>(model.links.size()); ++i) {
    const Link& link = link_at(model, i);
    const bool fixed = link.parent >= 0 && link.joint < 0;
    group[static_cast<std::size_t>(i)] = fixed ? group[static_cast<std::size_t>(link.parent)] : i;
  }
  return group;
}

// The nearest ancestor with shapes, if no more than one moving joint lies between; -1 otherwise.
int neighbour_above(const RobotModel& model, int index) {
  int moving_joints = 0;
  for (int i = index; link_at(model, i).parent >= 0; i = link_at(model, i).parent) {
    if (link_at(model, i).joint >= 0 && ++moving_joints > 1) return -1;
    if (!link_at(model, link_at(model, i).parent).shapes.empty()) return link_at(model, i).parent;
  }
  return -1;
}

bool disabled(const RobotModel& model, const LinkPair& pair) {
  return std::find(model.disabled_pairs.begin(), model.disabled_pairs.end(), pair) != model.disabled_pairs.end();
}

}  // namespace

std::vector<LinkPair> collidable_pairs(const RobotModel& model) {
  const std::vector<int> group = rigid_groups(model);
  const int count = static_cast<int>(model.links.size());
  std::vector<LinkPair> pairs;
  for (int first = 0; first < count; ++first)
    for (int second = first + 1; second < count; ++second) {
      if (link_at(model, first).shapes.empty() || link_at(model, second).shapes.empty()) continue;
      if (group[static_cast<std::size_t>(first)] == group[static_cast<std::size_t>(second)]) continue;
      if (neighbour_above(model, second) == first || disabled(model, {first, second})) continue;
      pairs.emplace_back(first, second);
    }
  return pairs;
}

std::vector<bool> moving_links(const RobotModel& model) {
  std::vector<bool> moving(model.links.size());
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const Link& link = model.links[i];
    moving[i] = link.joint >= 0 || (link.parent >= 0 && moving[static_cast<std::size_t>(link.parent)]);
  }
  return moving;
}

}  // namespace tactus::contact
