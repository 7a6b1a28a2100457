// SPDX-License-Identifier: BSD-3-Clause
#include "solver/pose_problem.hpp"

#include <algorithm>
#include <cmath>

#include "action/near_pokes.hpp"
#include "action/probes.hpp"

namespace tactus::solver {

using action::Motion;
using action::MotionPtr;
using geometry::Pose;
using geometry::Vector3;
using robot::JointVector;
using support::Bitset;

namespace {

constexpr int lines_per_side = 9;             // as long as nothing was met, and for solvers without an upper bound;
constexpr int lines_once_met = 5;             // for then most is told by what is near by
constexpr std::size_t going_on = 6;           // waypoints of a sweep after the last pose that it touches
constexpr std::size_t inner_candidates = 2;   // insertion attempts considered below the start
constexpr std::size_t most_anchored = 24;     // motions that a policy's cost is worked out after
constexpr std::size_t weighed_carefully = 8;  // choices
constexpr std::size_t least_walked = 12;      // poses for which a walk is weighed
constexpr std::size_t most_swept = 150;       // poses for which sweeps are
constexpr std::size_t each_when_late = 3;     // motions of a kind that are weighed at the start when time is up
constexpr double latest = 1.05;               // share of a budget in seconds when what is in hand is given up,
constexpr double latest_walk = 0.6;           // and when a walk is as far laid out as it is

/// Whether one of some straight moves from the same configuration ends where this one does.
bool is_among(const Motion& move, const std::vector<MotionPtr>& moves) {
  constexpr double same_end = 0.002;  // m
  const auto end = [](const Motion& motion) -> Vector3 {
    return motion.bodies.base_from_body(motion.path.size() - 1, 0).translation();
  };
  return std::any_of(moves.begin(), moves.end(),
                     [&](const MotionPtr& other) { return (end(*other) - end(move)).norm() < same_end; });
}

std::uint64_t salt_of(const JointVector& q) { return action::path_id({q}); }

}  // namespace

/// A configuration and a set of the problem's poses.
class PoseState : public BeliefState {
 public:
  PoseState(std::shared_ptr<PoseProblem> problem, JointVector q, Bitset members, bool at_start)
      : problem_(std::move(problem)), q_(std::move(q)), members_(std::move(members)), at_start_(at_start) {}

  support::Hash128 hash() const override { return members_.hash(salt_of(q_)); }
  const JointVector& configuration() const override { return q_; }
  std::size_t support_size() const override { return members_.count(); }

  Values heuristic() const override { return values(problem_->task_->base_from_tool(q_), indices(members_), false); }

  std::vector<Choice> choices(const support::Deadline& deadline) const override {
    if (at_start_) problem_->cost_per_bit_ = 1.0;
    std::vector<Choice> result;
    try {
      add_weighed(considered(), deadline, result);
      if (at_start_ && result.empty())
        add_weighed({problem_->library_->primitives_at(q_, problem_->cancellation())}, deadline, result);
      if (at_start_ && problem_->policy_) weigh_carefully(result, deadline);
    } catch (const support::OutOfTime&) {
      if (!at_start_) throw;
    }
    if (at_start_ && !problem_->policy_) problem_->price_bits(result);
    return result;
  }

  /// All the way as one motion, once something was met: the target may be in the way then.
  Choice realised(const Choice& choice, const action::Action& made, double more,
                  const support::Deadline& deadline) const override {
    if (!problem_->policy_ || problem_->nothing_met_ || made.lead == 0 || deadline.spent())
      return charged(choice, more);
    Motion whole;
    whole.kind = made.kind;
    whole.anchored = choice.motion->anchored;
    whole.path = made.path;
    whole.supposed_target = made.supposed_target;
    const auto finished = std::make_shared<Motion>(*action::finished(*problem_->task_, std::move(whole)));
    finished->base_from_start = choice.motion->base_from_start;
    limit_to(deadline);
    std::optional<Choice> weighed;
    try {
      weighed = weigh(finished);
    } catch (const support::OutOfTime&) {
    }
    problem_->predictions_->time_limit().lift();
    return weighed ? *weighed : charged(choice, more);
  }

  BeliefStatePtr successor(const Choice& choice, const Outcome& outcome) const override {
    Bitset left = problem_->predictions_->subset(choice.motion, members_, outcome.waypoint, outcome.last);
    const auto& path = choice.motion->path;
    const bool contact = outcome.waypoint < path.size();
    return std::make_shared<PoseState>(problem_, contact ? path[outcome.waypoint - 1] : path.back(), std::move(left),
                                       false);
  }

