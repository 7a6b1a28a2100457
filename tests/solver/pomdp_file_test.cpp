// SPDX-License-Identifier: BSD-3-Clause
#include "solver/pomdp_file.hpp"

#include <gtest/gtest.h>
#include <tinyxml.h>

#include <limits>
#include <set>
#include <sstream>

#include "belief/small_task.hpp"
#include "solver/exact.hpp"
#include "solver/random_instance.hpp"
#include "solver/sampled_instance.hpp"

/// Instances written as files and read back by plain readers of the formats: the models are the instance, and so is
/// what the best policy costs on them.
namespace tactus::test {
namespace {

using solver::Instance;
using solver::InstancePtr;
using support::Rng;

constexpr double written = 1e-11;
constexpr double exact = 1e-8;

/// A POMDP as a file has it, by name. Observed is the state reached, as far as `observation` says.
struct Model {
  using Key = std::pair<std::string, std::string>;  ///< action, state
  double discount = 0.0;
  std::vector<std::string> actions;
  std::map<std::string, double> start;
  std::map<Key, std::map<std::string, double>> next;
  std::map<Key, double> reward;
  std::map<std::string, std::string> observation;  ///< by state
};

std::vector<std::string> words(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

// --- PomdpX

std::string text_of(const TiXmlElement* parent, std::initializer_list<const char*> path) {
  for (const char* name : path) parent = parent ? parent->FirstChildElement(name) : nullptr;
  return parent && parent->GetText() ? parent->GetText() : "";
}

/// The values that a variable may have.
std::vector<std::string> values(const TiXmlElement* root, const char* tag, const char* attribute,
                                const std::string& name) {
  const TiXmlElement* variable = root->FirstChildElement("Variable")->FirstChildElement(tag);
  while (variable->Attribute(attribute) != name) variable = variable->NextSiblingElement(tag);
  return words(text_of(variable, {"ValueEnum"}));
}

const TiXmlElement* function_of(const TiXmlElement* root, const char* section, const char* tag,
                                const std::string& variable) {
  const TiXmlElement* function = root->FirstChildElement(section)->FirstChildElement(tag);
  while (text_of(function, {"Var"}) != variable) function = function->NextSiblingElement(tag);
  return function;
}

/// Calls `visit(values, number)` for each entry of a function, once for each value that a `*` stands for.
template <typename Visit>
void for_each_entry(const TiXmlElement* function, const char* table, const std::vector<std::vector<std::string>>& all,
                    Visit&& visit) {
  const TiXmlElement* entry = function->FirstChildElement("Parameter")->FirstChildElement("Entry");
  for (; entry; entry = entry->NextSiblingElement("Entry")) {
    std::vector<std::vector<std::string>> rows{{}};
    const std::vector<std::string> given = words(text_of(entry, {"Instance"}));
    ASSERT_EQ(given.size(), all.size());
    for (std::size_t i = 0; i < given.size(); ++i) {
      std::vector<std::vector<std::string>> longer;
      for (const auto& row : rows)
        for (const std::string& value : given[i] == "*" ? all[i] : std::vector<std::string>{given[i]}) {
          longer.push_back(row);
          longer.back().push_back(value);
        }
      rows = std::move(longer);
    }
    for (const auto& row : rows) visit(row, std::stod(text_of(entry, {table})));
  }
}

std::string joined(const std::string& robot, const std::string& pose) {
  return robot == "goal" ? robot : robot + "_" + pose;
}

Model read_pomdpx(const std::string& text) {
  TiXmlDocument document;
  document.Parse(text.c_str());
  EXPECT_FALSE(document.Error()) << document.ErrorDesc();
  const TiXmlElement* root = document.RootElement();
  const auto robot = values(root, "StateVar", "vnamePrev", "robot_0");
  const auto pose = values(root, "StateVar", "vnamePrev", "pose_0");
  Model model;
  model.actions = values(root, "ActionVar", "vname", "motion");
  model.discount = std::stod(text_of(root, {"Discount"}));
  EXPECT_STREQ(root->FirstChildElement("Variable")->FirstChildElement("StateVar")->Attribute("fullyObs"), "true");

  const auto at = [&](const char* variable) {
    return words(
        text_of(function_of(root, "InitialStateBelief", "CondProb", variable), {"Parameter", "Entry", "ProbTable"}));
  };
  for (std::size_t r = 0; r < robot.size(); ++r)
    for (std::size_t p = 0; p < pose.size(); ++p)
      if (const double weight = std::stod(at("robot_0")[r]) * std::stod(at("pose_0")[p]); weight > 0.0)
        model.start[joined(robot[r], pose[p])] += weight;
  for_each_entry(function_of(root, "StateTransitionFunction", "CondProb", "robot_1"), "ProbTable",
                 {model.actions, robot, pose, robot}, [&](const auto& v, double p) {
                   model.next[{v[0], joined(v[1], v[2])}][joined(v[3], v[2])] = p;
                   model.observation[joined(v[1], v[2])] = v[1];
                 });
  std::set<std::string> still;
  for_each_entry(function_of(root, "StateTransitionFunction", "CondProb", "pose_1"), "ProbTable", {pose, pose},
                 [&](const auto& v, double p) {
                   EXPECT_EQ(v[0], v[1]);
                   EXPECT_EQ(p, 1.0);
                   still.insert(v[0]);
                 });
  EXPECT_EQ(still.size(), pose.size());
  for_each_entry(function_of(root, "RewardFunction", "Func", "reward"), "ValueTable", {model.actions, robot, pose},
                 [&](const auto& v, double r) {
                   model.reward[{v[0], joined(v[1], v[2])}] = r;
                 });
  return model;
}

// --- Cassandra's format

Model read_pomdp(const std::string& text) {
  Model model;
  std::vector<std::string> states, observations;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const std::vector<std::string> w = words(line);
    if (w.empty() || w[0] == "#") continue;
    const auto rest = std::vector<std::string>(w.begin() + 1, w.end());
    const auto each = [](const std::string& name, const std::vector<std::string>& all) {
      return name == "*" ? all : std::vector<std::string>{name};
    };
    if (w[0] == "discount:") {
      model.discount = std::stod(w[1]);
    } else if (w[0] == "values:") {
      EXPECT_EQ(w[1], "reward");
    } else if (w[0] == "states:") {
      states = rest;
    } else if (w[0] == "actions:") {
      model.actions = rest;
    } else if (w[0] == "observations:") {
      observations = rest;
    } else if (w[0] == "start:") {
      EXPECT_EQ(rest.size(), states.size());
      for (std::size_t i = 0; i < rest.size(); ++i)
        if (const double weight = std::stod(rest[i]); weight > 0.0) model.start[states[i]] = weight;
    } else if (w[0] == "T:") {
      for (const std::string& action : each(w[1], model.actions)) model.next[{action, w[3]}][w[5]] = std::stod(w[6]);
    } else if (w[0] == "O:") {
      EXPECT_EQ(w[1], "*");
      EXPECT_EQ(std::stod(w[6]), 1.0);
      EXPECT_NE(std::find(observations.begin(), observations.end(), w[5]), observations.end()) << w[5];
      model.observation[w[3]] = w[5];
    } else if (w[0] == "R:") {
      EXPECT_EQ(w[5] + w[7], "**");
      for (const std::string& action : each(w[1], model.actions)) model.reward[{action, w[3]}] = std::stod(w[8]);
    } else {
      ADD_FAILURE() << line;
    }
  }
  EXPECT_EQ(model.observation.size(), states.size());
  return model;
}

// --- the laws

std::string place_name(const Instance& instance, int place) {
  return "c" + std::to_string(place) +
         (instance.configurations[static_cast<std::size_t>(place)].contact ? "_touched" : "");
}

std::string state_name(const Instance& instance, int place, std::size_t pose) {
  return place == Instance::goal ? "goal" : place_name(instance, place) + "_p" + std::to_string(pose);
}

/// What the file says of a motion is what the instance does. False: the file does not have the state.
bool agrees(const Model& model, const Instance& instance, int place, std::size_t motion, std::size_t pose) {
  const std::string from = state_name(instance, place, pose);
  const auto next = model.next.find({instance.motions[motion], from});
  if (next == model.next.end()) return false;
  const auto& results = instance.configurations[static_cast<std::size_t>(place)].results[motion];
  const std::string to = results.empty() ? from : state_name(instance, results[pose].to, pose);
  const double cost = results.empty() ? solver::blocked_cost(instance) : results[pose].cost;
  EXPECT_EQ(next->second, (std::map<std::string, double>{{to, 1.0}})) << from;
  EXPECT_NEAR(model.reward.at({instance.motions[motion], from}), -cost, written);
  EXPECT_EQ(model.observation.at(from), place_name(instance, place));
  EXPECT_TRUE(model.next.count({instance.motions[motion], to})) << to << " is not a state";
  return true;
}

void expect_is(const Model& model, const Instance& instance, bool has_all_states) {
  EXPECT_EQ(model.discount, instance.discount);
  EXPECT_EQ(model.actions, instance.motions);
  EXPECT_EQ(model.start.size(), instance.weight.size());
  std::size_t found = 0, all = 0;
  for (std::size_t pose = 0; pose < instance.weight.size(); ++pose) {
    EXPECT_NEAR(model.start.at(state_name(instance, 0, pose)), instance.weight[pose], written);
    for (std::size_t place = 0; place < instance.configurations.size(); ++place)
      for (std::size_t motion = 0; motion < instance.motions.size(); ++motion) {
        found += agrees(model, instance, static_cast<int>(place), motion, pose);
        ++all;
      }
  }
  for (const std::string& action : model.actions) {
    EXPECT_EQ(model.next.at({action, "goal"}), (std::map<std::string, double>{{"goal", 1.0}}));
    EXPECT_EQ(model.reward.at({action, "goal"}), 0.0);
  }
  EXPECT_EQ(model.next.size(), found + model.actions.size());
  EXPECT_GT(found, 0u);
  if (has_all_states) {
    EXPECT_EQ(found, all);
  }
}

/// The best expected discounted reward, by value iteration over the beliefs that can come about.
double best_reward(const Model& model) {
  using Belief = std::map<std::string, double>;
  struct Node {
    Belief belief;
    std::vector<std::pair<double, std::vector<std::pair<double, std::size_t>>>> motions;
    double value = 0.0;
  };
  std::vector<Node> nodes;
  std::map<std::vector<std::string>, std::size_t> index;  // weights follow from the states
  const auto add = [&](const Belief& belief) {
    std::vector<std::string> key;
    for (const auto& [state, weight] : belief) key.push_back(state);
    const auto [entry, is_new] = index.try_emplace(key, nodes.size());
    if (is_new) nodes.push_back({belief, {}});
    return entry->second;
  };
  add(model.start);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const std::string& action : model.actions) {
      std::map<std::string, Belief> outcomes;
      double reward = 0.0, all = 0.0;
      for (const auto& [state, weight] : nodes[i].belief) {
        const std::string& to = model.next.at({action, state}).begin()->first;
        outcomes[model.observation.at(to)][to] += weight;
        reward += weight * model.reward.at({action, state});
        all += weight;
      }
      std::vector<std::pair<double, std::size_t>> arrows;
      for (const auto& [observation, belief] : outcomes) {
        double weight = 0.0;
        for (const auto& [state, w] : belief) weight += w;
        arrows.emplace_back(weight / all, add(belief));
      }
      nodes[i].motions.emplace_back(reward / all, arrows);
    }
  for (double change = 1.0; change > 1e-12;) {
    change = 0.0;
    for (Node& node : nodes) {
      double best = -std::numeric_limits<double>::infinity();
      for (const auto& [reward, arrows] : node.motions) {
        double q = reward;
        for (const auto& [probability, to] : arrows) q += model.discount * probability * nodes[to].value;
        best = std::max(best, q);
      }
      change = std::max(change, std::abs(best - node.value));
      node.value = best;
    }
  }
  return nodes.front().value;
}

TEST(PomdpFile, HoldsTheInstance) {
  Rng rng(1);
  for (int i = 0; i < 4; ++i) {
    const InstancePtr instance =
        random_instance(rng, {.poses = 8, .probes = 6, .configurations = 5, .equal_weights = i % 2 == 0});
    expect_is(read_pomdpx(solver::pomdpx(*instance)), *instance, true);
    expect_is(read_pomdp(solver::pomdp(*instance)), *instance, false);
  }
}

TEST(PomdpFile, IsSolvedAtTheSameCostAsTheInstance) {
  Rng rng(2);
  for (int i = 0; i < 4; ++i) {
    const InstancePtr instance =
        random_instance(rng, {.poses = 5, .probes = 4, .configurations = 4, .equal_weights = i % 2 == 0});
    solver::ExactSolver solver(instance, instance->discount);
    const double optimum = *solver.value(0, support::Bitset(instance->weight.size(), true));
    EXPECT_NEAR(best_reward(read_pomdpx(solver::pomdpx(*instance))), -optimum, exact);
    EXPECT_NEAR(best_reward(read_pomdp(solver::pomdp(*instance))), -optimum, exact);
  }
}

TEST(PomdpFile, OfATaskIsSolvedAtTheSameCost) {
  Rng rng(5);
  const auto instance = std::make_shared<const Instance>(
      solver::sampled_instance(*small_task(), {.poses = 5, .configurations = 16, .motions = 3}, rng));
  solver::ExactSolver solver(instance, instance->discount);
  const double optimum = *solver.value(0, support::Bitset(instance->weight.size(), true));
  for (const Model& model : {read_pomdpx(solver::pomdpx(*instance)), read_pomdp(solver::pomdp(*instance))}) {
    expect_is(model, *instance, false);
    EXPECT_NEAR(best_reward(model), -optimum, exact);
  }
}

TEST(PomdpFile, NothingButTheGoalIsFree) {
  Rng rng(3);
  const InstancePtr instance = random_instance(rng, {.poses = 8, .probes = 6, .configurations = 5});
  for (const Model& model : {read_pomdpx(solver::pomdpx(*instance)), read_pomdp(solver::pomdp(*instance))})
    for (const auto& [key, reward] : model.reward)
      if (key.second != "goal") {
        EXPECT_LT(reward, 0.0) << key.first << " at " << key.second;
      }
}

TEST(PomdpFile, ANameMayHoldAnything) {
  Rng rng(4);
  Instance instance = *random_instance(rng, {.poses = 3, .probes = 1, .configurations = 2});
  instance.name = "a<b> &\nstates: \"c\"\r\a\x01T: * : * uniform";
  expect_is(read_pomdp(solver::pomdp(instance)), instance, false);
  expect_is(read_pomdpx(solver::pomdpx(instance)), instance, true);
}

}  // namespace
}  // namespace tactus::test
