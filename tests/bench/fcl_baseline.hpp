// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "contact/body_path.hpp"

namespace tactus::bench {

enum class FclTree { obbrss, obb };

/// The first contact of a motion by brute force with FCL as Debian ships it: waypoint after waypoint, body after body,
/// `collide` without contacts, up to the first hit. Surfaces only, no margin. [FCL]
class FclBaseline {
 public:
  FclBaseline(const contact::RobotBodies& bodies, const geometry::Mesh& target, FclTree tree);
  ~FclBaseline();

  /// The poses of all bodies at every waypoint, the first of which does not count. -1: the whole motion is free.
  int first_contact(const std::vector<geometry::Pose>& base_from_body, const geometry::Pose& base_from_target) const;

 private:
  struct Trees;
  std::unique_ptr<const Trees> trees_;
};

}  // namespace tactus::bench
