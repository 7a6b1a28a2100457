// SPDX-License-Identifier: BSD-3-Clause
#include "scenario/scenario.hpp"

#include <sstream>

#include "contact/solid.hpp"
#include "geometry/mesh_file.hpp"
#include "support/error.hpp"

namespace tactus::scenario {
namespace {

using geometry::Mesh;
using geometry::Pose;
using support::Error;
using support::Problem;
using support::Status;

constexpr double site_step = 0.001;  // m at most between sites of the tool

/// Runs `make`; what it throws joins the problems, so that all of them come out at once.
template <typename Make>
auto collected(std::vector<std::string>& problems, Make make) -> decltype(make()) {
  try {
    return make();
  } catch (const Error& error) {
    if (error.status() == Status::internal) throw;  // no mistake of the file's
    problems.emplace_back(error.what());
    return {};
  }
}

Mesh load(const MeshSource& source) { return geometry::load_mesh(source.file, source.scale); }

scene::StaticPart static_part(const ObjectDescription& object, const Pose& base_from_world) {
  const Mesh mesh = object.box ? geometry::box_mesh(*object.box) : load(*object.mesh);
  return {object.name, geometry::transformed(mesh, base_from_world * object.world_from_object)};
}

std::shared_ptr<const robot::RobotModel> load_robot(const RobotDescription& robot) {
  return std::make_shared<robot::RobotModel>(robot::load_model({robot.urdf, robot.packages, robot.srdf}));
}

void place_tool(const Description& description, scene::Scene& scene, std::vector<std::string>& problems) {
  const RobotDescription& robot = description.robot;
  scene.tool_link = scene.robot->find_link(robot.tool_link);
  if (scene.tool_link < 0)
    problems.push_back("robot.tool_link: found '" + robot.tool_link + "', which " + robot.urdf.string() +
                       " does not have, expected the name of a link");
  if (static_cast<int>(robot.start.size()) != scene.robot->dof())
    problems.push_back("robot.start: found " + std::to_string(robot.start.size()) + " values, expected " +
                       std::to_string(scene.robot->dof()) + ", one a joint");
  scene.start = Eigen::Map<const robot::JointVector>(robot.start.data(), static_cast<Eigen::Index>(robot.start.size()));
}

scene::Prior make_prior(const PriorDescription& description) {
  scene::Prior prior{description.centre, description.width};
  double weights = 0.0;
  for (const GuessDescription& guess : description.guesses) weights += guess.weight;
  for (const GuessDescription& guess : description.guesses)
    prior.guesses.push_back(
        {scene::Normal(guess.mean, guess.covariance, prior.width), (1.0 - description.floor) * guess.weight / weights});
  return prior;
}

scene::Scene make_scene(const Description& d, std::vector<std::string>& problems) {
  scene::Scene scene;
  scene.robot = collected(problems, [&] { return load_robot(d.robot); });
  if (scene.robot) place_tool(d, scene, problems);
  scene.tool =
      geometry::transformed(collected(problems, [&] { return load(d.tool.mesh); }), d.tool.tool_link_from_mesh);
  for (const ObjectDescription& object : d.world)
    scene.world.push_back(collected(problems, [&] { return static_part(object, d.robot.world_from_base.inverse()); }));
  scene.target.mesh = collected(problems, [&] { return load(d.target.mesh); });
  scene.target.target_from_seated = d.target.target_from_seated_tool;
  scene.target.approach_axis = d.target.approach_axis;
  scene.target.approach_depth = d.target.approach_depth;
  scene.target.position_tolerance = d.target.tolerance.position;
  scene.target.angle_tolerance = d.target.tolerance.angle;
  scene.prior = make_prior(d.prior);
  return scene;
}

action::TaskOptions task_options(const Description& d) {
  action::TaskOptions options;
  options.motion = {d.contact.step,
                    d.contact.insertion_step,
                    d.motion.speed,
                    d.motion.approach_speed,
                    d.motion.insertion_speed,
                    d.motion.acceleration,
                    d.motion.joint_acceleration};
  options.actions = {d.actions.primitive_lengths, d.actions.primitive_angles,     d.actions.probe_spacing,
                     d.actions.probe_depth,       d.actions.insertion_candidates, d.actions.standoff};
  options.cost = {d.cost.metre, d.cost.radian, d.cost.action};
  options.contact_margin = d.contact.margin;
  options.stop_tolerance = d.contact.stop_tolerance;
  options.sensing = {d.sensing.stopping_distance, d.sensing.encoder_error, d.sensing.missed_contacts,
                     d.sensing.false_contacts};
  return options;
}

belief::Options belief_options(const BeliefDescription& b) {
  belief::Options options;
  options.kind = b.kind == "particles" ? belief::Kind::particles : belief::Kind::hierarchical;
  options.voxel_size = b.voxel_size;
  options.delta = static_cast<std::size_t>(b.delta);
  options.cells.position = b.cell.position;
  options.cells.angle = b.cell.angle;
  options.cells.most = static_cast<std::size_t>(b.max_cells);
  options.cells.threads = b.threads;
  options.likelihood = b.likelihood == "paper" ? belief::Likelihood::paper : belief::Likelihood::calibrated;
  options.particles = static_cast<std::size_t>(b.particles);
  return options;
}

solver::PlannerOptions planner_options(const PlannerDescription& p) {
  solver::PlannerOptions options;
  options.solver = solver::solver_from(p.solver).value_or(solver::Solver::brtdp_bel);
  options.budget_seconds = p.budget_seconds;
  options.budget_expansions = p.budget_expansions;
  options.epsilon = p.epsilon;
  options.horizon = p.horizon;
  options.cost_per_bit = p.cost_per_bit;
  return options;
}

/// The prior must leave the known world alone: targets at random poses and at the ends of its ranges.
std::string prior_conflict(const scene::Scene& scene) {
  const contact::Solid target(scene.target.mesh, "target");
  std::vector<contact::Solid> parts;
  for (const scene::StaticPart& part : scene.world) parts.emplace_back(part.mesh, part.name);
  support::Rng rng(1);
  for (int i = 0; i < 256; ++i) {
    geometry::PoseVector v = scene.prior.centre;
    for (int d = 0; d < 6; ++d)
      v[d] += scene.prior.width[d] * (i < 128 ? rng.uniform() - 0.5 : (rng.below(2) == 0 ? -0.5 : 0.5));
    for (std::size_t p = 0; p < parts.size(); ++p)
      if (touching(parts[p], Pose::Identity(), target, geometry::pose_from(v))) {
        std::ostringstream text;
        text << "prior: found a pose (x y z roll pitch yaw";
        for (const double value : v) text << ' ' << value;
        text << ") at which the target cuts into '" << scene.world[p].name
             << "', expected every pose of the prior to be clear of the world";
        return text.str();
      }
  }
  return {};
}

void throw_all(const std::vector<std::string>& problems) {
  if (problems.empty()) return;
  std::string text;
  for (const std::string& problem : problems) text += (text.empty() ? "" : "\n") + problem;
  throw Error(Status::bad_scenario, text);
}

std::shared_ptr<const Scenario> prepare(Description description) {
  std::vector<std::string> problems;
  scene::Scene scene = make_scene(description, problems);
  throw_all(problems);
  if (const std::string conflict = prior_conflict(scene); !conflict.empty())
    throw Error(Status::bad_scenario, conflict);
  auto scenario = std::make_shared<Scenario>();
  const belief::Options belief = belief_options(description.belief);
  action::TaskOptions task = task_options(description);
  task.sites = belief::CellTables::sites(belief::CellBelief::shape(scene.prior, belief.cells), site_step);
  scenario->task = std::make_shared<action::Task>(std::move(scene), task);
  scenario->model = std::make_shared<belief::Model>(scenario->task, belief);
  scenario->planner = planner_options(description.planner);
  scenario->description = std::move(description);
  return scenario;
}

}  // namespace

std::shared_ptr<const belief::Model> Scenario::model_of(belief::Kind kind) const {
  if (kind == model->options.kind) return model;
  auto other = std::make_shared<belief::Model>(*model);
  other->options.kind = kind;
  return other;
}

std::shared_ptr<const Scenario> load(const std::filesystem::path& file) { return prepare(read_description(file)); }

std::shared_ptr<const Scenario> parse(const std::string& yaml, const std::filesystem::path& base_dir) {
  return prepare(parse_description(yaml, base_dir));
}

std::vector<std::string> check(const std::filesystem::path& file) {
  std::vector<std::string> problems;
  collected(problems, [&] { return load(file); });
  return problems;
}

}  // namespace tactus::scenario
