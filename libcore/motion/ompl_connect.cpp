// SPDX-License-Identifier: BSD-3-Clause
#include "motion/ompl_connect.hpp"

#include <ompl/base/goals/GoalState.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <numbers>

#include "support/log.hpp"
#include "support/rng.hpp"

namespace tactus::motion {

namespace ob = ompl::base;
namespace og = ompl::geometric;

namespace {

constexpr double longest_edge = 2.0;         // rad, of a tree
constexpr double margin = std::numbers::pi;  // rad, by which the search may leave the box about its two ends

class LogHandler : public ompl::msg::OutputHandler {
 public:
  void log(const std::string& text, ompl::msg::LogLevel level, const char*, int) override {
    using support::LogLevel;
    const LogLevel ours = level >= ompl::msg::LOG_ERROR  ? LogLevel::error
                          : level >= ompl::msg::LOG_WARN ? LogLevel::warning
                                                         : LogLevel::debug;
    support::log(ours, "ompl: " + text);
  }
};

// OMPL has one handler a process, and standard output is its default.
void send_messages_to_log() {
  static LogHandler handler;
  static const bool sent = (ompl::msg::useOutputHandler(&handler), true);
  (void)sent;
}

JointVector joints_of(const ob::State* state, int dof) {
  return Eigen::Map<const JointVector>(state->as<ob::RealVectorStateSpace::StateType>()->values, dof);
}

// Samples from our own generator (OMPL's depend on what the process did before), and counts.
class CountingSampler : public ob::RealVectorStateSampler {
 public:
  CountingSampler(const ob::StateSpace* space, std::uint64_t seed, int& drawn)
      : RealVectorStateSampler(space), own_rng_(seed), drawn_(drawn) {}

  void sampleUniform(ob::State* state) override {
    ++drawn_;
    const auto& bounds = space_->as<ob::RealVectorStateSpace>()->getBounds();
    double* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
    for (std::size_t j = 0; j < bounds.low.size(); ++j) values[j] = own_rng_.uniform(bounds.low[j], bounds.high[j]);
  }

 private:
  support::Rng own_rng_;
  int& drawn_;
};

// Motions are free at our resolution: the robot's way in metres, and not OMPL's fraction of the space.
class StepValidator : public ob::MotionValidator {
 public:
  StepValidator(const ob::SpaceInformationPtr& space, const contact::KnownWorld& world, double step)
      : MotionValidator(space), world_(world), step_(step) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    const int dof = world_.model().dof();
    return straight_joint_path(world_, joints_of(from, dof), joints_of(to, dof), step_).has_value();
  }

  // Only planners that keep the free part of a motion ask this; ours does not.
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last_valid) const override {
    last_valid.second = 0.0;
    if (last_valid.first != nullptr) si_->copyState(last_valid.first, from);
    return checkMotion(from, to);
  }

 private:
  const contact::KnownWorld& world_;
  double step_;
};

// The limits, but no more than half a turn beyond the two ends: whole turns more lead nowhere new.
ob::RealVectorBounds search_bounds(const robot::RobotModel& model, const JointVector& from, const JointVector& to) {
  ob::RealVectorBounds bounds(static_cast<unsigned>(model.dof()));
  for (int j = 0; j < model.dof(); ++j) {
    const robot::Joint& joint = model.joints[static_cast<std::size_t>(j)];
    const auto [low, high] = std::minmax(from[j], to[j]);
    bounds.setLow(static_cast<unsigned>(j), std::min(low, std::max(joint.lower, low - margin)));
    bounds.setHigh(static_cast<unsigned>(j), std::max(high, std::min(joint.upper, high + margin)));
  }
  return bounds;
}

ob::ScopedState<ob::RealVectorStateSpace> state_of(const ob::StateSpacePtr& space, const JointVector& q) {
  ob::ScopedState<ob::RealVectorStateSpace> state(space);
  for (Eigen::Index j = 0; j < q.size(); ++j) state[static_cast<unsigned>(j)] = q[j];
  return state;
}

ob::SpaceInformationPtr space_information(const contact::KnownWorld& world, const ob::StateSpacePtr& space,
                                          double step) {
  auto information = std::make_shared<ob::SpaceInformation>(space);
  const int dof = world.model().dof();
  information->setStateValidityChecker(
      [&world, dof](const ob::State* state) { return world.is_free(joints_of(state, dof)); });
  information->setMotionValidator(std::make_shared<StepValidator>(information, world, step));
  information->setup();
  return information;
}

JointPath corners_of(const ob::ProblemDefinition& problem, int dof) {
  JointPath corners;
  for (const ob::State* state : problem.getSolutionPath()->as<og::PathGeometric>()->getStates())
    corners.push_back(joints_of(state, dof));
  return corners;
}

}  // namespace

std::optional<JointPath> rrt_connect(const contact::KnownWorld& world, const JointVector& from, const JointVector& to,
                                     const ConnectOptions& options, const support::Deadline& deadline) {
  send_messages_to_log();
  const robot::RobotModel& model = world.model();
  int drawn = 0;
  auto space = std::make_shared<ob::RealVectorStateSpace>(static_cast<unsigned>(model.dof()));
  space->setBounds(search_bounds(model, from, to));
  space->setStateSamplerAllocator([&](const ob::StateSpace* of) -> ob::StateSamplerPtr {
    return std::make_shared<CountingSampler>(of, options.seed, drawn);
  });
  const ob::SpaceInformationPtr information = space_information(world, space, options.step);

  auto problem = std::make_shared<ob::ProblemDefinition>(information);
  problem->setStartAndGoalStates(state_of(space, from), state_of(space, to));

  // Linear search among neighbours: OMPL's trees of neighbours draw from its global generator.
  og::RRTConnect planner(information);
  planner.setProblemDefinition(problem);
  planner.setRange(longest_edge);
  planner.setNearestNeighbors<ompl::NearestNeighborsLinear>();
  planner.solve(ob::PlannerTerminationCondition([&] { return drawn >= options.iterations || deadline.spent(); }));
  if (!problem->hasExactSolution()) return std::nullopt;
  return corners_of(*problem, model.dof());
}

}  // namespace tactus::motion
