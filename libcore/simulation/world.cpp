// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/solid.hpp"
#include "support/error.hpp"

namespace tactus::simulation {
namespace {

using contact::Solid;
using geometry::Pose;
using robot::JointVector;
using support::Error;
using support::Status;

constexpr int scalings = 3;        // of an error of the joints to the length wanted: each squares what is missing
constexpr double at_start = 1e-6;  // rad or m by which an action may begin off the robot's configuration

bool same(const JointVector& a, const JointVector& b) {
  return a.size() == b.size() && (a - b).cwiseAbs().maxCoeff() <= at_start;
}

void check(const std::string& name, double value, double most) {
  if (value >= 0.0 && value <= most) return;
  const bool rate = most <= 1.0;
  throw Error(Status::invalid_argument, "world options: " + name + ": found " + std::to_string(value) + ", expected " +
                                            (rate ? "a share from 0 to 0.5" : "a length of at least 0"));
}

void check(const action::Sensing& sensing) {
  constexpr double longest = std::numeric_limits<double>::max(), most_often = 0.5;
  check("stopping_distance", sensing.stopping_distance, longest);
  check("encoder_error", sensing.encoder_error, longest);
  check("missed_contacts", sensing.missed_contacts, most_often);
  check("false_contacts", sensing.false_contacts, most_often);
}

JointVector random_direction(Eigen::Index dof, support::Rng& rng) {
  JointVector direction(dof);
  for (double& component : direction) component = rng.normal();
  return direction.normalized();
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
    : model_(std::move(model)),
      base_from_target_(base_from_target),
      options_(options),
      rng_(support::Rng(options.seed).fork()) {
  const scene::Scene& scene = model_->task->scene();
  if (!base_from_target.matrix().allFinite())
    throw Error(Status::invalid_argument, "true_pose: found a value that is not finite, expected a pose");
  if (!(options.fineness >= 1.0))
    throw Error(Status::invalid_argument,
                "world options: fineness: found " + std::to_string(options.fineness) + ", expected at least 1");
  if (!options_.sensing) options_.sensing = model_->task->options().sensing;
  check(sensing());
  if (!scene.prior.contains(base_from_target, 1e-6))
    throw Error(
        Status::invalid_argument,
        "true_pose: found a pose outside the prior, expected one inside it: the target must be where the search looks");
  solids_ = std::make_shared<const Solids>(scene);
  q_ = scene.start;
  if (in_contact(q_))
    throw Error(Status::start_in_collision,
                "true_pose: found a target that the robot touches at its start, expected it to be clear of the robot");
}

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

/// The same path in the world's steps: `fineness` to one of the action's, and so many that a stop is reported within
/// the tolerance that the scenario says it is.
motion::JointPath World::in_fine_steps(const motion::JointPath& path) const {
  const action::Task& task = *model_->task;
  double longest = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
    longest = std::max(longest, task.known_world().displacement(path[i - 1], path[i]));
  const double parts = std::ceil(std::max(options_.fineness, longest / task.options().stop_tolerance));
  motion::JointPath fine{path.front()};
  for (std::size_t i = 1; i < path.size(); ++i) {
    for (double k = 1.0; k < parts; ++k) fine.push_back(path[i - 1] + k / parts * (path[i] - path[i - 1]));
    fine.push_back(path[i]);
  }
  return fine;
}

/// Goes along a path in fine steps up to the first contact that is felt, and says after how many; none at its end.
std::optional<std::size_t> World::travel_until_felt(const motion::JointPath& path) {
  const std::size_t last = path.size() - 1;
  const bool misses = rng_.uniform() < sensing().missed_contacts;
  const bool imagines = rng_.uniform() < sensing().false_contacts;
  const std::size_t imagined = 1 + static_cast<std::size_t>(rng_.uniform() * static_cast<double>(last));
  bool clear = !in_contact(q_);
  touched_ = false;
  for (std::size_t step = 1; step <= last; ++step) {
    travel_to(path[step]);
    const bool touches = in_contact(q_);
    if (touches && clear && !misses) {
      touched_ = true;
      return step;
    }
    touched_ = touched_ || touches;
    clear = clear || !touches;
    if (imagines && step == imagined && !touched_) return step;
  }
  return std::nullopt;
}

/// Goes on along the path for so many metres of motion, or to its end.
void World::travel_on(const motion::JointPath& path, std::size_t step, double metres) {
  while (metres > 0.0 && step + 1 < path.size()) {
    const JointVector& next = path[++step];
    const double leg = model_->task->known_world().displacement(q_, next);
    travel_to(leg <= metres ? next : JointVector(q_ + metres / leg * (next - q_)));
    touched_ = touched_ || in_contact(q_);
    metres -= leg;
  }
}

/// Where the robot is, off by so much that no point of it, its tool included, is off by more than the encoder error.
JointVector World::reported_joints() {
  const double off = sensing().encoder_error * rng_.uniform();
  if (off == 0.0) return q_;
  JointVector error = off * random_direction(q_.size(), rng_);
  for (int i = 0; i < scalings; ++i) error *= off / model_->task->known_world().displacement(q_, q_ + error);
  return q_ + error;
}

void World::retreat(const action::Action& action, const belief::Observation& reported) {
  const belief::Stop stop = belief::locate(*model_->task, action, reported);
  for (std::size_t waypoint = std::max(stop.segment, stop.last_free + 1); waypoint > stop.last_free;)
    travel_to(action.path[--waypoint]);
}

/// To within what it reports, which is what an action is planned from.
bool World::is_at(const JointVector& q) const {
  if (same(q, q_)) return true;
  const double error = sensing().encoder_error;
  return error > 0.0 && q.size() == q_.size() && model_->task->known_world().displacement(q, q_) <= error;
}

belief::Observation World::execute(const action::Action& action) {
  if (action.path.empty() || !is_at(action.path.front()))
    throw Error(Status::invalid_argument,
                "action: found a path that does not begin where the robot is, expected one planned from its present "
                "configuration");
  World next = *this;
  belief::Observation reported = next.perform(action);
  *this = std::move(next);
  return reported;
}

belief::Observation World::perform(const action::Action& action) {
  const motion::JointPath path = in_fine_steps(action.path);
  const std::optional<std::size_t> felt = travel_until_felt(path);
  if (felt) travel_on(path, *felt, sensing().stopping_distance * rng_.uniform());
  const belief::Observation reported{felt.has_value(), reported_joints()};
  if (felt) retreat(action, reported);
  const scene::Scene& scene = model_->task->scene();
  inserted_ = !touched_ && scene.is_seated(model_->task->base_from_tool(q_), base_from_target_);
  return reported;
}

}  // namespace tactus::simulation
