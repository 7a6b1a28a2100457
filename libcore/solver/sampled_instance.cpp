// SPDX-License-Identifier: BSD-3-Clause
#include "solver/sampled_instance.hpp"

#include <algorithm>
#include <cmath>

#include "action/insertion.hpp"
#include "action/library.hpp"
#include "action/primitives.hpp"
#include "action/probes.hpp"
#include "support/error.hpp"

namespace tactus::solver {
namespace {

using action::MotionPtr;
using geometry::Pose;
using robot::JointVector;
using support::Bitset;
using support::Error;
using support::Status;

constexpr int tries_per_pose = 100;
constexpr std::size_t touches = 2;  // small moves from a configuration
constexpr std::size_t largest = 1000;
constexpr std::size_t fixed_configurations = 3;  // the start, and home after a contact and without
constexpr std::size_t least_configurations = fixed_configurations + 2;  // where a contact and the end take the robot

void check(const SampleOptions& options) {
  const auto within = [](const char* name, std::size_t found, std::size_t least) {
    if (found < least || found > largest)
      throw Error(Status::invalid_argument, "instance options: " + std::string(name) + ": found " +
                                                std::to_string(found) + ", expected " + std::to_string(least) + " to " +
                                                std::to_string(largest));
  };
  within("poses", options.poses, 1);
  within("configurations", options.configurations, least_configurations);
  within("motions", options.motions, 1);
  if (!(options.discount > 0.0 && options.discount <= 1.0))
    throw Error(Status::invalid_argument, "instance options: discount: found " + std::to_string(options.discount) +
                                              ", expected more than 0, at most 1");
}

/// Where the poses are first touched on a motion: a waypoint each; the path's size if there is no contact.
using Touches = std::vector<std::size_t>;

/// Shannon entropy in bits of a partition given by a label for each pose, over some of them.
template <typename Label>
double entropy(const std::vector<Label>& labels, const Bitset& poses) {
  std::map<Label, double> count;
  poses.for_each([&](std::size_t pose) { count[labels[pose]] += 1.0; });
  const auto total = static_cast<double>(poses.count());
  double bits = 0.0;
  for (const auto& [label, n] : count) bits -= n / total * std::log2(n / total);
  return bits;
}

/// For each pose touched on a motion, the waypoint to which the robot backs off: of the last free ones at most `most`.
std::vector<std::size_t> stops(const Touches& touched, std::size_t end, const Bitset& poses, std::size_t most) {
  std::vector<std::size_t> distinct;
  poses.for_each([&](std::size_t pose) {
    if (touched[pose] < end) distinct.push_back(touched[pose] - 1);
  });
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  std::vector<std::size_t> kept;
  const std::size_t count = std::min(most, distinct.size());
  for (std::size_t i = 0; i < count; ++i) kept.push_back(distinct[i * distinct.size() / count]);
  std::vector<std::size_t> result(touched.size(), 0);
  poses.for_each([&](std::size_t pose) {
    if (touched[pose] < end) result[pose] = *std::prev(std::upper_bound(kept.begin(), kept.end(), touched[pose] - 1));
  });
  return result;
}

class Maker {
 public:
  Maker(const action::Task& task, const SampleOptions& options) : task_(task), options_(options), library_(task) {
    made_.name = "instance";
    made_.discount = options.discount;
  }

  Instance make(support::Rng& rng) {
    draw_poses(rng);
    intern(task_.scene().start, false);
    home_ = intern(task_.home(), false);
    home_touched_ = intern(task_.home(), true);
    choose_probes();
    for (const MotionPtr& motion : probes_) add_probe(motion);
    for (std::size_t i = 0; i < insertions_.size(); ++i) add_insertion(i);
    for (std::size_t slot = 0; slot < touches; ++slot) made_.motions.push_back("touch" + std::to_string(slot));
    add_touches();
    offer_anchored();
    return std::move(made_);
  }

 private:
  /// What a motion comes to whatever the robot did before: where it ends, and the cost from its first waypoint on.
  struct Anchored {
    MotionPtr motion;
    Instance::Results results;
  };

  std::size_t poses() const { return poses_.size(); }
  Bitset all() const { return Bitset(poses(), true); }

  Touches touched(const action::Motion& motion) const {
    Touches result;
    for (const Pose& pose : poses_)
      result.push_back(task_.target_contact().first_contact(motion.bodies, pose).value_or(motion.path.size()));
    return result;
  }

  /// Poses at which an attempt seats the tool.
  void draw_poses(support::Rng& rng) {
    for (std::size_t tries = 0; poses() < options_.poses; ++tries) {
      if (tries == options_.poses * tries_per_pose)
        throw Error(Status::motion_infeasible,
                    "instance: found " + std::to_string(poses()) + " poses in " + std::to_string(tries) +
                        " drawn at which the tool can be inserted, " + "expected " + std::to_string(options_.poses) +
                        "; ask for fewer, or move the robot or the prior");
      const Pose pose = task_.scene().prior.sample(rng);
      const MotionPtr motion = attempt_at(pose);
      if (!motion) continue;
      poses_.push_back(pose);
      insertions_.push_back(motion);
    }
    made_.weight.assign(poses(), 1.0 / static_cast<double>(poses()));
  }

