// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>

#include "solver/problem.hpp"
#include "support/rng.hpp"

namespace tactus::solver {

/// A small finite search, for those who solve it exactly: poses of the target, configurations of the robot, and what
/// comes of each motion. Given the pose nothing is random; what the robot observes is the configuration it gets to, and
/// whether the tool is seated. Const, shared.
struct Instance {
  static constexpr int goal = -1;  ///< in place of a configuration: the tool is seated, nothing is left to do

  /// What comes of a motion with the target at one pose.
  struct Result {
    int to = goal;
    double cost = 0.0;  ///< > 0
    bool operator==(const Result&) const = default;
  };
  using Results = std::vector<Result>;  ///< by pose

  struct Configuration {
    robot::JointVector q;
    bool contact = false;          ///< a contact brought the robot here
    std::vector<Results> results;  ///< by motion; empty where a motion can't be made
  };

  std::string name;
  std::vector<double> weight;                 ///< by pose; they sum to one
  std::vector<std::string> motions;           ///< their names
  std::vector<Configuration> configurations;  ///< the robot starts at the first
  double discount = 0.999;                    ///< of the cost of each further motion; 1: none
};

using InstancePtr = std::shared_ptr<const Instance>;

/// The poses of a set by where a motion takes the robot: what is known after it.
std::map<int, support::Bitset> split(const Instance::Results& results, const support::Bitset& poses);

/// What is known is what was known before, and the robot is where it was: such a motion is not made. (With a discount
/// putting things off could pay, were a motion's cost below 1 - discount of all that is to come.)
bool is_idle(const std::map<int, support::Bitset>& outcomes, std::size_t configuration);

double weight_of(const Instance& instance, const support::Bitset& poses);

/// The least cost with the pose known, by configuration and pose; infinite where the goal can't be reached.
std::vector<std::vector<double>> informed_costs(const Instance& instance, double discount);

/// A configuration and a set of an instance's poses: what the search plans on. An outcome's waypoint is a number for
/// the motion and where it ends; its choice has no motion. Undiscounted. Those of one start belong to one thread.
class InstanceState : public BeliefState {
 public:
  /// What the beliefs of one instance share. `informed`: `informed_costs` without discount.
  struct Shared {
    InstancePtr instance;
    std::vector<std::vector<double>> informed;
    SecondValue second = SecondValue::greedy;
    double cost_per_bit = 0.0;
    mutable std::map<std::pair<std::size_t, std::vector<std::uint64_t>>, double> upper;  ///< what has been computed
  };

  InstanceState(std::shared_ptr<const Shared> shared, std::size_t place, support::Bitset poses)
      : shared_(std::move(shared)), place_(place), poses_(std::move(poses)) {}

  /// All poses, the robot at the first configuration.
  static std::shared_ptr<const InstanceState> start(InstancePtr instance, SecondValue second = SecondValue::greedy);

  support::Hash128 hash() const override { return poses_.hash(support::mix(place_)); }
  const robot::JointVector& configuration() const override { return instance().configurations[place_].q; }
  Values heuristic() const override { return values(place_, poses_); }
  std::size_t support_size() const override { return poses_.count(); }
  std::vector<Choice> choices(const support::Deadline& deadline) const override;
  BeliefStatePtr successor(const Choice& choice, const Outcome& outcome) const override;

  /// Another belief of the same instance.
  std::shared_ptr<const InstanceState> at(std::size_t place, support::Bitset poses) const {
    return std::make_shared<const InstanceState>(shared_, place, std::move(poses));
  }

  std::size_t place() const { return place_; }  ///< the configuration's index
  const support::Bitset& poses() const { return poses_; }
  std::size_t motion_of(const Choice& choice) const;

 private:
  const Instance& instance() const { return *shared_->instance; }
  std::size_t ends() const { return instance().configurations.size() + 1; }
  Values values(std::size_t place, const support::Bitset& poses) const;
  double upper_bound(std::size_t place, const support::Bitset& poses) const;
  std::size_t motion_towards_nearest(std::size_t place, const support::Bitset& poses) const;
  std::optional<std::size_t> motion_of_best_rate(std::size_t place, const support::Bitset& poses) const;
  double cost_of(std::size_t motion, std::size_t place, const support::Bitset& poses) const;
  Outcome outcome(std::size_t motion, int to, const support::Bitset& poses) const;

  std::shared_ptr<const Shared> shared_;
  std::size_t place_;
  support::Bitset poses_;
};

}  // namespace tactus::solver
