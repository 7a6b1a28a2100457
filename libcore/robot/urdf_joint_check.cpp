// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "robot/urdf_check.hpp"

namespace tactus::robot {
namespace {

bool moves(const JointOutline& joint) { return joint.type != "fixed"; }
bool needs_limits(const JointOutline& joint) { return joint.type == "revolute" || joint.type == "prismatic"; }
std::string noun_of(const JointOutline& joint) { return "joint " + joint.name; }

/// The attribute's number; `otherwise` if it isn't there or isn't one.
double number_or(const TiXmlElement& element, const char* name, double otherwise) {
  const auto numbers = finite_numbers(attribute(element, name));
  return numbers && numbers->size() == 1 ? numbers->front() : otherwise;
}

void check_type(const JointOutline& joint, XmlReport& report) {
  constexpr const char* known[] = {"fixed", "revolute", "continuous", "prismatic"};
  if (std::find(std::begin(known), std::end(known), joint.type) != std::end(known)) return;
  report.add(*joint.element, noun_of(joint), joint.type.empty() ? "no type" : "type " + joint.type,
             "fixed, revolute, continuous or prismatic");
}

void check_axis(const JointOutline& joint, XmlReport& report) {
  const TiXmlElement* axis = joint.element->FirstChildElement("axis");
  if (axis == nullptr || !moves(joint)) return;
  const auto xyz = finite_numbers(attribute(*axis, "xyz"));
  const auto tiny = [](double x) { return std::abs(x) < 1e-6; };
  if (xyz && xyz->size() == 3 && !std::all_of(xyz->begin(), xyz->end(), tiny)) return;
  report.add(*axis, noun_of(joint), "axis \"" + attribute(*axis, "xyz") + '"', "3 numbers that are not all 0");
}

void check_limit(const JointOutline& joint, XmlReport& report) {
  const TiXmlElement* limit = joint.element->FirstChildElement("limit");
  if (!moves(joint) || (limit == nullptr && !needs_limits(joint))) return;
  const std::string noun = noun_of(joint);
  if (limit == nullptr || limit->Attribute("velocity") == nullptr) {
    report.add(limit == nullptr ? *joint.element : *limit, noun, "no velocity limit", "a velocity > 0");
    if (limit == nullptr) return;
  }
  for (const char* name : {"lower", "upper", "velocity", "effort"}) check_numbers(*limit, name, 1, noun, report);
  if (limit->Attribute("effort") == nullptr) report.add(*limit, noun, "no effort limit", "an effort");
  if (number_or(*limit, "velocity", 1.0) <= 0.0)
    report.add(*limit, noun, "velocity " + attribute(*limit, "velocity"), "a velocity > 0");
  if (needs_limits(joint) && number_or(*limit, "lower", 0.0) > number_or(*limit, "upper", 0.0))
    report.add(*limit, noun, "lower " + attribute(*limit, "lower") + " > upper " + attribute(*limit, "upper"),
               "lower <= upper");
}

void check_mimic(JointOutline& joint, XmlReport& report) {
  const TiXmlElement* mimic = joint.element->FirstChildElement("mimic");
  if (mimic == nullptr) return;
  joint.leader = attribute(*mimic, "joint");
  if (joint.leader.empty())
    report.add(*mimic, noun_of(joint), "a mimic without a joint", "the name of the joint to follow");
  check_numbers(*mimic, "multiplier", 1, noun_of(joint), report);
  check_numbers(*mimic, "offset", 1, noun_of(joint), report);
}

std::string linked(const TiXmlElement& joint, const char* end) {
  const TiXmlElement* element = joint.FirstChildElement(end);
  return element == nullptr ? std::string() : attribute(*element, "link");
}

}  // namespace

JointOutline check_joint(const TiXmlElement& element, XmlReport& report) {
  JointOutline joint{&element,
                     attribute(element, "name"),
                     attribute(element, "type"),
                     linked(element, "parent"),
                     linked(element, "child"),
                     {}};
  if (joint.name.empty()) report.add(element, "joint", "no name", "a name");
  check_type(joint, report);
  check_origin(element, noun_of(joint), report);
  check_axis(joint, report);
  check_limit(joint, report);
  check_mimic(joint, report);
  return joint;
}

}  // namespace tactus::robot