 private:
  using Kinds = std::vector<std::vector<MotionPtr>>;

  Kinds considered() const {
    Kinds kinds;
    std::vector<MotionPtr> primitives = problem_->library_->primitives_at(q_, problem_->cancellation());
    if (at_start_) std::erase_if(primitives, [&](const MotionPtr& motion) { return problem_->leads_nowhere(*motion); });
    if (at_start_ && problem_->walk_) {
      kinds.push_back(problem_->walk_->steps_from(q_));
      std::erase_if(primitives, [&](const MotionPtr& motion) { return is_among(*motion, kinds.back()); });
    }
    kinds.push_back(std::move(primitives));
    const bool has_met = !problem_->nothing_met_;
    if (at_start_ && has_met) kinds.push_back(problem_->near_pokes(q_));
    const std::size_t attempts = at_start_
                                     ? static_cast<std::size_t>(problem_->task_->options().actions.insertion_candidates)
                                     : inner_candidates;
    kinds.push_back(problem_->seats_.attempts(members_, q_, attempts, !at_start_ || has_met));
    kinds.push_back(anchored());
    return kinds;
  }

  /// Those that tell something or lead somewhere. The kinds take turns, so that there are some of each when time is up.
  /// With an upper bound, whose policy may take long, what is in hand when it is too late is given up, but for those
  /// few.
  void add_weighed(const Kinds& kinds, const support::Deadline& deadline, std::vector<Choice>& result) const {
    std::size_t turns = 0;
    for (const std::vector<MotionPtr>& kind : kinds) turns = std::max(turns, kind.size());
    for (std::size_t turn = 0; turn < turns; ++turn)
      for (const std::vector<MotionPtr>& kind : kinds) {
        if (turn >= kind.size() || !kind[turn]) continue;
        const bool is_wanted = at_start_ && turn < problem_->weighed_late();
        if ((is_wanted ? deadline.cancelled() : deadline.spent()) && !result.empty()) return;
        if (at_start_ && !is_wanted && !result.empty()) limit_to(deadline);
        Choice choice = weigh(kind[turn]);
        const bool informs = choice.outcomes.size() > 1 || choice.outcomes.front().goal;
        const bool moves = !kind[turn]->anchored && choice.outcomes.front().waypoint == kind[turn]->path.size();
        if (informs || moves) result.push_back(std::move(choice));
      }
  }

  void limit_to(const support::Deadline& deadline) const {
    problem_->predictions_->time_limit().set(deadline.at(latest));
  }

  static std::vector<std::size_t> indices(const Bitset& members) {
    std::vector<std::size_t> poses;
    members.for_each([&](std::size_t pose) { poses.push_back(pose); });
    return poses;
  }

  /// The upper bounds of the choices that have the least: they decide.
  void weigh_carefully(std::vector<Choice>& choices, const support::Deadline& deadline) const {
    if (!choices.empty()) limit_to(deadline);
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < choices.size(); ++i) order.emplace_back(choices[i].expected_total(), i);
    std::sort(order.begin(), order.end());
    order.resize(std::min(order.size(), weighed_carefully));
    for (const auto& [cost, i] : order)
      for (Outcome& outcome : choices[i].outcomes) {
        if (outcome.goal || deadline.spent()) continue;
        const MotionPtr& motion = choices[i].motion;
        const Bitset left = problem_->predictions_->subset(motion, members_, outcome.waypoint, outcome.last);
        const Pose& there = motion->bodies.base_from_body(outcome.waypoint - 1, 0);
        double& bound = outcome.heuristic[static_cast<int>(ValueType::inadmissible)];
        const bool is_met = outcome.waypoint < motion->path.size();
        bound = std::min(bound, problem_->simulated(indices(left), there, is_met, WalkPolicy::careful));
      }
  }

  /// All, or where each takes a policy's cost to weigh those that promise the most.
  std::vector<MotionPtr> anchored() const {
    if (!problem_->policy_) return problem_->anchored(q_);
    return problem_->policy_->promising(indices(members_), problem_->task_->base_from_tool(q_), most_anchored);
  }

