// SPDX-License-Identifier: BSD-3-Clause
#include <set>

#include "robot/urdf_check.hpp"

namespace tactus::robot {
namespace {

constexpr std::size_t most_links = 1000;

using Joints = std::map<std::string, const JointOutline*>;

std::string noun_of(const JointOutline& joint) { return "joint " + joint.name; }

bool check_ends(const JointOutline& joint, const UrdfOutline& outline, XmlReport& report) {
  bool known = true;
  for (const auto& [end, link] : {std::pair("parent", joint.parent), std::pair("child", joint.child)}) {
    if (outline.collisions.contains(link) && !link.empty()) continue;
    report.add(*joint.element, noun_of(joint),
               link.empty() ? "no " + std::string(end) + " link" : end + (" link " + link) + " that is missing",
               "the name of a link");
    known = false;
  }
  return known;
}

/// The joint above each link, as far as it is one and only one.
Joints joints_by_child(const UrdfOutline& outline, XmlReport& report) {
  Joints above;
  for (const JointOutline& joint : outline.joints) {
    if (!check_ends(joint, outline, report)) continue;
    const auto [first, is_new] = above.emplace(joint.child, &joint);
    if (!is_new)
      report.add(*joint.element, noun_of(joint),
                 "a second parent of link " + joint.child + " (the first: joint " + first->second->name + ')',
                 "one parent a link");
  }
  return above;
}

void check_cycles(const Joints& above, XmlReport& report) {
  std::set<std::string> done;
  for (const auto& [start, first] : above) {
    std::set<std::string> path;
    std::string link = start;
    for (auto joint = above.find(link); joint != above.end() && !done.contains(link); joint = above.find(link)) {
      if (!path.insert(link).second) {
        report.add(*joint->second->element, noun_of(*joint->second), "link " + link + " below itself",
                   "a tree of links");
        break;
      }
      link = joint->second->parent;
    }
    done.merge(path);
  }
}

void check_root(const TiXmlElement& robot, const UrdfOutline& outline, const Joints& above, XmlReport& report) {
  std::string roots;
  std::size_t count = 0;
  for (const auto& [link, collisions] : outline.collisions) {
    if (above.contains(link)) continue;
    roots += (count++ == 0 ? "" : ", ") + link;
  }
  if (count == 0) report.add(robot, "robot", "no link without a parent", "one root link");
  if (count > 1)
    report.add(robot, "robot", std::to_string(count) + " links without a parent (" + roots + ')', "one root link");
}

void check_followers(const UrdfOutline& outline, XmlReport& report) {
  Joints by_name;
  for (const JointOutline& joint : outline.joints)
    if (!by_name.emplace(joint.name, &joint).second && !joint.name.empty())
      report.add(*joint.element, noun_of(joint), "a second joint of this name", "names that differ");
  for (const JointOutline& joint : outline.joints) {
    if (joint.leader.empty()) continue;
    const auto leader = by_name.find(joint.leader);
    std::string found;
    if (leader == by_name.end())
      found = "that is missing";
    else if (leader->second->type == "fixed")
      found = "that is fixed";
    else if (!leader->second->leader.empty())
      found = "that is a mimic itself";
    if (!found.empty())
      report.add(*joint.element, noun_of(joint), "a mimic of joint " + joint.leader + ' ' + found,
                 "an independent joint to follow");
  }
}

}  // namespace

void check_tree(const TiXmlElement& robot, const UrdfOutline& outline, XmlReport& report) {
  if (outline.collisions.size() > most_links || outline.joints.size() > most_links) {
    report.add(robot, "robot", "more than " + std::to_string(most_links) + " links or joints",
               "a robot of reasonable size");
    return;
  }
  const Joints above = joints_by_child(outline, report);
  check_cycles(above, report);
  check_root(robot, outline, above, report);
  check_followers(outline, report);
}

}  // namespace tactus::robot