  /// An attempt that seats the tool at a target there; null if none does.
  MotionPtr attempt_at(const Pose& pose) const {
    for (std::size_t seat = 0; seat < task_.scene().target.target_from_seated.size(); ++seat) {
      MotionPtr motion = action::insertion(task_, pose, task_.home(), seat);
      if (motion && !task_.target_contact().first_contact(motion->bodies, pose) && seats(*motion, pose)) return motion;
    }
    return nullptr;
  }

  bool seats(const action::Motion& motion, const Pose& pose) const {
    return task_.scene().is_seated(motion.bodies.base_from_body(motion.path.size() - 1, 0), pose);
  }

  /// A sweep or poke, and where each pose ends it: the waypoint to which the robot backs off, or the path's size.
  struct Probe {
    MotionPtr motion;
    std::vector<std::size_t> end;
  };

  /// One after the other, that which tells the poses apart best together with those before it, and by itself.
  void choose_probes() {
    constexpr double alone = 0.01;
    std::vector<Probe> candidates = telling_probes();
    std::vector<std::vector<std::size_t>> told(poses());
    while (probes_.size() < most_probes() && !candidates.empty()) {
      std::size_t best = 0;
      double most = -1.0;
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        const auto& end = candidates[i].end;
        const double bits = entropy(with(told, end), all()) + alone * entropy(end, all());
        if (bits > most) most = bits, best = i;
      }
      told = with(told, candidates[best].end);
      probes_.push_back(candidates[best].motion);
      candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(best));
    }
  }

  std::vector<Probe> telling_probes() const {
    std::vector<Probe> result;
    for (const MotionPtr& motion : action::probes(task_, task_.frame().region, task_.home())) {
      const Touches contacts = touched(*motion);
      std::vector<std::size_t> end = stops(contacts, motion->path.size(), all(), stops_per_probe());
      for (std::size_t pose = 0; pose < poses(); ++pose)
        if (contacts[pose] == motion->path.size()) end[pose] = motion->path.size();
      if (entropy(end, all()) > 0.0) result.push_back({motion, std::move(end)});
    }
    return result;
  }

  /// After a contact. Half of the configurations are for where sweeps and pokes end, one of each being the path's end.
  std::size_t stops_per_probe() const {
    return std::max<std::size_t>(options_.configurations / 2 / most_probes(), 2) - 1;
  }

  std::size_t most_probes() const {
    return std::min(options_.motions, (options_.configurations - fixed_configurations) / 2);
  }

  static std::vector<std::vector<std::size_t>> with(std::vector<std::vector<std::size_t>> told,
                                                    const std::vector<std::size_t>& more) {
    for (std::size_t pose = 0; pose < told.size(); ++pose) told[pose].push_back(more[pose]);
    return told;
  }

  /// The index of a configuration, new or known.
  int intern(const JointVector& q, bool contact) {
    for (std::size_t i = 0; i < made_.configurations.size(); ++i)
      if (made_.configurations[i].contact == contact && made_.configurations[i].q == q) return static_cast<int>(i);
    made_.configurations.push_back({q, contact, {}});
    return static_cast<int>(made_.configurations.size()) - 1;
  }

  /// Of going to the contact and back to where the robot stops, or to the end.
  double cost(const action::Motion& motion, std::size_t contact, std::size_t stop) const {
    const double fixed = task_.options().cost.action;
    if (contact == motion.path.size()) return fixed + motion.cost_to.back();
    return fixed + 2.0 * motion.cost_to[contact] - motion.cost_to[stop];
  }

  Instance::Results results_of(const action::Motion& motion, const Touches& touched, const Bitset& poses,
                               std::size_t most_stops) {
    const std::size_t end = motion.path.size();
    const std::vector<std::size_t> stop = stops(touched, end, poses, most_stops);
    Instance::Results results(touched.size());
    poses.for_each([&](std::size_t pose) {
      const bool contact = touched[pose] < end;
      results[pose] = {intern(motion.path[contact ? stop[pose] : end - 1], contact),
                       cost(motion, touched[pose], stop[pose])};
    });
    return results;
  }

  void add_probe(const MotionPtr& motion) {
    made_.motions.push_back((motion->kind == action::Kind::sweep ? "sweep" : "poke") +
                            std::to_string(anchored_.size()));
    anchored_.push_back({motion, results_of(*motion, touched(*motion), all(), stops_per_probe())});
  }