  /// h_ad is the mean cost of going straight to the seats; h_inad adds what the missing bits are worth.
  Values values(const Pose& base_from_tool, const std::vector<std::size_t>& group, bool is_met) const {
    double direct = 0.0;
    for (const std::size_t pose : group) direct += problem_->seats_.direct_cost(base_from_tool, pose);
    direct /= static_cast<double>(group.size());
    if (problem_->policy_) return {direct, problem_->simulated(group, base_from_tool, is_met, WalkPolicy::quick)};
    const double share =
        static_cast<double>(group.size()) / static_cast<double>(problem_->predictions_->poses().size());
    const double bits = std::max(std::log2(static_cast<double>(group.size())), problem_->bits_ + std::log2(share));
    return {direct, direct + problem_->cost_per_bit_ * std::max(0.0, bits)};
  }

  Choice weigh(const MotionPtr& motion) const {
    const auto total = static_cast<double>(members_.count());
    const bool is_elsewhere = motion->anchored && motion->path.front() != q_;
    const double lead = is_elsewhere ? action::transit_cost(*problem_->task_, problem_->task_->base_from_tool(q_),
                                                            motion->base_from_start)
                                     : 0.0;
    Choice choice{motion, {}};
    const std::size_t least = problem_->predictions_->least_told_apart(motion, members_, problem_->dimensions());
    for (const auto& [waypoint, last, group, expected] : problem_->predictions_->split(motion, members_, least)) {
      Outcome outcome;
      outcome.waypoint = waypoint;
      outcome.last = last;
      outcome.probability = expected / total;
      outcome.possible = static_cast<double>(group.size()) / total;
      const std::size_t reached = std::min(waypoint, motion->path.size() - 1);
      outcome.cost = problem_->task_->options().cost.action + lead + motion->cost_to[reached];
      outcome.goal =
          waypoint == motion->path.size() && motion->kind == action::Kind::insertion &&
          std::all_of(group.begin(), group.end(), [&](std::size_t pose) { return problem_->seated(*motion, pose); });
      const bool is_met = waypoint < motion->path.size();
      if (!outcome.goal) outcome.heuristic = values(motion->bodies.base_from_body(waypoint - 1, 0), group, is_met);
      choice.outcomes.push_back(outcome);
    }
    return choice;
  }

  std::shared_ptr<PoseProblem> problem_;
  JointVector q_;
  Bitset members_;
  bool at_start_;
};

PoseProblem::PoseProblem(std::shared_ptr<const action::Task> task, std::shared_ptr<action::ActionLibrary> library,
                         std::shared_ptr<Predictions> predictions, double bits, double cost_per_bit, SecondValue second,
                         bool nothing_met)
    : task_(std::move(task)),
      library_(std::move(library)),
      predictions_(std::move(predictions)),
      region_(bounds()),
      seats_(task_, predictions_->poses(), action::retreat_plane(*task_, region_), cancellation()),
      bits_(bits),
      least_cost_per_bit_(cost_per_bit),
      cost_per_bit_(cost_per_bit),
      second_(second),
      nothing_met_(nothing_met) {}

void PoseProblem::prepare(const action::Task& task, action::ActionLibrary& library) {
  library.probes_in(task.frame().region, task.scene().start, lines_per_side);
}

double PoseProblem::rehearse(const std::shared_ptr<const action::Task>& task,
                             const std::shared_ptr<action::ActionLibrary>& library, std::size_t poses) {
  const auto weighed_in = [&](std::uint64_t seed) {
    const support::Deadline clock = support::Deadline::unlimited();
    support::Rng rng(seed);
    std::vector<Pose> drawn;
    while (drawn.size() < poses) drawn.push_back(task->scene().prior.sample(rng));
    std::make_shared<PoseProblem>(task, library, std::make_shared<Predictions>(task, std::move(drawn)), 0.0, 0.0,
                                  SecondValue::upper_bound, true)
        ->start(task->scene().start)
        ->choices(clock);
    return clock.elapsed_seconds();
  };
  weighed_in(0);
  return weighed_in(1);
}

BeliefStatePtr PoseProblem::start(const JointVector& q, const support::Deadline& deadline) {
  if (second_ == SecondValue::upper_bound) {
    policy_ = rate_policy(q);
    if (nothing_met_) {
      predictions_->time_limit().set(deadline.at(latest_walk));
      walk_ = std::make_unique<WalkPolicy>(task_, library_->lattice_through(q), *predictions_, *policy_,
                                           task_->base_from_tool(q), dimensions());
      predictions_->time_limit().lift();
    }
  }
  return std::make_shared<PoseState>(shared_from_this(), q, Bitset(predictions_->poses().size(), true), true);
}

