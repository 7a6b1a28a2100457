// SPDX-License-Identifier: BSD-3-Clause
#include "robot/srdf.hpp"

#include <algorithm>

#include "robot/xml_file.hpp"

namespace tactus::robot {
namespace {

int check_link(const TiXmlElement& element, const char* name, const RobotModel& model, XmlReport& report) {
  const std::string link = attribute(element, name);
  const int index = model.find_link(link);
  if (index < 0)
    report.add(element, "disable_collisions", link.empty() ? "no " + std::string(name) : "link " + link,
               "a link of robot " + model.name);
  return index;
}

}  // namespace

std::vector<LinkPair> read_disabled_pairs(const std::filesystem::path& srdf, const RobotModel& model) {
  constexpr const char* tag = "disable_collisions";
  TiXmlDocument document;
  read_xml(srdf, document);
  XmlReport report(srdf);
  const TiXmlElement& robot = *document.RootElement();
  if (robot.ValueStr() != "robot") report.add(robot, "root element", "<" + robot.ValueStr() + ">", "<robot>");
  std::vector<LinkPair> pairs;
  for (auto* element = robot.FirstChildElement(tag); element != nullptr; element = element->NextSiblingElement(tag)) {
    const int first = check_link(*element, "link1", model, report);
    const int second = check_link(*element, "link2", model, report);
    if (first == second && first >= 0) report.add(*element, tag, "a link paired with itself", "two links");
    pairs.emplace_back(std::minmax(first, second));
  }
  report.throw_if_any();
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace tactus::robot
