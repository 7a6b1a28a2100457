// SPDX-License-Identifier: BSD-3-Clause
#include "solver/progress.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::solver {
namespace {

constexpr double noticeable_bits = 0.1;  // by which an observation makes the belief smaller, if it tells anything;
constexpr double swept_bits = 0.005;     // and as long as nothing was met
constexpr int patience = 3;              // queries in a stage in which the belief hardly shrank
constexpr int most_idle = 6;             // queries in a row whose actions were not to tell anything
constexpr int stages = 3;
constexpr double certain = 0.9;  // probability of meeting only what was met without avail

}  // namespace

bool Progress::note(const belief::Belief& belief, const std::optional<HandedOut>& last) {
  const std::vector<belief::Trace>& history = belief.history();
  const bool goes_on = history.size() >= observations_ && belief::fingerprint(history, observations_) == history_;
  if (!goes_on) *this = {};
  const bool is_first = q_.size() == 0;
  const bool asked_again = !is_first && history.size() == observations_;
  if (asked_again) return goes_on;

  const std::size_t size =
      belief.phase() == belief::Phase::voxels ? belief.voxels().possibly_occupied().count() : belief.cells().size();
  if (is_first || size != size_ || belief.configuration() != q_)
    fruitless_.clear();
  else if (!history.empty())
    fruitless_.push_back(history.back().action_id);
  const double bits =
      std::log2(belief.phase() == belief::Phase::voxels ? static_cast<double>(size) : belief.cells().weight());
  const double noticeable = belief::has_met_something(history) ? noticeable_bits : swept_bits;
  const bool is_of_last = last && !history.empty() && history.back().action_id == last->action_id;
  const bool was_to_tell = !is_of_last || last->lead > 0 || last->choice.information() > noticeable;
  const bool shrank = is_first || bits < bits_ - noticeable;
  idle_ = shrank || was_to_tell ? 0 : idle_ + 1;
  stalls_ = shrank ? 0 : stalls_ + (was_to_tell || idle_ > most_idle);
  if (is_of_last) note_end(belief, *last);
  if (shrank) bits_ = bits;
  q_ = belief.configuration();
  size_ = size;
  observations_ = history.size();
  history_ = belief::fingerprint(history, history.size());
  return goes_on;
}

/// Of the action handed out last: what it met, what it went into, and whether it got out.
void Progress::note_end(const belief::Belief& belief, const HandedOut& last) {
  const belief::Trace& trace = belief.history().back();
  const action::Motion& motion = *last.choice.motion;
  if (trace.contact && last.lead == 0) {
    const std::size_t waypoints = std::min(trace.outcome + 1, motion.path.size());
    met_.emplace_back(motion.path.begin(), motion.path.begin() + static_cast<std::ptrdiff_t>(waypoints));
  }
  if (trace.outcome <= last.lead)
    ++halts_;
  else if (last.lead > 0)  // a small motion says nothing of the way out, free or not
    halts_ = 0;
  if (motion.kind == action::Kind::insertion && !trace.contact)
    gone_in_.push_back(belief.task().base_from_tool(belief.configuration()));
}

std::vector<std::size_t> Progress::held_back(const belief::Belief& belief, const std::vector<Choice>& choices) const {
  const std::vector<Touch> touches = touched_in_vain(belief.history());
  const scene::Target& target = belief.task().scene().target;
  const bool does_not_err = !belief.sensing().errs();
  const bool feels = belief::has_met_something(belief.history());
  std::vector<std::size_t> held;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const action::Motion& motion = *choices[i].motion;
    if (is_unpromising(motion) || (feels && is_idle(choices[i])) ||
        (does_not_err && (is_known(motion) || is_made_already(motion, target))) ||
        share_alike(choices[i], touches) > certain)
      held.push_back(i);
  }
  return held;
}

bool Progress::is_fruitless(std::uint64_t action_id) const {
  return std::find(fruitless_.begin(), fruitless_.end(), action_id) != fruitless_.end();
}

bool Progress::is_stuck() const { return stalls_ >= patience; }

bool Progress::enters_a_stage() const { return stalls_ > 0 && stalls_ % patience == 0; }

/// While the belief does not shrink: at first nothing is set aside; then small motions about where the robot is, and
/// attempts; then small motions alone; and then all are tried again.
Progress::Stage Progress::stage() const { return static_cast<Stage>(stalls_ / patience % stages); }

/// Whether it goes the way of one that met something, as far as that: a robot that does not err would meet it again.
bool Progress::is_known(const action::Motion& motion) const {
  return std::any_of(met_.begin(), met_.end(), [&](const motion::JointPath& met) {
    return met.size() <= motion.path.size() && std::equal(met.begin(), met.end(), motion.path.begin());
  });
}

/// Whether it is a second small motion in a row that is not to tell anything: what a search finds behind one it found
/// because it looked there, and would find from here too.
bool Progress::is_idle(const Choice& choice) const {
  return idle_ > 0 && !choice.motion->anchored && choice.information() <= noticeable_bits &&
         choice.goal_probability() <= 0.0;
}

/// Whether it is an attempt all but where one met nothing and did not reach the goal: that would come of it again.
bool Progress::is_made_already(const action::Motion& motion, const scene::Target& target) const {
  constexpr double nearly = 0.5;  // of the tolerances
  if (motion.kind != action::Kind::insertion || gone_in_.empty()) return false;
  const geometry::Pose& end = motion.bodies.base_from_body(motion.path.size() - 1, 0);
  return std::any_of(gone_in_.begin(), gone_in_.end(), [&](const geometry::Pose& earlier) {
    return (end.translation() - earlier.translation()).norm() < nearly * target.position_tolerance &&
           geometry::angle_between(end, earlier) < nearly * target.angle_tolerance;
  });
}

bool Progress::is_unpromising(const action::Motion& motion) const {
  return (stage() != Stage::all && !motion.anchored) ||
         (stage() == Stage::probes && motion.kind == action::Kind::insertion);
}

/// What was touched by the last observations, by which the belief hardly shrank.
std::vector<Touch> Progress::touched_in_vain(const std::vector<belief::Trace>& history) const {
  std::vector<Touch> touches;
  if (stalls_ == 0) return touches;
  const std::size_t count = std::min(history.size(), static_cast<std::size_t>(stalls_) + 1);
  for (std::size_t i = history.size() - count; i < history.size(); ++i)
    if (const auto touch = touch_of(history[i])) touches.push_back(*touch);
  return touches;
}

}  // namespace tactus::solver
