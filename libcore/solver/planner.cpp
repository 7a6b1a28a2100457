// SPDX-License-Identifier: BSD-3-Clause
#include "solver/planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "solver/candidates.hpp"
#include "solver/pose_problem.hpp"
#include "solver/voxel_problem.hpp"

namespace tactus::solver {
namespace {

constexpr std::uint64_t own_stream = 0x706c616e;  // apart from whatever else begins with the same seed
constexpr double back_off = 0.01;                 // of the way it came, in units of cost, from what it touched
constexpr double farther = 3.0;                   // times as far, each time that this was not enough
constexpr double telling = 0.6;           // of the bits per cost that the best motion tells, once something was met
constexpr double least_charge = 0.02;     // m by which a planned way to a motion is longer than was thought
constexpr double in_the_way = 0.1;        // probability of meeting the target on the way, above which others are tried
constexpr double search_sample = 4.0;     // times as many poses as long as nothing was met: they are cheap then;
constexpr double least_sample = 0.5;      // and so many at least;
constexpr double least_after = 0.25;      // and once something was met
constexpr double aim = 0.7;               // of a budget in seconds, to weigh the motions where planning starts
constexpr double in_time = 0.95;          // of a budget in seconds: what is in hand then still has to be finished
constexpr double with_way = 0.88;         // the same where the ways to motions are weighed after it,
constexpr double to_weigh_ways = 0.94;    // and the same for those
constexpr std::size_t least_support = 8;  // poses below which a computed policy is not trusted; so many are drawn

/// What a motion was thought to cost all the way, with the way to its start, however far its outcomes go.
double full_cost(const Choice& choice) {
  const Outcome& any = choice.outcomes.front();
  const std::vector<double>& cost_to = choice.motion->cost_to;
  return any.cost + cost_to.back() - cost_to[std::min(any.waypoint, cost_to.size() - 1)];
}

/// Probability of meeting something before the motion proper, of a choice that was weighed with the way to it.
double met_on_the_way(const Choice& choice, const action::Action& made) {
  double sum = 0.0;
  for (const Outcome& outcome : choice.outcomes)
    if (outcome.waypoint <= made.lead) sum += outcome.probability;
  return sum;
}

}  // namespace

/// The partial policy of the last planning call, and the action that was handed out from it.
struct Planner::Policy {
  Search search;
  int node = Search::start;  ///< the belief the handed-out action was for
  std::size_t choice = 0;
  std::size_t lead = 0;  ///< waypoints of the action before the motion proper
  std::uint64_t action_id = 0;
  std::uint64_t history = 0;        ///< fingerprint of what the belief had been through
  std::vector<Verdict> verdicts{};  ///< by choice; empty if the last query handed out no action
};

Planner::Planner(std::shared_ptr<const belief::Model> model, const PlannerOptions& options)
    : model_(std::move(model)),
      options_(options),
      library_(std::make_shared<action::ActionLibrary>(*model_->task)),
      rng_(support::mix(options.seed ^ own_stream)),
      sample_(std::isinf(options.budget_seconds) ? search_sample : 1.0) {
  check(options_);
  if (!is_bounded()) return;
  PoseProblem::prepare(*model_->task, *library_);
  if (std::isinf(options_.budget_seconds)) return;
  const auto few = static_cast<std::size_t>(std::ceil(least_sample * static_cast<double>(model_->options.particles)));
  const double used = PoseProblem::rehearse(model_->task, library_, few) / options_.budget_seconds;
  sample_ = std::clamp(least_sample * aim / used, least_sample, search_sample);
  PoseProblem::prepare(*model_->task, *library_);
}

Planner::~Planner() = default;

Answer Planner::query(const belief::Belief& belief) {
  cancelled_.store(false, std::memory_order_relaxed);
  const bool weighs_ways = is_bounded() && has_met_something(belief.history());
  support::Deadline deadline((weighs_ways ? with_way : in_time) * options_.budget_seconds,
                             options_.budget_expansions == 0 ? UINT64_MAX : options_.budget_expansions, &cancelled_);
  const support::Deadline ways(to_weigh_ways * options_.budget_seconds, UINT64_MAX, &cancelled_);
  alternatives_.clear();
  if (policy_) policy_->verdicts.clear();
  statistics_.from_policy = false;
  statistics_.expansions = 0;
  statistics_.seconds = 0.0;
  if (belief.is_goal()) {
    policy_.reset();
    return {Answer::Kind::goal_reached, nullptr};
  }
  if (!progress_.note(belief, handed_out())) poses_.clear();
  if (const auto node = followed(belief)) {
    statistics_.from_policy = true;
    Answer answer = unless_cancelled([&] { return act(belief, *node, ways); });
    if (answer.action || answer.kind == Answer::Kind::cancelled) return answer;
    statistics_.from_policy = false;
  }
  Answer answer = unless_cancelled([&] {
    plan(belief, deadline);
    return act(belief, Search::start, ways);
  });
  statistics_.expansions = deadline.expansions();
  statistics_.seconds = deadline.elapsed_seconds();
  ++statistics_.total_calls;
  statistics_.total_expansions += statistics_.expansions;
  statistics_.total_seconds += statistics_.seconds;
  return answer;
}

/// The policy of a call that was cancelled is not kept.
template <typename Work>
Answer Planner::unless_cancelled(Work&& work) {
  try {
    return work();
  } catch (const support::Cancelled&) {
    policy_.reset();
    return {Answer::Kind::cancelled, nullptr};
  }
}

const std::vector<Alternative>& Planner::alternatives() const {
  if (alternatives_.empty() && policy_ && !policy_->verdicts.empty())
    alternatives_ = solver::alternatives(policy_->search, policy_->node, greedy_of(options_.solver), policy_->verdicts);
  return alternatives_;
}

std::optional<HandedOut> Planner::handed_out() const {
  if (!policy_ || policy_->action_id == 0) return std::nullopt;
  return HandedOut{policy_->action_id, policy_->lead, policy_->search.choices(policy_->node)[policy_->choice]};
}

/// The node the belief has come to, if it is the predicted outcome of the action handed out and an action was computed
/// for it.
std::optional<int> Planner::followed(const belief::Belief& belief) {
  if (!policy_ || is_bounded() || progress_.is_stuck() || greedy_of(options_.solver) || belief.history().empty() ||
      belief::fingerprint(belief.history(), belief.history().size() - 1) != policy_->history)
    return std::nullopt;
  const belief::Trace& last = belief.history().back();
  if (last.action_id != policy_->action_id || last.outcome <= policy_->lead) return std::nullopt;
  const std::size_t waypoint = last.outcome - policy_->lead;
  const std::vector<Outcome>& outcomes = policy_->search.choices(policy_->node)[policy_->choice].outcomes;
  for (std::size_t z = 0; z < outcomes.size(); ++z) {
    if (outcomes[z].waypoint != waypoint) continue;
    const int child = policy_->search.child(policy_->node, policy_->choice, z);
    if (child < 0 || !policy_->search.expanded(child)) return std::nullopt;
    const BeliefState& state = policy_->search.state(child);
    if (state.support_size() < least_support || state.configuration() != belief.configuration()) return std::nullopt;
    return child;
  }
  return std::nullopt;
}

/// Of the poses drawn for planning, with what is known of them from the last call.
void Planner::predict(const belief::Belief& belief) {
  std::vector<double> misses;
  for (const belief::Drawn& drawn : poses_) misses.push_back(drawn.miss);
  const double blur = belief::stop_blur(*model_->task, belief.sensing());
  auto predictions = std::make_shared<Predictions>(model_->task, belief::poses_of(poses_), blur, std::move(misses),
                                                   model_->options.cells.threads, &cancelled_);
  if (predictions_) predictions->take_over(*predictions_);
  predictions_ = std::move(predictions);
}

/// Poses to plan on, by all that was seen so far: with bounds as many as fit, and many as long as nothing was met.
std::vector<belief::Drawn> Planner::draw(const belief::Belief& belief, const support::Deadline& deadline) {
  const double times = !is_bounded() ? 1.0 : has_met_something(belief.history()) ? sample_after_ : sample_;
  const auto most =
      std::max(least_support, static_cast<std::size_t>(times * static_cast<double>(model_->options.particles)));
  if (belief.phase() == belief::Phase::poses) return belief.draw(most, rng_, poses_, deadline);
  return belief.draw_feasible(most, rng_, poses_, deadline);
}

BeliefStatePtr Planner::on_voxels(const belief::Belief& belief, const support::Deadline& deadline) {
  poses_ = model_->options.likelihood == belief::Likelihood::calibrated
               ? belief.draw_feasible(model_->options.particles, rng_, poses_, deadline)
               : std::vector<belief::Drawn>{};
  return std::make_shared<VoxelProblem>(model_, library_, belief::poses_of(poses_), options_.cost_per_bit, &cancelled_)
      ->start(belief.configuration(), belief.voxels());
}

BeliefStatePtr Planner::on_poses(const belief::Belief& belief, const support::Deadline& deadline) {
  predict(belief);
  const double bits = is_bounded() ? 0.0 : belief.bits();  // only greedy heuristics ask
  return std::make_shared<PoseProblem>(model_->task, library_, predictions_, bits, options_.cost_per_bit,
                                       second_value_of(options_.solver), !has_met_something(belief.history()))
      ->start(belief.configuration(), deadline);
}

/// Bounds are of poses: their solver plans on poses from the first, whatever the phase.
void Planner::plan(const belief::Belief& belief, support::Deadline& deadline) {
  const bool in_phase = belief.phase() == belief::Phase::poses;
  if (progress_.enters_a_stage()) poses_.clear();
  policy_.reset();
  if (in_phase || is_bounded()) poses_ = draw(belief, deadline);
  const bool has_poses = in_phase || (is_bounded() && !poses_.empty());
  SearchOptions search = search_options(options_);
  search.bounded = search.bounded && has_poses;
  policy_ = std::make_unique<Policy>(
      Policy{Search(has_poses ? on_poses(belief, deadline) : on_voxels(belief, deadline), search)});
  const bool searches = search.bounded && !has_met_something(belief.history());
  const bool is_greedy = greedy_of(options_.solver).has_value();
  if (is_greedy || search.bounded) policy_->search.expand_start(deadline);
  const double used = deadline.elapsed_seconds() / options_.budget_seconds;
  if (search.bounded && searches) fit_sample(sample_, least_sample, search_sample, used);
  if (search.bounded && !searches) fit_sample(sample_after_, least_after, 1.0, used);
  if (!is_greedy && !searches) policy_->search.run(deadline);
  if (has_poses) predictions_->time_limit().lift();
}

/// As many poses as there is time to weigh all motions at the start for, by the share of the budget that the last ones
/// `used`.
void Planner::fit_sample(double& times, double least, double most, double used) const {
  constexpr double at_least = 0.4, at_most = 1.6;
  if (std::isinf(options_.budget_seconds)) return;
  times = std::clamp(times * std::clamp(aim / used, at_least, at_most), least, most);
}

/// Notes what there is to follow.
Answer Planner::hand_out(const belief::Belief& belief, int node, std::size_t choice, action::Action made) {
  const Search& search = policy_->search;
  made.expected_cost = search.q_value(node, choice, ValueType::inadmissible);
  made.contact_probability = search.choices(node)[choice].contact_probability();
  made.sensing = belief.sensing();
  statistics_.lower_bound = search.value(node, ValueType::admissible);
  statistics_.value = search.value(node, ValueType::inadmissible);
  policy_->node = node;
  policy_->choice = choice;
  policy_->lead = made.lead;
  policy_->action_id = made.id;
  policy_->history = belief::fingerprint(belief.history(), belief.history().size());
  return {Answer::Kind::action, std::make_shared<const action::Action>(std::move(made))};
}

/// A little of the way it came, from what it touched: any other may lead along it. More of it each time that this was
/// not enough to get out, `halts`.
motion::JointPath Planner::way_off(const belief::Belief& belief, const motion::JointPath& way_back, int halts) const {
  const std::vector<belief::Trace>& history = belief.history();
  if (!has_met_something(history) || (!history.back().contact && halts == 0)) return {};
  const action::Task& task = *model_->task;
  const double enough = back_off * std::pow(farther, halts);
  double cost = 0.0;
  std::size_t waypoints = 1;
  for (; waypoints < way_back.size() && cost < enough; ++waypoints)
    cost += task.cost(motion::tool_travel(*task.scene().robot, task.scene().tool_link,
                                          {way_back[waypoints - 1], way_back[waypoints]}));
  return {way_back.begin(), way_back.begin() + static_cast<std::ptrdiff_t>(waypoints)};
}

/// The way to a choice's motion and the motion, weighed as that turned out. Where the target is likely to be in the
/// way, by the one of several ways on which the least is spent: farther and farther back the way the robot came.
std::optional<Planner::Realised> Planner::realised(const belief::Belief& belief, const BeliefState& state,
                                                   const Choice& choice, const motion::JointPath& way_back,
                                                   const support::Deadline& deadline) const {
  const support::Deadline unlimited(std::numeric_limits<double>::infinity(), UINT64_MAX, &cancelled_);
  std::optional<Realised> best;
  for (int halts = progress_.halts(); !best || !deadline.spent(); ++halts) {
    const motion::JointPath way = way_off(belief, way_back, halts);
    auto made = library_->realise(belief.configuration(), *choice.motion, unlimited, way);
    if (!made) break;
    const double more = made->full_cost - full_cost(choice);
    Choice weighed = state.realised(choice, *made, more, deadline);
    const bool is_weighed = weighed.motion != choice.motion;
    if (best && !is_weighed) break;
    const bool is_free = !is_weighed || met_on_the_way(weighed, *made) <= in_the_way;
    if (!best || weighed.expected_total() < best->choice.expected_total())
      best = Realised{std::move(*made), std::move(weighed), more};
    if (is_free || way.size() >= way_back.size()) break;
  }
  return best;
}

/// The best motion at a node, made executable; the next best where the robot can't get to its start, or did so without
/// avail.
Answer Planner::act(const belief::Belief& belief, int node, const support::Deadline& deadline) {
  Search& search = policy_->search;
  const bool must_tell = is_bounded() && has_met_something(belief.history());
  const motion::JointPath way_back = belief.way_back();
  Candidates candidates(search, node, greedy_of(options_.solver), must_tell ? telling : 0.0,
                        progress_.held_back(belief, search.choices(node)));
  std::unordered_map<std::size_t, action::Action> made;  ///< by choice, once weighed as it turned out
  while (const auto choice = candidates.next()) {
    if (deadline.cancelled()) return {Answer::Kind::cancelled, nullptr};
    if (made.count(*choice) == 0) {
      const Choice& thought = search.choices(node)[*choice];
      auto found = realised(belief, search.state(node), thought, way_back, deadline);
      if (!found && deadline.cancelled()) return {Answer::Kind::cancelled, nullptr};
      if (!found || progress_.is_fruitless(found->action.id)) {
        candidates.rule_out(*choice, found ? Verdict::set_aside : Verdict::unreachable);
        continue;
      }
      made.emplace(*choice, std::move(found->action));
      if (found->more > least_charge || found->choice.motion != thought.motion) {
        search.reweigh(node, *choice, std::move(found->choice));
        continue;
      }
    }
    policy_->verdicts = candidates.verdicts(*choice);
    return hand_out(belief, node, *choice, std::move(made.at(*choice)));
  }
  policy_.reset();
  return {Answer::Kind::no_informative_action, nullptr};
}

}  // namespace tactus::solver