/// By the motions at the start, which were weighed as if a bit were worth one unit of cost.
void PoseProblem::price_bits(std::vector<Choice>& choices) {
  std::vector<double> cost, gained;
  for (const Choice& choice : choices) {
    cost.push_back(choice.expected_cost());
    gained.push_back(choice.information());
  }
  cost_per_bit_ = greedy_cost_per_bit(cost, gained, least_cost_per_bit_);
  solver::price_bits(choices, cost_per_bit_);
}

/// The cost of the cheaper policy, where both may be; where many poses are left, sweeps one by one are not weighed.
/// What follows the first contact is left to the rate policy, as walks leave it.
double PoseProblem::simulated(const std::vector<std::size_t>& group, const Pose& base_from_tool, bool is_met,
                              std::size_t beam) {
  if (!walk_ || is_met) return policy_->cost(group, base_from_tool);
  if (group.size() > most_swept) return walk_->cost(group, base_from_tool, beam);
  const double cost = policy_->cost(group, base_from_tool);
  return group.size() < least_walked ? cost : std::min(cost, walk_->cost(group, base_from_tool, beam));
}

/// How many motions of each kind are weighed where planning starts, time or not: with an upper bound, which says what
/// any of them is worth, some of each; without, all, as the best of some may be far from any good.
std::size_t PoseProblem::weighed_late() const { return policy_ ? each_when_late : SIZE_MAX; }

int PoseProblem::dimensions() const {
  const geometry::PoseVector& width = task_->scene().prior.width;
  return static_cast<int>(std::count_if(width.begin(), width.end(), [](double w) { return w > 0.0; }));
}

bool PoseProblem::seated(const Motion& motion, std::size_t pose) const {
  return task_->scene().is_seated(motion.bodies.base_from_body(motion.path.size() - 1, 0), predictions_->poses()[pose]);
}

/// A turn, or a move shorter than a walk's steps, while the target is looked for by walks.
bool PoseProblem::leads_nowhere(const Motion& motion) const {
  constexpr double nearly = 0.9;
  if (!walk_ || motion.anchored) return false;
  if (motion.kind == action::Kind::turn) return true;
  const std::size_t last = motion.path.size() - 1;
  return (motion.bodies.base_from_body(last, 0).translation() - motion.bodies.base_from_body(0, 0).translation())
             .norm() < nearly * walk_->pitch();
}

const std::vector<MotionPtr>& PoseProblem::anchored(const JointVector& near) {
  if (anchored_) return *anchored_;
  const bool are_few = second_ == SecondValue::upper_bound && !nothing_met_;
  std::vector<MotionPtr> probes =
      library_->probes_in(region_, near, are_few ? lines_once_met : lines_per_side, cancellation());
  for (MotionPtr& motion : probes)
    if (motion->kind == action::Kind::sweep) motion = ending_with_contacts(motion);
  return anchored_.emplace(std::move(probes));
}

/// Without what it goes on after the last pose that it touches, but for a little.
MotionPtr PoseProblem::ending_with_contacts(const MotionPtr& motion) {
  std::size_t last = 0;
  for (const std::int32_t first_contact : predictions_->first_contacts(motion))
    if (const auto at = static_cast<std::size_t>(first_contact); at < motion->path.size()) last = std::max(last, at);
  const std::size_t waypoints = last + 1 + going_on;
  if (last == 0 || waypoints >= motion->path.size()) return motion;
  const MotionPtr part = action::truncated(*task_, *motion, waypoints);
  predictions_->begins_as(part, motion);
  return part;
}

/// From where the robot stands at the start, `q`.
const std::vector<MotionPtr>& PoseProblem::near_pokes(const JointVector& q) {
  if (!near_pokes_) near_pokes_ = action::near_pokes(*task_, q, cancellation());
  return *near_pokes_;
}

/// Over the anchored motions, with the attempts at each pose's first seat.
std::unique_ptr<RatePolicy> PoseProblem::rate_policy(const JointVector& q) {
  return std::make_unique<RatePolicy>(task_, *predictions_, anchored(q), seats_.first_attempts(),
                                      seats_.served_at_first(), dimensions());
}

/// The box in the search frame of the target at every pose.
geometry::Box PoseProblem::bounds() const {
  geometry::Box box;
  const Pose search_from_base = task_->frame().base_from_search.inverse();
  const geometry::Box local = geometry::bounds(task_->scene().target.mesh);
  for (const Pose& pose : predictions_->poses())
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3 p(corner & 1 ? local.high.x() : local.low.x(), corner & 2 ? local.high.y() : local.low.y(),
                      corner & 4 ? local.high.z() : local.low.z());
      box.add(search_from_base * (pose * p));
    }
  return box;
}

}  // namespace tactus::solver
