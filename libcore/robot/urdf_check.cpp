// SPDX-License-Identifier: BSD-3-Clause
#include "robot/urdf_check.hpp"

#include <algorithm>

#include "robot/package_path.hpp"

namespace tactus::robot {
namespace {

std::string quoted(const TiXmlElement& element, const char* name) {
  return std::string(name) + "=\"" + attribute(element, name) + '"';
}

void check_sizes(const TiXmlElement& shape, const char* name, std::size_t count, const std::string& noun,
                 XmlReport& report) {
  const auto sizes = finite_numbers(attribute(shape, name));
  if (sizes && sizes->size() == count && std::all_of(sizes->begin(), sizes->end(), [](double s) { return s > 0.0; }))
    return;
  const std::string expected = count == 1 ? "a number > 0" : std::to_string(count) + " numbers > 0";
  report.add(shape, noun, quoted(shape, name), expected);
}

void check_scale(const TiXmlElement& mesh, const std::string& noun, XmlReport& report) {
  if (mesh.Attribute("scale") == nullptr) return;
  const auto scale = finite_numbers(attribute(mesh, "scale"));
  if (!scale || scale->size() != 3 || std::count(scale->begin(), scale->end(), 0.0) > 0)
    report.add(mesh, noun, quoted(mesh, "scale"), "3 numbers that are not 0");
}

std::filesystem::path check_mesh(const TiXmlElement& mesh, const std::string& noun, const ModelSource& source,
                                 XmlReport& report) {
  check_scale(mesh, noun, report);
  const std::string uri = attribute(mesh, "filename");
  if (uri.empty()) {
    report.add(mesh, noun, "a mesh without a filename", "a filename");
    return {};
  }
  const MeshPath resolved = resolve_mesh(uri, source);
  if (!resolved.found.empty()) report.add(mesh, noun, resolved.found, resolved.expected);
  return resolved.path;
}

CollisionOutline check_collision(const TiXmlElement& collision, const std::string& noun, const ModelSource& source,
                                 XmlReport& report) {
  CollisionOutline outline{collision.Row(), {}};
  check_origin(collision, noun, report);
  const TiXmlElement* geometry = collision.FirstChildElement("geometry");
  const TiXmlElement* shape = geometry == nullptr ? nullptr : geometry->FirstChildElement();
  if (shape == nullptr || shape->NextSiblingElement() != nullptr ||
      geometry->NextSiblingElement("geometry") != nullptr) {
    report.add(collision, noun, shape == nullptr ? "no shape" : "more than one shape", "one shape in one geometry");
    return outline;
  }
  const std::string kind = shape->ValueStr();
  if (kind == "box") {
    check_sizes(*shape, "size", 3, noun, report);
  } else if (kind == "cylinder" || kind == "sphere") {
    check_sizes(*shape, "radius", 1, noun, report);
    if (kind == "cylinder") check_sizes(*shape, "length", 1, noun, report);
  } else if (kind == "mesh") {
    outline.mesh = check_mesh(*shape, noun, source, report);
  } else {
    report.add(*shape, noun, "shape " + kind, "box, cylinder, sphere or mesh");
  }
  return outline;
}

void check_link(const TiXmlElement& link, const ModelSource& source, UrdfOutline& outline, XmlReport& report) {
  const std::string name = attribute(link, "name");
  if (name.empty()) report.add(link, "link", "no name", "a name");
  const std::string noun = "link " + name;
  std::vector<CollisionOutline> collisions;
  for (auto* c = link.FirstChildElement("collision"); c != nullptr; c = c->NextSiblingElement("collision"))
    collisions.push_back(check_collision(*c, noun, source, report));
  if (!outline.collisions.emplace(name, std::move(collisions)).second && !name.empty())
    report.add(link, noun, "a second link of this name", "names that differ");
}

}  // namespace

UrdfOutline check_urdf(const TiXmlElement& robot, const ModelSource& source, XmlReport& report) {
  UrdfOutline outline;
  if (robot.ValueStr() != "robot") {
    report.add(robot, "root element", "<" + robot.ValueStr() + ">", "<robot>");
    return outline;
  }
  if (attribute(robot, "name").empty()) report.add(robot, "robot", "no name", "a name");
  for (auto* link = robot.FirstChildElement("link"); link != nullptr; link = link->NextSiblingElement("link"))
    check_link(*link, source, outline, report);
  for (auto* joint = robot.FirstChildElement("joint"); joint != nullptr; joint = joint->NextSiblingElement("joint"))
    outline.joints.push_back(check_joint(*joint, report));
  check_tree(robot, outline, report);
  return outline;
}

void check_numbers(const TiXmlElement& element, const char* name, std::size_t count, const std::string& noun,
                   XmlReport& report) {
  if (element.Attribute(name) == nullptr) return;
  const auto numbers = finite_numbers(attribute(element, name));
  if (numbers && numbers->size() == count) return;
  report.add(element, noun, quoted(element, name),
             count == 1 ? "a finite number" : std::to_string(count) + " finite numbers");
}

void check_origin(const TiXmlElement& element, const std::string& noun, XmlReport& report) {
  const TiXmlElement* origin = element.FirstChildElement("origin");
  if (origin == nullptr) return;
  check_numbers(*origin, "xyz", 3, noun, report);
  check_numbers(*origin, "rpy", 3, noun, report);
}

}  // namespace tactus::robot
