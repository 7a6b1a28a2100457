// SPDX-License-Identifier: BSD-3-Clause
#include "solver/pose_problem.hpp"

#include <algorithm>
#include <cmath>

#include "action/insertion.hpp"
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
constexpr std::size_t both_ways = 2;          // attempts that are considered from where the tool is and by the plane
constexpr std::size_t most_anchored = 24;     // motions that a policy's cost is worked out after
constexpr std::size_t weighed_carefully = 8;  // choices
constexpr std::size_t least_walked = 12;      // poses for which a walk is weighed
constexpr std::size_t most_swept = 150;       // poses for which sweeps are
constexpr std::size_t each_when_late = 3;     // motions of a kind that are weighed at the start when time is up
constexpr double latest = 1.05;               // share of a budget in seconds when what is in hand is given up,
constexpr double latest_walk = 0.6;           // and when a walk is as far laid out as it is
constexpr double same_seat = 0.0015;          // m between seated poses that one attempt may serve
constexpr double lever = 0.02;                // m by which a turn counts as a shift there

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
    kinds.push_back(problem_->insertions(members_, q_, attempts, !at_start_ || has_met));
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
    for (const std::size_t pose : group) direct += problem_->direct_cost(base_from_tool, pose);
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
      plane_(action::retreat_plane(*task_, region_)),
      bits_(bits),
      least_cost_per_bit_(cost_per_bit),
      cost_per_bit_(cost_per_bit),
      second_(second),
      nothing_met_(nothing_met) {
  for (const Pose& pose : predictions_->poses())
    for (std::size_t seat = 0; seat < seats(); ++seat) seated_.push_back(task_->scene().seated(pose, seat));
  for (std::size_t seat = 0; seat < seated_.size(); ++seat) attempts_.push_back(attempt_at(seat));
  find_neighbours();
}

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
  if (!anchored_made_) {
    const bool are_few = second_ == SecondValue::upper_bound && !nothing_met_;
    anchored_ = library_->probes_in(region_, near, are_few ? lines_once_met : lines_per_side, cancellation());
    for (MotionPtr& motion : anchored_)
      if (motion->kind == action::Kind::sweep) motion = ending_with_contacts(motion);
  }
  anchored_made_ = true;
  return anchored_;
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

MotionPtr PoseProblem::insertion_at(std::size_t seat, const JointVector& near) {
  if (const auto found = insertions_.find(seat); found != insertions_.end()) return found->second;
  const Pose& supposed = predictions_->poses()[seat / seats()];
  return insertions_[seat] = action::insertion(*task_, supposed, near, seat % seats(), plane_, cancellation());
}

MotionPtr PoseProblem::near_insertion_at(std::size_t seat, const JointVector& q) {
  const auto at = std::pair(salt_of(q), seat);
  if (const auto found = near_insertions_.find(at); found != near_insertions_.end()) return found->second;
  const Pose& supposed = predictions_->poses()[seat / seats()];
  return near_insertions_[at] = action::near_insertion(*task_, supposed, q, seat % seats(), cancellation());
}

/// From where the robot stands at the start, `q`.
const std::vector<MotionPtr>& PoseProblem::near_pokes(const JointVector& q) {
  if (!near_pokes_) near_pokes_ = action::near_pokes(*task_, q, cancellation());
  return *near_pokes_;
}

void PoseProblem::find_neighbours() {
  neighbours_.assign(seated_.size(), Bitset(seated_.size()));
  for (std::size_t a = 0; a < seated_.size(); ++a) {
    cancellation().check();
    for (std::size_t b = 0; b <= a; ++b) {
      const double shift = (seated_[a].translation() - seated_[b].translation()).norm();
      if (shift >= same_seat || shift + lever * geometry::angle_between(seated_[a], seated_[b]) >= same_seat) continue;
      neighbours_[a].set(b);
      neighbours_[b].set(a);
    }
  }
}