  void add_insertion(std::size_t i) {
    const action::Motion& motion = *insertions_[i];
    const Touches touched = this->touched(motion);
    Instance::Results results;
    for (std::size_t pose = 0; pose < poses(); ++pose) {
      const bool contact = touched[pose] < motion.path.size();
      const std::size_t last = contact ? touched[pose] - 1 : motion.path.size() - 1;
      const double there = cost(motion, touched[pose], last);
      if (!contact && seats(motion, poses_[pose]))
        results.push_back({Instance::goal, there});
      else
        results.push_back(
            {contact ? home_touched_ : home_, there + action::transit_cost(task_, motion.bodies.base_from_body(last, 0),
                                                                           task_.base_from_tool(task_.home()))});
    }
    made_.motions.push_back("insertion" + std::to_string(i));
    anchored_.push_back({insertions_[i], std::move(results)});
  }

  /// From where sweeps and pokes end, the small moves that tell most at their cost about the poses with which they do.
  void add_touches() {
    const std::vector<Bitset> with = poses_by_end();
    for (std::size_t slot = 0; slot < touches; ++slot)
      for (std::size_t place = static_cast<std::size_t>(home_touched_) + 1; place < with.size(); ++place)
        if (with[place].count() > 1 && made_.configurations.size() + 2 <= options_.configurations)
          add_touch(place, slot, with);
  }

  std::vector<Bitset> poses_by_end() const {
    std::vector<Bitset> with(made_.configurations.size(), Bitset(poses()));
    for (const Anchored& anchored : anchored_)
      for (std::size_t pose = 0; pose < poses(); ++pose)
        if (const int to = anchored.results[pose].to; to != Instance::goal)
          with[static_cast<std::size_t>(to)].set(pose);
    return with;
  }

  void add_touch(std::size_t place, std::size_t slot, const std::vector<Bitset>& with) {
    const MotionPtr motion = most_telling(place, with[place]);
    if (!motion) return;
    used_.push_back(motion);
    Instance::Results results = results_of(*motion, touched(*motion), with[place], 1);
    for (std::size_t pose = 0; pose < poses(); ++pose) {
      const auto to = static_cast<std::size_t>(results[pose].to);
      if (!with[place].test(pose))
        results[pose] = {static_cast<int>(place), motion->cost_to.back()};
      else if (to < with.size() && !with[to].test(pose))
        return;  // it leads to where other moves were chosen without this pose in mind
    }
    auto& offered = made_.configurations[place].results;
    offered.resize(made_.motions.size());
    offered[anchored_.size() + slot] = std::move(results);
  }

  MotionPtr most_telling(std::size_t place, const Bitset& with) {
    MotionPtr best;
    double highest = 0.0;
    for (const MotionPtr& motion : library_.primitives_at(made_.configurations[place].q)) {
      if (std::find(used_.begin(), used_.end(), motion) != used_.end()) continue;
      const double rate = entropy(touched(*motion), with) / (motion->cost_to.back() + task_.options().cost.action);
      if (rate > highest) highest = rate, best = motion;
    }
    return best;
  }

  /// Anchored motions can be made from everywhere.
  void offer_anchored() {
    for (std::size_t place = 0; place < made_.configurations.size(); ++place) {
      Instance::Configuration& from = made_.configurations[place];
      from.results.resize(made_.motions.size());
      const Pose base_from_tool = task_.base_from_tool(from.q);
      for (std::size_t i = 0; i < anchored_.size(); ++i) {
        from.results[i] = anchored_[i].results;
        const double lead = action::transit_cost(task_, base_from_tool, anchored_[i].motion->base_from_start);
        for (Instance::Result& result : from.results[i]) result.cost += lead;
      }
    }
  }

  const action::Task& task_;
  const SampleOptions& options_;
  action::ActionLibrary library_;
  std::vector<Pose> poses_;
  std::vector<MotionPtr> insertions_;  // by pose
  std::vector<MotionPtr> probes_;
  std::vector<Anchored> anchored_;
  std::vector<MotionPtr> used_;
  int home_ = 0, home_touched_ = 0;
  Instance made_;
};

/// Whether some motion can be made for nothing.
bool costs_nothing(const Instance& instance) {
  for (const Instance::Configuration& configuration : instance.configurations)
    for (const Instance::Results& results : configuration.results)
      for (const Instance::Result& result : results)
        if (!(result.cost > 0.0)) return true;
  return false;
}

}  // namespace

Instance sampled_instance(const action::Task& task, const SampleOptions& options, support::Rng& rng) {
  check(options);
  Instance made = Maker(task, options).make(rng);
  if (costs_nothing(made))
    throw Error(
        Status::invalid_argument,
        "cost: found weights by which a motion costs nothing, expected cost.action above 0: nothing is lost then "
        "by going back and forth for ever");
  return made;
}

}  // namespace tactus::solver
