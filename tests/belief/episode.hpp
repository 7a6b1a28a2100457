// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "belief/plain_world.hpp"

namespace tactus::test {

/// A belief, what is done and seen in a world that shares no contact code with the library, and the true pose.
struct Episode {
  Episode(std::shared_ptr<const belief::Model> model, std::uint64_t seed)
      : rng(seed),
        truth(random_pose(model->task->scene().prior, rng)),
        world(*model->task, geometry::pose_from(truth)),
        library(*model->task),
        belief(model, model->task->scene().start) {}

  void step(const action::Action& action) { belief.step(action, world.execute(action)); }
  void step() { step(random_action(belief.task(), library, belief.configuration(), rng)); }

  support::Rng rng;
  PoseVector truth;
  PlainWorld world;
  action::ActionLibrary library;
  belief::Belief belief;
};

}  // namespace tactus::test
