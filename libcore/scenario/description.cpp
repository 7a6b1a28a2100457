// SPDX-License-Identifier: BSD-3-Clause
#include "scenario/description.hpp"

#include <cmath>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>

#include "scenario/reader.hpp"

namespace tactus::scenario {
namespace {

namespace fs = std::filesystem;
using support::Error;
using support::Status;

constexpr Need required = Need::required;
constexpr Range at_most_a_turn{0.0, 2.0 * std::numbers::pi};
constexpr Range at_most_half{0.0, 0.5};
constexpr Range floors{0.001, 1.0};
constexpr Range deviations{scene::Normal::least_deviation, scene::Normal::greatest_deviation};
constexpr std::array dimensions{"x", "y", "z", "roll", "pitch", "yaw"};
constexpr std::uintmax_t largest_file = 1u << 20;

void read_mesh(Reader& in, MeshSource& mesh) {
  in.file("mesh", mesh.file, required);
  in.scale("scale", mesh.scale);
}

void read_resolution(Reader& in, Resolution& resolution) {
  in.number("position", resolution.position, positive);
  in.number("angle", resolution.angle, positive);
}

void read_robot(Reader& in, RobotDescription& robot) {
  in.file("urdf", robot.urdf, required);
  in.file("srdf", robot.srdf);
  in.folders("packages", robot.packages);
  in.pose("base", robot.world_from_base);
  in.text("tool_link", robot.tool_link, required);
  in.numbers("start", robot.start, any_number, required);
}

void read_tool(Reader& in, ToolDescription& tool) {
  read_mesh(in, tool.mesh);
  in.pose("pose", tool.tool_link_from_mesh);
}

void read_object(Reader& in, ObjectDescription& object) {
  geometry::Vector3 box;
  MeshSource mesh;
  in.text("name", object.name, required);
  in.vector("box", box, positive);
  in.file("mesh", mesh.file);
  in.scale("scale", mesh.scale);
  in.pose("pose", object.world_from_object);

  const bool has_box = in.has("box"), has_mesh = in.has("mesh");
  if (has_box) object.box = box;
  if (has_mesh) object.mesh = mesh;
  if (has_box == has_mesh) in.note("", has_box ? "both box and mesh" : "neither box nor mesh", "one of them");
  if (in.has("scale") && !has_mesh) in.note("scale", "a scale without a mesh", "it beside a mesh only");
}

void read_world(Reader& in, std::vector<ObjectDescription>& world) {
  std::set<std::string> names;
  in.sections("world", [&](Reader& object) {
    read_object(object, world.emplace_back());
    const std::string& name = world.back().name;
    if (!name.empty() && !names.insert(name).second)
      object.note("name", '"' + name + "\" a second time", "a name of its own");
  });
}

void read_target(Reader& in, TargetDescription& target) {
  read_mesh(in, target.mesh);
  in.poses("seated", target.target_from_seated_tool, required);
  in.vector("approach_axis", target.approach_axis, any_number, required);
  in.number("approach_depth", target.approach_depth, positive, required);
  in.section("tolerance", [&](Reader& tolerance) { read_resolution(tolerance, target.tolerance); });
  const double length = target.approach_axis.norm();
  if (length < 1e-9) return in.note("approach_axis", "a direction of no length", "one that isn't zero");
  target.approach_axis /= length;
}

/// Dimensions of no width do not count: nothing need be said of them.
void read_deviation(Reader& in, const geometry::PoseVector& width, scene::Matrix6& covariance) {
  for (int d = 0; d < 6; ++d) {
    const bool counts = width[d] > 0.0;
    double deviation = 0.0;
    in.number(dimensions[d], deviation, counts ? deviations : not_negative, counts ? Need::required : Need::optional);
    covariance(d, d) = deviation * deviation;
  }
}

bool is_symmetric(const scene::Matrix6& matrix) {
  const scene::Matrix6 size = matrix.cwiseAbs() + matrix.cwiseAbs().transpose();
  return ((matrix - matrix.transpose()).array().abs() <= 1e-9 * size.array()).all();
}

void read_covariance(Reader& in, const geometry::PoseVector& width, scene::Matrix6& covariance) {
  std::vector<double> numbers(covariance.data(), covariance.data() + covariance.size());
  in.numbers("covariance", numbers, any_number);
  if (numbers.size() != 36)
    return in.note("covariance", "a list of " + std::to_string(numbers.size()), "a list of 36 numbers, row by row");
  covariance = Eigen::Map<const scene::Matrix6>(numbers.data()).transpose();
  if (!is_symmetric(covariance)) return in.note("covariance", "a matrix that isn't symmetric", "a symmetric one");
  if (!scene::Normal::is_covariance(covariance, width))
    in.note("covariance", "a matrix that isn't positive definite in the dimensions of some width",
            "one that is, with variances from 1e-12 to 1e6");
}

/// Dimensions of no width aside.
void check_inside(Reader& in, const std::string& key, const PriorDescription& prior, geometry::PoseVector mean) {
  for (int d = 0; d < 6; ++d)
    if (prior.width[d] <= 0.0) mean[d] = prior.centre[d];
  if (!scene::Prior{prior.centre, prior.width}.contains(mean))
    in.note(key, "a pose outside the prior's widths", "one within them");
}

void read_normal(Reader& in, PriorDescription& prior) {
  GuessDescription& guess = prior.guesses.emplace_back();
  in.pose("mean", guess.mean, required);
  if (in.has("mean")) check_inside(in, "mean", prior, guess.mean);
  read_covariance(in, prior.width, guess.covariance);
  in.section("deviation", [&](Reader& deviation) { read_deviation(deviation, prior.width, guess.covariance); });
  const bool both = in.has("covariance") && in.has("deviation");
  if (in.has("covariance") == in.has("deviation"))
    in.note("", both ? "both covariance and deviation" : "neither covariance nor deviation", "one of them");
}

void read_poses(Reader& in, PriorDescription& prior) {
  in.sections("poses", [&](Reader& pose) {
    GuessDescription& guess = prior.guesses.emplace_back();
    pose.pose(guess.mean);
    pose.number("weight", guess.weight, positive);
    check_inside(pose, "", prior, guess.mean);
  });
  Resolution spread{0.02, 0.1};
  in.section("spread", [&](Reader& section) {
    section.number("position", spread.position, deviations);
    section.number("angle", spread.angle, deviations);
  });
  for (GuessDescription& guess : prior.guesses)
    for (int d = 0; d < 6; ++d) guess.covariance(d, d) = std::pow(d < 3 ? spread.position : spread.angle, 2);
}

void read_prior(Reader& in, PriorDescription& prior) {
  in.pose("centre", prior.centre, required);
  in.section("width", [&](Reader& width) {
    for (int d = 0; d < 6; ++d) width.number(dimensions[d], prior.width[d], d < 3 ? not_negative : at_most_a_turn);
  });
  read_poses(in, prior);
  in.section("normal", [&](Reader& normal) { read_normal(normal, prior); });
  in.number("floor", prior.floor, floors);

  const bool has_normal = in.has("normal"), has_poses = in.has("poses");
  if (has_normal && has_poses) in.note("", "both normal and poses", "one of them");
  if (has_poses && prior.guesses.empty()) in.note("poses", "none", "at least one");
  if (in.has("spread") && !has_poses) in.note("spread", "a spread without poses", "it beside poses only");
  if (in.has("floor") && !has_normal && !has_poses)
    in.note("floor", "a floor without normal or poses", "it beside one of them only");
}

void read_belief(Reader& in, BeliefDescription& belief) {
  in.choice("kind", belief.kind, {"hierarchical", "particles"});
  in.number("voxel_size", belief.voxel_size, positive);
  in.integer("delta", belief.delta, at_least_one);
  in.section("cell", [&](Reader& cell) { read_resolution(cell, belief.cell); });
  in.integer("max_cells", belief.max_cells, at_least_one);
  in.integer("particles", belief.particles, at_least_one);
  in.integer("threads", belief.threads, not_negative);
  in.choice("likelihood", belief.likelihood, {"calibrated", "paper"});
}

void read_contact(Reader& in, ContactDescription& contact) {
  in.number("margin", contact.margin, not_negative);
  in.number("stop_tolerance", contact.stop_tolerance, positive);
  in.number("step", contact.step, positive);
  in.number("insertion_step", contact.insertion_step, positive);
}

void read_sensing(Reader& in, SensingDescription& sensing) {
  in.number("stopping_distance", sensing.stopping_distance, not_negative);
  in.number("encoder_error", sensing.encoder_error, not_negative);
  in.number("missed_contacts", sensing.missed_contacts, at_most_half);
  in.number("false_contacts", sensing.false_contacts, at_most_half);
}

void read_motion(Reader& in, MotionDescription& motion) {
  in.number("speed", motion.speed, positive);
  in.number("approach_speed", motion.approach_speed, positive);
  in.number("insertion_speed", motion.insertion_speed, positive);
  in.number("acceleration", motion.acceleration, positive);
  in.number("joint_acceleration", motion.joint_acceleration, positive);
}

void read_actions(Reader& in, ActionsDescription& actions) {
  in.numbers("primitive_lengths", actions.primitive_lengths, positive);
  in.numbers("primitive_angles", actions.primitive_angles, positive);
  in.number("probe_spacing", actions.probe_spacing, positive);
  in.numbers("probe_depth", actions.probe_depth, any_number);
  in.integer("insertion_candidates", actions.insertion_candidates, at_least_one);
  in.number("standoff", actions.standoff, not_negative);
}

void read_cost(Reader& in, CostDescription& cost) {
  in.number("metre", cost.metre, not_negative);
  in.number("radian", cost.radian, not_negative);
  in.number("action", cost.action, not_negative);
}

void read_planner(Reader& in, PlannerDescription& planner) {
  in.choice("solver", planner.solver, {"rtdp-bel", "rtdp-inad", "rtdp-ad", "brtdp-bel", "tbl", "frontier", "rate"});
  in.number("budget_seconds", planner.budget_seconds, positive);
  in.integer("budget_expansions", planner.budget_expansions, not_negative);
  in.number("epsilon", planner.epsilon, {0.0, 1.0});
  in.integer("horizon", planner.horizon, at_least_one);
  in.number("cost_per_bit", planner.cost_per_bit, not_negative);
}

void read_limits(Reader& in, LimitsDescription& limits) {
  in.integer("actions", limits.actions, at_least_one);
  in.number("travel", limits.travel, positive);
  in.number("seconds", limits.seconds, positive);
}

void read_top(Reader& in, Description& all) {
  in.text("name", all.name);
  in.section(
      "robot", [&](Reader& robot) { read_robot(robot, all.robot); }, required);
  in.section(
      "tool", [&](Reader& tool) { read_tool(tool, all.tool); }, required);
  read_world(in, all.world);
  in.section(
      "target", [&](Reader& target) { read_target(target, all.target); }, required);
  in.section(
      "prior", [&](Reader& prior) { read_prior(prior, all.prior); }, required);
  in.section("belief", [&](Reader& belief) { read_belief(belief, all.belief); });
  in.section("contact", [&](Reader& contact) { read_contact(contact, all.contact); });
  in.section("sensing", [&](Reader& sensing) { read_sensing(sensing, all.sensing); });
  in.section("motion", [&](Reader& motion) { read_motion(motion, all.motion); });
  in.section("actions", [&](Reader& actions) { read_actions(actions, all.actions); });
  in.section("cost", [&](Reader& cost) { read_cost(cost, all.cost); });
  in.section("planner", [&](Reader& planner) { read_planner(planner, all.planner); });
  in.section("limits", [&](Reader& limits) { read_limits(limits, all.limits); });
  in.finish();
}

/// The one document in the text; what keeps it from being a map goes to `findings`.
std::optional<Place> top_of(const std::string& yaml, Findings& findings) {
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(yaml);
    if (documents.size() == 1 && documents[0].IsMap()) return Place{documents[0], 1, ""};
    findings.add(1, "", documents.size() > 1 ? "several documents" : "no map",
                 "a map with robot, tool, target and prior");
  } catch (const YAML::Exception& error) {
    findings.add(std::max(0, error.mark.line) + 1, "", "what isn't YAML (" + error.msg + ')', "YAML");
  }
  return std::nullopt;
}

std::string text_of(const fs::path& file) {
  std::error_code ignored;
  const fs::file_status status = fs::status(file, ignored);
  if (!fs::exists(status))
    throw Error(Status::file_not_found, file.string() + ": found no such file, expected a scenario");
  if (!fs::is_regular_file(status))
    throw Error(Status::file_unreadable,
                file.string() + ": found something that isn't a regular file, expected a scenario");
  const std::uintmax_t size = fs::file_size(file, ignored);
  if (size > largest_file)
    throw Error(Status::bad_scenario, file.string() + ": found " + std::to_string(size) + " bytes, expected at most " +
                                          std::to_string(largest_file));
  std::ostringstream text;
  std::ifstream stream(file, std::ios::binary);
  if (!(text << stream.rdbuf()) && size > 0)
    throw Error(Status::file_unreadable, file.string() + ": found a file that can't be read, expected a scenario");
  return text.str();
}

/// `heading` is the file in full, `name` what stands before each line number.
Description parse(const std::string& yaml, const fs::path& base_dir, const std::string& name,
                  const std::string& heading) {
  Findings findings(name, fs::absolute(base_dir.empty() ? "." : base_dir));
  Description description;
  description.name = fs::path(name).stem().string();
  if (std::optional<Place> top = top_of(yaml, findings)) {
    Reader reader(*std::move(top), findings);
    read_top(reader, description);
  }
  support::throw_if_any(findings.in_order_of_lines(), Status::bad_scenario, heading);
  return description;
}

}  // namespace

Description read_description(const fs::path& file) {
  if (file.empty()) throw Error(Status::file_not_found, "path: found an empty one, expected that of a scenario file");
  return parse(text_of(file), fs::absolute(file).parent_path(), file.filename().string(), file.string());
}

Description parse_description(const std::string& yaml, const fs::path& base_dir, const std::string& name) {
  return parse(yaml, base_dir, name, name);
}

}  // namespace tactus::scenario
