// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/world.hpp"

#include <algorithm>
#include <cmath>

#include "contact/solid.hpp"
#include "support/error.hpp"

namespace tactus::simulation {
namespace {

using contact::Solid;
using geometry::Pose;
using robot::JointVector;
using support::Error;
using support::Status;

constexpr double at_start = 1e-6;  // rad or m by which an action may begin off the robot's configuration

bool same(const JointVector& a, const JointVector& b) {
  return a.size() == b.size() && (a - b).cwiseAbs().maxCoeff() <= at_start;
}

}  // namespace

/// The target, and every part of the robot that moves or not, as solids.
struct World::Solids {
  Solid target;
  std::vector<std::pair<int, Solid>> parts;  ///< link, shape in its frame

  explicit Solids(const scene::Scene& scene) : target(scene.target.mesh, "target") {
    parts.emplace_back(scene.tool_link, Solid(scene.tool, "tool"));
    for (std::size_t link = 0; link < scene.robot->links.size(); ++link)
      for (const geometry::Mesh& shape : scene.robot->links[link].shapes)
        parts.emplace_back(static_cast<int>(link), Solid(shape, scene.robot->links[link].name));
  }
};

World::World(std::shared_ptr<const belief::Model> model, const Pose& base_from_target, const WorldOptions& options)
    : model_(std::move(model)), base_from_target_(base_from_target), options_(options) {
  const scene::Scene& scene = model_->task->scene();
  if (!base_from_target.matrix().allFinite())
    throw Error(Status::invalid_argument, "true_pose: found a value that is not finite, expected a pose");
  if (!(options.fineness >= 1.0))
    throw Error(Status::invalid_argument,
                "world options: fineness: found " + std::to_string(options.fineness) + ", expected at least 1");
  if (!scene.prior.contains(base_from_target, 1e-6))
    throw Error(
        Status::invalid_argument,
        "true_pose: found a pose outside the prior, expected one inside it: the target must be where the search looks");
  solids_ = std::make_unique<Solids>(scene);
  q_ = scene.start;
  if (in_contact(q_))
    throw Error(Status::start_in_collision,
                "true_pose: found a target that the robot touches at its start, expected it to be clear of the robot");
}

World::~World() = default;

bool World::in_contact(const JointVector& q) const {
  std::vector<Pose> base_from_link;
  robot::forward(*model_->task->scene().robot, q, base_from_link);
  return std::any_of(solids_->parts.begin(), solids_->parts.end(), [&](const auto& part) {
    return touching(part.second, base_from_link[part.first], solids_->target, base_from_target_);
  });
}

void World::travel_to(const JointVector& q) {
  const scene::Scene& scene = model_->task->scene();
  const motion::ToolTravel leg = motion::tool_travel(*scene.robot, scene.tool_link, {q_, q});
  travelled_.metres += leg.metres;
  travelled_.radians += leg.radians;
  q_ = q;
}

belief::Observation World::execute(const action::Action& action) {
  if (action.path.empty() || !same(action.path.front(), q_))
    throw Error(Status::invalid_argument,
                "action: found a path that does not begin where the robot is, expected one planned from its present "
                "configuration");
  const int substeps = static_cast<int>(std::ceil(options_.fineness));
  belief::Observation observation{false, q_};
  for (std::size_t i = 1; i < action.path.size() && !observation.contact; ++i)
    for (int k = 1; k <= substeps && !observation.contact; ++k) {
      const double fraction = static_cast<double>(k) / substeps;
      travel_to(k == substeps ? action.path[i]
                              : JointVector(action.path[i - 1] + fraction * (action.path[i] - action.path[i - 1])));
      observation = {in_contact(q_), q_};
    }
  if (observation.contact) {
    const belief::Stop stop = belief::locate(*model_->task, action, observation);
    for (std::size_t at = stop.segment; at > stop.last_free;) travel_to(action.path[--at]);
  }
  inserted_ =
      !observation.contact && model_->task->scene().is_seated(model_->task->base_from_tool(q_), base_from_target_);
  return observation;
}

}  // namespace tactus::simulation
