// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "robot/model.hpp"
#include "robot/xml_file.hpp"

namespace tactus::robot {

/// A collision element as it stands in the URDF.
struct CollisionOutline {
  int row = 0;
  std::filesystem::path mesh;  ///< resolved; empty for a box, cylinder or sphere
};

struct JointOutline {
  const TiXmlElement* element = nullptr;
  std::string name, type, parent, child;
  std::string leader;  ///< of a mimic joint
};

/// What a URDF says, as far as urdfdom's model does not say it: the order of things in the file, and where they stand
/// in it.
struct UrdfOutline {
  std::map<std::string, std::vector<CollisionOutline>> collisions;  ///< of every link, in the file's order
  std::vector<JointOutline> joints;                                 ///< in the file's order
};

/// Checks everything in a URDF that urdfdom drops or accepts in silence, and resolves its mesh paths. The outline
/// points into `robot`, and is good for further use only if nothing was reported.
UrdfOutline check_urdf(const TiXmlElement& robot, const ModelSource& source, XmlReport& report);

/// The part of `check_urdf` that looks at one joint by itself.
JointOutline check_joint(const TiXmlElement& joint, XmlReport& report);

/// The part of `check_urdf` that looks at how links and joints hang together: one root, one parent a link, no cycles,
/// mimic joints that follow an independent one.
void check_tree(const TiXmlElement& robot, const UrdfOutline& outline, XmlReport& report);

/// Reports the attribute if it is there and isn't `count` finite numbers.
void check_numbers(const TiXmlElement& element, const char* name, std::size_t count, const std::string& noun,
                   XmlReport& report);

/// Reports the numbers of `<origin>`, if the element has one.
void check_origin(const TiXmlElement& element, const std::string& noun, XmlReport& report);

}  // namespace tactus::robot
