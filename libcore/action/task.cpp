// SPDX-License-Identifier: BSD-3-Clause
#include "action/task.hpp"

#include <algorithm>
#include <array>

#include "support/error.hpp"

namespace tactus::action {
namespace {

using support::Error;
using support::Status;

/// The robot with the tool as one more shape of its tool link, for the checks against itself and the known world.
std::shared_ptr<const robot::RobotModel> with_tool(const scene::Scene& scene) {
  auto model = std::make_shared<robot::RobotModel>(*scene.robot);
  model->links[scene.tool_link].shapes.push_back(scene.tool);
  return model;
}

std::vector<geometry::Mesh> meshes(const std::vector<scene::StaticPart>& parts) {
  std::vector<geometry::Mesh> result;
  for (const scene::StaticPart& part : parts) result.push_back(part.mesh);
  return result;
}

std::vector<std::string> names(const std::vector<scene::StaticPart>& parts) {
  std::vector<std::string> result;
  for (const scene::StaticPart& part : parts) result.push_back(part.name);
  return result;
}

/// Tool positions at standoff over the region's middle and corners, from which every motion of the search sets out.
std::vector<Vector3> standoff_positions(const scene::SearchFrame& frame) {
  const Vector3 low = frame.region.low, high = frame.region.high;
  std::vector<Vector3> positions{{0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), frame.standoff}};
  for (const double u : {low.x(), high.x()})
    for (const double v : {low.y(), high.y()}) positions.emplace_back(u, v, frame.standoff);
  return positions;
}

}  // namespace

Sensing worse_of(const Sensing& a, const Sensing& b) {
  return {std::max(a.stopping_distance, b.stopping_distance), std::max(a.encoder_error, b.encoder_error),
          std::max(a.missed_contacts, b.missed_contacts), std::max(a.false_contacts, b.false_contacts)};
}

Task::Task(scene::Scene scene, TaskOptions options)
    : scene_(std::move(scene)),
      options_(std::move(options)),
      known_world_(std::make_unique<contact::KnownWorld>(with_tool(scene_), meshes(scene_.world), names(scene_.world))),
      bodies_(std::make_shared<contact::RobotBodies>(scene_.robot, scene_.tool_link, scene_.tool,
                                                     scene::target_region(scene_, Pose::Identity()))),
      target_contact_(std::make_unique<contact::TargetContact>(bodies_, scene_.target.mesh, options_.contact_margin)),
      frame_(scene::search_frame(scene_, options_.actions.standoff)),
      target_diameter_(geometry::diameter(scene_.target.mesh)) {
  const std::string collision = known_world_->describe_collision(scene_.start);
  if (!collision.empty())
    throw Error(Status::start_in_collision, "robot.start: found " + collision +
                                                ", expected a configuration inside the limits and free of collisions");
  for (const Vector3& v : scene_.target.mesh.vertices) target_reach_ = std::max(target_reach_, v.norm());
  if (options_.sites) frame_.standoff += past_site({0.0, 0.0, frame_.standoff});
  home_ = find_home();
}

Pose Task::base_from_tool(const JointVector& q) const { return robot::forward(*scene_.robot, q, scene_.tool_link); }

double Task::cost(const motion::ToolTravel& travel) const {
  return options_.cost.metre * travel.metres + options_.cost.radian * travel.radians;
}

std::optional<JointVector> Task::posture(const Pose& base_from_tool, const JointVector& near) const {
  for (const JointVector& seed : {near, home_}) {
    auto q = robot::inverse(*scene_.robot, scene_.tool_link, base_from_tool, seed);
    if (q && known_world_->is_free(*q)) return q;
  }
  return std::nullopt;
}

std::optional<JointPath> Task::straight_path(const JointVector& from, const Pose& base_from_goal, double step,
                                             const support::Cancellation& cancellation, bool keep_free_part) const {
  const double stride =
      options_.sites ? options_.sites->stride(base_from_tool(from).translation(), base_from_goal.translation()) : 0.0;
  return motion::straight_tool_path(*known_world_, scene_.tool_link, from, base_from_goal,
                                    {step, stride, keep_free_part, cancellation});
}

Pose Task::at_site(const Pose& base_from_start, const Pose& base_from_goal) const {
  Pose goal = base_from_goal;
  if (options_.sites) goal.translation() = options_.sites->end(base_from_start.translation(), goal.translation());
  return goal;
}

/// How much farther the nearest site is along the approach axis than a position in the search frame, if an axis of the
/// base follows it.
double Task::past_site(const Vector3& position) const {
  const Vector3 at = frame_.base_from_search * position, axis = frame_.base_from_search.linear().col(2);
  return axis.cwiseAbs().maxCoeff() > 1.0 - 1e-9 ? axis.dot(options_.sites->nearest(at) - at) : 0.0;
}

/// Of the arm's postures over the region's middle, the one from which most of its corners are reached, and of those the
/// one nearest to the start.
JointVector Task::find_home() const {
  support::Rng rng(1);
  const std::vector<Vector3> positions = standoff_positions(frame_);
  JointVector best;
  int most = 0;
  for (const JointVector& q : robot::inverse_all(*scene_.robot, scene_.tool_link, frame_.base_from_tool(positions[0]),
                                                 scene_.start, rng, 100)) {
    if (!known_world_->is_free(q)) continue;
    int reached = 0;
    for (const Vector3& position : positions)
      if (straight_path(q, frame_.base_from_tool(position), 0.05)) ++reached;
    if (reached > most) {
      most = reached;
      best = q;
    }
  }
  if (most == 0)
    throw Error(Status::prior_unreachable,
                "prior: found no free configuration of the arm with the tool in front of the prior's centre, expected "
                "the prior within the arm's reach and "
                "clear of the known world by actions.standoff");
  return best;
}

}  // namespace tactus::action
