// SPDX-License-Identifier: BSD-3-Clause
#include "bench/comparison.hpp"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "bench/fcl_baseline.hpp"
#include "bench/timing.hpp"
#include "contact/target_contact.hpp"

namespace tactus::bench {
namespace {

using Pairs = std::vector<std::size_t>;  // motion * poses + pose, ascending

constexpr double trial_pairs = 4000.0;  // on which FCL's trees are tried against each other
constexpr double trial_seconds = 0.3;
constexpr double our_seconds = 1.0;
constexpr std::size_t told = 20;  // disagreements, at most

Pairs random_share(std::size_t pairs, double share, support::Rng rng) {
  Pairs chosen;
  for (std::size_t pair = 0; pair < pairs; ++pair)
    if (rng.uniform() < share) chosen.push_back(pair);
  if (chosen.empty()) chosen.push_back(rng.below(pairs));
  return chosen;
}

std::vector<Pose> body_poses(const Setting& setting, std::size_t motion) {
  std::vector<Pose> poses;
  for (const JointVector& q : setting.motions[motion]) setting.bodies->append_poses(q, poses);
  return poses;
}

std::vector<int> ask(const FclBaseline& baseline, const Setting& setting, const Pairs& pairs) {
  std::vector<int> answers;
  answers.reserve(pairs.size());
  std::vector<Pose> poses;
  const std::size_t targets = setting.base_from_target.size();
  std::size_t motion = setting.motions.size();
  for (const std::size_t pair : pairs) {
    if (pair / targets != motion) poses = body_poses(setting, motion = pair / targets);
    answers.push_back(baseline.first_contact(poses, setting.base_from_target[pair % targets]));
  }
  return answers;
}

std::vector<int> ask(const contact::TargetContact& ours, const Setting& setting) {
  std::vector<int> answers;
  answers.reserve(setting.pairs());
  for (const std::vector<JointVector>& waypoints : setting.motions) {
    const contact::BodyPath path(*setting.bodies, waypoints);
    for (const Pose& pose : setting.base_from_target) {
      const std::optional<std::size_t> first = ours.first_contact(path, pose);
      answers.push_back(first ? static_cast<int>(*first) : -1);
    }
  }
  return answers;
}

struct Fastest {
  std::unique_ptr<const FclBaseline> baseline;
  std::string trees;  ///< for the note
};

Fastest fastest_baseline(const Setting& setting, const Options& options) {
  const Pairs trial =
      random_share(setting.pairs(), trial_pairs / static_cast<double>(setting.pairs()), support::Rng(options.seed));
  auto obbrss = std::make_unique<const FclBaseline>(*setting.bodies, setting.target.mesh, FclTree::obbrss);
  auto obb = std::make_unique<const FclBaseline>(*setting.bodies, setting.target.mesh, FclTree::obb);
  const double with_obbrss = thread_seconds("OBBRSS", trial_seconds, [&] { ask(*obbrss, setting, trial); });
  const double with_obb = thread_seconds("OBB", trial_seconds, [&] { ask(*obb, setting, trial); });
  std::ostringstream trees;
  trees << std::fixed << std::setprecision(1) << "FCL with " << (with_obb < with_obbrss ? "OBB" : "OBBRSS") << " (OBB "
        << 1e6 * with_obb / static_cast<double>(trial.size()) << ", OBBRSS "
        << 1e6 * with_obbrss / static_cast<double>(trial.size()) << " us/pair tried on " << trial.size() << " pairs)";
  return {with_obb < with_obbrss ? std::move(obb) : std::move(obbrss), trees.str()};
}

bool flips(const FclBaseline& baseline, const std::vector<Pose>& bodies, const Pose& pose, int ours) {
  for (int i = 0; i < 6; ++i) {
    Pose shifted = pose;
    shifted.translation()[i / 2] += i % 2 == 0 ? 1e-9 : -1e-9;
    if (baseline.first_contact(bodies, shifted) == ours) return true;
  }
  return false;
}

std::string described(std::size_t motion, const Pose& pose, int fcl, int ours) {
  double numbers[7];
  geometry::to_quaternion(pose, numbers);
  std::ostringstream out;
  out << std::setprecision(17) << "motion " << motion << ", target at";
  for (const double number : numbers) out << ' ' << number;
  out << ": FCL " << fcl << ", ours " << ours;
  return out.str();
}

void count_agreement(const Setting& setting, const FclBaseline& baseline, const Pairs& pairs,
                     const std::vector<int>& fcl, const std::vector<int>& ours, Row& row) {
  row.compared = pairs.size();
  row.agreeing = row.flips_within_1e_9 = 0;
  std::size_t untold = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::size_t motion = pairs[i] / setting.base_from_target.size();
    const Pose& pose = setting.base_from_target[pairs[i] % setting.base_from_target.size()];
    if (fcl[i] == ours[pairs[i]])
      ++*row.agreeing;
    else if (flips(baseline, body_poses(setting, motion), pose, ours[pairs[i]]))
      ++*row.flips_within_1e_9;
    else if (row.disagreements.size() < told)
      row.disagreements.push_back(described(motion, pose, fcl[i], ours[pairs[i]]));
    else
      ++untold;
  }
  if (untold > 0) row.disagreements.push_back("and " + std::to_string(untold) + " more");
}

std::string described(const Setting& setting, const std::vector<int>& ours) {
  std::size_t links = 0;
  for (std::size_t body = 1; body < setting.bodies->size(); ++body)
    links += setting.bodies->body(body).mesh().triangles.size();
  const auto percent = [&](const auto& counts) {
    return 100.0 * static_cast<double>(std::count_if(ours.begin(), ours.end(), counts)) /
           static_cast<double>(setting.pairs());
  };
  std::ostringstream out;
  out << "tool " << setting.bodies->body(0).mesh().triangles.size() << " triangles, ";
  if (links > 0)
    out << setting.bodies->size() - 1 << " links " << links;
  else
    out << "no links";
  out << ", " << setting.target.name << ' ' << setting.target.mesh.triangles.size() << std::fixed
      << std::setprecision(1) << "; " << percent([](int first) { return first >= 0; }) << " % of the pairs hit, "
      << percent([](int first) { return first == 1; }) << " % at the first configuration";
  return out.str();
}

}  // namespace

Row compare(const std::string& work, const Setting& setting, const Options& options) {
  std::cerr << work << ": " << setting.target.name << ", n = " << setting.n() << ", " << setting.pairs() << " pairs\n";
  Row row;
  row.work = work;
  row.pairs = setting.pairs();
  row.n = setting.n();

  const contact::TargetContact contact(setting.bodies, setting.target.mesh, 0.0);
  std::vector<int> ours, fcl;
  row.ours_s = thread_seconds("ours", our_seconds, [&] { ours = ask(contact, setting); });
  row.memory_mib = resident_mib();

  const Fastest fastest = fastest_baseline(setting, options);
  const Pairs pairs = random_share(setting.pairs(), options.baseline_share, support::Rng(options.seed));
  const double share = static_cast<double>(pairs.size()) / static_cast<double>(setting.pairs());
  row.baseline_s = thread_seconds("FCL", 0.0, [&] { fcl = ask(*fastest.baseline, setting, pairs); }) / share;
  row.note = described(setting, ours) + "; " + fastest.trees;
  if (pairs.size() < setting.pairs())
    row.note += "; baseline measured on " + std::to_string(pairs.size()) + " random pairs and scaled";
  count_agreement(setting, *fastest.baseline, pairs, fcl, ours, row);
  return row;
}

}  // namespace tactus::bench
