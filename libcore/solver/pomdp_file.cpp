// SPDX-License-Identifier: BSD-3-Clause
#include "solver/pomdp_file.hpp"

#include <algorithm>
#include <iomanip>
#include <locale>
#include <sstream>

namespace tactus::solver {
namespace {

using support::Bitset;

/// For plain decimals, whatever the locale.
std::ostringstream text() {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << std::fixed << std::setprecision(12);
  return out;
}

std::string place_name(const Instance& instance, int place) {
  if (place == Instance::goal) return "goal";
  const bool contact = instance.configurations[static_cast<std::size_t>(place)].contact;
  return "c" + std::to_string(place) + (contact ? "_touched" : "");
}

std::string pose_name(std::size_t pose) { return "p" + std::to_string(pose); }

std::string state_name(const Instance& instance, int place, std::size_t pose) {
  return place == Instance::goal ? "goal" : place_name(instance, place) + "_" + pose_name(pose);
}

/// What comes of a motion, or of trying one that can't be made.
Instance::Result result_of(const Instance& instance, std::size_t place, std::size_t motion, std::size_t pose,
                           double blocked) {
  const Instance::Results& results = instance.configurations[place].results[motion];
  return results.empty() ? Instance::Result{static_cast<int>(place), blocked} : results[pose];
}

std::string escaped(const std::string& plain) {
  std::string result;
  for (const char c : plain) result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return result;
}

/// One line, without what XML has no way to say.
std::string description(const Instance& instance) {
  std::string name = instance.name;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return name + ": " + std::to_string(instance.weight.size()) + " poses, " +
         std::to_string(instance.configurations.size()) + " configurations, " +
         std::to_string(instance.motions.size()) + " motions. Rewards are costs, negated.";
}

// --- PomdpX

void entry(std::ostream& out, const std::string& instance, const char* table, double value) {
  out << "<Entry><Instance>" << instance << "</Instance><" << table << ">" << value << "</" << table << "></Entry>\n";
}

void open_function(std::ostream& out, const char* tag, const char* variable, const char* parents) {
  out << "<" << tag << "><Var>" << variable << "</Var><Parent>" << parents << "</Parent><Parameter type=\"TBL\">\n";
}

void close_function(std::ostream& out, const char* tag) { out << "</Parameter></" << tag << ">\n"; }

void write_variables(const Instance& instance, std::ostream& out) {
  out << "<Variable>\n<StateVar vnamePrev=\"robot_0\" vnameCurr=\"robot_1\" fullyObs=\"true\">\n<ValueEnum>goal";
  for (std::size_t place = 0; place < instance.configurations.size(); ++place)
    out << " " << place_name(instance, static_cast<int>(place));
  out << "</ValueEnum>\n</StateVar>\n<StateVar vnamePrev=\"pose_0\" vnameCurr=\"pose_1\" fullyObs=\"false\">\n"
      << "<ValueEnum>";
  for (std::size_t pose = 0; pose < instance.weight.size(); ++pose) out << (pose > 0 ? " " : "") << pose_name(pose);
  out << "</ValueEnum>\n</StateVar>\n<ActionVar vname=\"motion\">\n<ValueEnum>";
  for (std::size_t motion = 0; motion < instance.motions.size(); ++motion)
    out << (motion > 0 ? " " : "") << instance.motions[motion];
  out << "</ValueEnum>\n</ActionVar>\n<RewardVar vname=\"reward\"/>\n</Variable>\n";
}

void write_start(const Instance& instance, std::ostream& out) {
  out << "<InitialStateBelief>\n";
  open_function(out, "CondProb", "robot_0", "null");
  out << "<Entry><Instance>-</Instance><ProbTable>0.0";
  for (std::size_t place = 0; place < instance.configurations.size(); ++place) out << (place == 0 ? " 1.0" : " 0.0");
  out << "</ProbTable></Entry>\n";
  close_function(out, "CondProb");
  open_function(out, "CondProb", "pose_0", "null");
  out << "<Entry><Instance>-</Instance><ProbTable>";
  for (std::size_t pose = 0; pose < instance.weight.size(); ++pose)
    out << (pose > 0 ? " " : "") << instance.weight[pose];
  out << "</ProbTable></Entry>\n";
  close_function(out, "CondProb");
  out << "</InitialStateBelief>\n";
}

/// Calls `visit(names, result)` for every motion, configuration and pose; once for all poses where they are all alike.
template <typename Visit>
void for_each_result(const Instance& instance, Visit&& visit) {
  const double blocked = blocked_cost(instance);
  for (std::size_t motion = 0; motion < instance.motions.size(); ++motion)
    for (std::size_t place = 0; place < instance.configurations.size(); ++place) {
      const std::string names = instance.motions[motion] + " " + place_name(instance, static_cast<int>(place)) + " ";
      const Instance::Results& results = instance.configurations[place].results[motion];
      const bool alike = std::all_of(results.begin(), results.end(), [&](const auto& r) { return r == results[0]; });
      for (std::size_t pose = 0; pose < (alike ? 1 : results.size()); ++pose)
        visit(names + (alike ? "*" : pose_name(pose)), result_of(instance, place, motion, pose, blocked));
    }
}

void write_transitions(const Instance& instance, std::ostream& out) {
  out << "<StateTransitionFunction>\n";
  open_function(out, "CondProb", "robot_1", "motion robot_0 pose_0");
  entry(out, "* goal * goal", "ProbTable", 1.0);
  for_each_result(instance, [&](const std::string& names, const Instance::Result& result) {
    entry(out, names + " " + place_name(instance, result.to), "ProbTable", 1.0);
  });
  close_function(out, "CondProb");
  open_function(out, "CondProb", "pose_1", "pose_0");
  for (std::size_t pose = 0; pose < instance.weight.size(); ++pose)
    entry(out, pose_name(pose) + " " + pose_name(pose), "ProbTable", 1.0);
  close_function(out, "CondProb");
  out << "</StateTransitionFunction>\n";
}

void write_rewards(const Instance& instance, std::ostream& out) {
  out << "<RewardFunction>\n";
  open_function(out, "Func", "reward", "motion robot_0 pose_0");
  entry(out, "* goal *", "ValueTable", 0.0);
  for_each_result(instance, [&](const std::string& names, const Instance::Result& result) {
    entry(out, names, "ValueTable", -result.cost);
  });
  close_function(out, "Func");
  out << "</RewardFunction>\n";
}

// --- Cassandra's format

/// The poses with which each configuration can come about.
std::vector<Bitset> reachable(const Instance& instance) {
  const std::size_t poses = instance.weight.size();
  std::vector<Bitset> found(instance.configurations.size(), Bitset(poses));
  found.front() = Bitset(poses, true);
  std::vector<std::pair<std::size_t, std::size_t>> open;
  for (std::size_t pose = 0; pose < poses; ++pose) open.emplace_back(0, pose);
  while (!open.empty()) {
    const auto [place, pose] = open.back();
    open.pop_back();
    for (const Instance::Results& results : instance.configurations[place].results) {
      if (results.empty() || results[pose].to == Instance::goal) continue;
      const auto to = static_cast<std::size_t>(results[pose].to);
      if (found[to].test(pose)) continue;
      found[to].set(pose);
      open.emplace_back(to, pose);
    }
  }
  return found;
}

/// Calls `visit(configuration, pose)` for every state but the goal.
template <typename Visit>
void for_each_state(const std::vector<Bitset>& states, Visit&& visit) {
  for (std::size_t place = 0; place < states.size(); ++place)
    states[place].for_each([&](std::size_t pose) { visit(static_cast<int>(place), pose); });
}

void write_preamble(const Instance& instance, const std::vector<Bitset>& states, std::ostream& out) {
  out << "# " << description(instance) << "\ndiscount: " << instance.discount << "\nvalues: reward\nstates: goal";
  for_each_state(states, [&](int place, std::size_t pose) { out << " " << state_name(instance, place, pose); });
  out << "\nactions:";
  for (const std::string& motion : instance.motions) out << " " << motion;
  out << "\nobservations: goal";
  for (std::size_t place = 0; place < states.size(); ++place)
    out << " " << place_name(instance, static_cast<int>(place));
  out << "\nstart: 0.0";
  for_each_state(states, [&](int place, std::size_t pose) {
    out << " ";
    if (place == 0)
      out << instance.weight[pose];
    else
      out << "0.0";
  });
  out << "\n\nT: * : goal : goal 1.0\nO: * : goal : goal 1.0\nR: * : goal : * : * 0.0\n";
}

}  // namespace

double blocked_cost(const Instance& instance) {
  double most = 0.0;
  for (const Instance::Configuration& configuration : instance.configurations)
    for (const Instance::Results& results : configuration.results)
      for (const Instance::Result& result : results) most = std::max(most, result.cost);
  return most;
}

std::string pomdpx(const Instance& instance) {
  std::ostringstream out = text();
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<pomdpx version=\"1.0\" id=\"tactus\" "
      << "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" xsi:noNamespaceSchemaLocation=\"pomdpx.xsd\">\n"
      << "<Description>" << escaped(description(instance)) << "</Description>\n<Discount>" << instance.discount
      << "</Discount>\n";
  write_variables(instance, out);
  write_start(instance, out);
  write_transitions(instance, out);
  write_rewards(instance, out);
  out << "</pomdpx>\n";
  return out.str();
}

std::string pomdp(const Instance& instance) {
  std::ostringstream out = text();
  const std::vector<Bitset> states = reachable(instance);
  const double blocked = blocked_cost(instance);
  write_preamble(instance, states, out);
  for_each_state(states, [&](int place, std::size_t pose) {
    const std::string from = state_name(instance, place, pose);
    out << "O: * : " << from << " : " << place_name(instance, place) << " 1.0\n";
    for (std::size_t motion = 0; motion < instance.motions.size(); ++motion) {
      const Instance::Result result = result_of(instance, static_cast<std::size_t>(place), motion, pose, blocked);
      out << "T: " << instance.motions[motion] << " : " << from << " : " << state_name(instance, result.to, pose)
          << " 1.0\nR: " << instance.motions[motion] << " : " << from << " : * : * " << -result.cost << "\n";
    }
  });
  return out.str();
}

}  // namespace tactus::solver