/// Attempts at the seats that have the most others near by, each for a different group of poses; if `nears`, from where
/// the tool is, and by the retreat plane at the first few, or where it can't get there else. Where several seats of a
/// pose are as good the nearest counts, and the others if the arm can't get there.
std::vector<MotionPtr> PoseProblem::insertions(const Bitset& members, const JointVector& q, std::size_t most,
                                               bool nears) {
  const std::vector<std::size_t> order = seats_of(members, q);
  Bitset left(seated_.size());
  for (const std::size_t seat : order) left.set(seat);
  std::vector<MotionPtr> found;
  std::size_t groups = 0;
  for (std::size_t tries = 0; tries < most * seats() && groups < most && !left.none(); ++tries) {
    cancellation().check();
    std::size_t best = 0, densest = 0;
    for (const std::size_t seat : order) {
      if (!left.test(seat)) continue;
      Bitset group = neighbours_[seat];
      const std::size_t size = (group &= left).count();
      if (size > densest) densest = size, best = seat;
    }
    Bitset served = neighbours_[best];
    served &= left;
    left.and_not(served);
    const MotionPtr near = nears ? near_insertion_at(best, q) : nullptr;
    const MotionPtr motion = !near || groups < both_ways ? insertion_at(best, q) : nullptr;
    if (!motion && !near) continue;
    ++groups;
    for (const MotionPtr& attempt : {near, motion})
      if (attempt) found.push_back(attempt);
    served.for_each([&](std::size_t seat) { left.reset_in(seat - seat % seats(), seat - seat % seats() + seats()); });
    if (densest <= 1) break;
  }
  return found;
}

/// The seats of some poses, those of each the nearest to the tool first.
std::vector<std::size_t> PoseProblem::seats_of(const Bitset& members, const JointVector& q) const {
  const Pose base_from_tool = task_->base_from_tool(q);
  std::vector<std::size_t> order;
  members.for_each([&](std::size_t pose) {
    const auto first = static_cast<std::ptrdiff_t>(order.size());
    for (std::size_t seat = 0; seat < seats(); ++seat) order.push_back(pose * seats() + seat);
    std::stable_sort(order.begin() + first, order.end(), [&](std::size_t a, std::size_t b) {
      return seat_cost(base_from_tool, a) < seat_cost(base_from_tool, b);
    });
  });
  return order;
}

/// From the retreat plane along the approach axis, as `action::insertion` has it.
Attempt PoseProblem::attempt_at(std::size_t seat) const {
  const scene::Scene& scene = task_->scene();
  const Vector3 axis = predictions_->poses()[seat / seats()].linear() * scene.target.approach_axis;
  const Pose search_from_base = task_->frame().base_from_search.inverse();
  const double past_plane = (search_from_base * seated_[seat].translation()).z() - plane_;
  const double to_plane = std::max(scene.target.approach_depth, past_plane / (search_from_base.linear() * axis).z());
  Attempt attempt{seated_[seat], seated_[seat], task_->options().cost.metre * to_plane};
  attempt.base_from_start.translation() -= to_plane * axis;
  return attempt;
}

/// Over the anchored motions, with the attempts at each pose's first seat.
std::unique_ptr<RatePolicy> PoseProblem::rate_policy(const JointVector& q) {
  std::vector<Attempt> attempts;
  std::vector<Bitset> served;
  for (std::size_t pose = 0; pose < predictions_->poses().size(); ++pose) {
    attempts.push_back(attempts_[pose * seats()]);
    served.emplace_back(predictions_->poses().size());
    neighbours_[pose * seats()].for_each([&](std::size_t seat) {
      if (seat % seats() == 0) served.back().set(seat / seats());
    });
  }
  return std::make_unique<RatePolicy>(task_, *predictions_, anchored(q), std::move(attempts), std::move(served),
                                      dimensions());
}

/// Of getting the tool to a seat, the straight way.
double PoseProblem::seat_cost(const Pose& base_from_tool, std::size_t seat) const {
  const action::CostWeights& weights = task_->options().cost;
  const scene::Target& target = task_->scene().target;
  const double metres = (seated_[seat].translation() - base_from_tool.translation()).norm();
  const double radians = geometry::angle_between(base_from_tool, seated_[seat]);
  const double tilted = target.angle_tolerance * target.target_from_seated[seat % seats()].translation().norm();
  const double tolerance = target.position_tolerance + tilted;
  return weights.metre * std::max(0.0, metres - tolerance) +
         weights.radian * std::max(0.0, radians - target.angle_tolerance) + weights.action;
}

/// The same to the best of a pose's seats.
double PoseProblem::direct_cost(const Pose& base_from_tool, std::size_t pose) const {
  double least = seat_cost(base_from_tool, pose * seats());
  for (std::size_t seat = 1; seat < seats(); ++seat)
    least = std::min(least, seat_cost(base_from_tool, pose * seats() + seat));
  return least;
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
