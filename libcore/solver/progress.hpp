// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "belief/belief.hpp"
#include "solver/touches.hpp"

namespace tactus::solver {

/// What was handed out last, as it was weighed.
struct HandedOut {
  std::uint64_t action_id = 0;
  std::size_t lead = 0;  ///< waypoints before the motion proper
  const Choice& choice;
};

/// How an episode gets on, from query to query, and so what is not worth trying now. An action that left the belief
/// and the configuration as they were is not handed out again until something changes; nor, while the belief hardly
/// shrinks, one that is all but certain to meet what was met without avail (`alike`), nor an attempt all but where one
/// met nothing and was not the last; and after some queries in which the belief hardly shrank only probes are, then
/// attempts too, then all again: the poses planned on promise more of small touches than the cells can take in.
class Progress {
 public:
  /// Takes note of what became of the action handed out last, if any was. False, and begun anew, if the belief has not
  /// gone on from where it was.
  bool note(const belief::Belief& belief, const std::optional<HandedOut>& last);

  /// Those of some choices that come after all others.
  std::vector<std::size_t> held_back(const belief::Belief& belief, const std::vector<Choice>& choices) const;

  /// Whether the action has just left everything as it was.
  bool is_fruitless(std::uint64_t action_id) const;

  bool is_stuck() const;                ///< the belief has hardly shrunk for some queries
  bool enters_a_stage() const;          ///< has just come to be, or to try something else
  int halts() const { return halts_; }  ///< in a row, before an action's motion proper had begun

 private:
  enum class Stage { all, probes, anchored };  ///< what is tried

  Stage stage() const;
  bool is_known(const action::Motion& motion) const;
  bool is_idle(const Choice& choice) const;
  bool is_made_already(const action::Motion& motion, const scene::Target& target) const;
  bool is_unpromising(const action::Motion& motion) const;
  std::vector<Touch> touched_in_vain(const std::vector<belief::Trace>& history) const;
  void note_end(const belief::Belief& belief, const HandedOut& last);

  std::size_t observations_ = 0;
  std::uint64_t history_ = belief::fingerprint({}, 0);
  robot::JointVector q_;  ///< empty before the first query
  std::size_t size_ = 0;  ///< cells or voxels
  std::vector<std::uint64_t> fruitless_;
  std::vector<motion::JointPath> met_;   ///< of small motions that met something, up to there
  std::vector<geometry::Pose> gone_in_;  ///< ends of attempts that met nothing, of the tool in the base frame
  double bits_ = 0.0;                    ///< when the belief last shrank noticeably
  int stalls_ = 0;                       ///< queries since then
  int idle_ = 0;                         ///< queries since then whose action was not to tell anything
  int halts_ = 0;
};

}  // namespace tactus::solver
