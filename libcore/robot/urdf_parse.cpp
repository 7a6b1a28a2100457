// SPDX-License-Identifier: BSD-3-Clause
#include "robot/urdf_parse.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <mutex>
#include <set>

namespace tactus::robot {
namespace {

/// Collects what is logged through console_bridge while it lives. The handler belongs to the process: one at a time.
class CaptureErrors : public console_bridge::OutputHandler {
 public:
  CaptureErrors()
      : lock_(mutex()), level_(console_bridge::getLogLevel()), previous_(console_bridge::getOutputHandler()) {
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
    console_bridge::useOutputHandler(this);
  }
  ~CaptureErrors() override {
    console_bridge::useOutputHandler(previous_);
    console_bridge::setLogLevel(level_);
  }
  CaptureErrors(const CaptureErrors&) = delete;
  CaptureErrors& operator=(const CaptureErrors&) = delete;

  void log(const std::string& text, console_bridge::LogLevel, const char*, int) override { errors_.push_back(text); }
  const std::vector<std::string>& errors() const { return errors_; }

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }

  std::lock_guard<std::mutex> lock_;
  console_bridge::LogLevel level_;
  console_bridge::OutputHandler* previous_;
  std::vector<std::string> errors_;
};

void keep_children(TiXmlElement& element, const std::set<std::string>& names) {
  for (TiXmlNode *child = element.FirstChild(), *next = nullptr; child != nullptr; child = next) {
    next = child->NextSibling();
    if (child->ToElement() == nullptr || !names.contains(child->ValueStr())) element.RemoveChild(child);
  }
}

std::string reduced_text(const TiXmlDocument& document) {
  TiXmlDocument reduced(document);
  TiXmlElement& robot = *reduced.RootElement();
  keep_children(robot, {"link", "joint"});
  for (auto* child = robot.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
    keep_children(*child, {"collision", "parent", "child", "origin", "axis", "limit", "mimic"});
  TiXmlPrinter printer;
  reduced.Accept(&printer);
  return printer.Str();
}

void check_arrived(const urdf::ModelInterface& model, const UrdfOutline& outline, XmlReport& report) {
  for (const auto& [name, collisions] : outline.collisions) {
    const urdf::LinkConstSharedPtr link = model.getLink(name);
    const std::size_t arrived = link == nullptr ? 0 : link->collision_array.size();
    if (arrived != collisions.size())
      report.add(collisions.empty() ? 1 : collisions.front().row, "link " + name,
                 std::to_string(arrived) + " collision elements after parsing", std::to_string(collisions.size()));
  }
}

}  // namespace

urdf::ModelInterfaceSharedPtr parse_urdf(const TiXmlDocument& document, const UrdfOutline& outline, XmlReport& report) {
  const std::string text = reduced_text(document);
  const int row = document.RootElement()->Row();
  CaptureErrors capture;
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
  for (const std::string& error : capture.errors())
    report.add(row, "robot", "what urdfdom refuses: " + error, "a valid URDF");
  if (model == nullptr && report.empty()) report.add(row, "robot", "what urdfdom refuses", "a valid URDF");
  report.throw_if_any();
  check_arrived(*model, outline, report);
  report.throw_if_any();
  return model;
}

}  // namespace tactus::robot
