// SPDX-License-Identifier: BSD-3-Clause
#include "solver/forecast.hpp"

#include "solver/voxel_problem.hpp"

namespace tactus::solver {
namespace {

action::MotionPtr motion_of(const action::Task& task, const action::Action& action) {
  action::Motion motion;
  motion.kind = action.kind;
  motion.path = action.path;
  return action::finished(task, std::move(motion));
}

std::vector<double> forecast_of(std::vector<geometry::Pose> poses, const belief::Belief& belief,
                                const action::MotionPtr& motion) {
  const auto total = static_cast<double>(poses.size());
  std::vector<double> result(motion->path.size() + 1, 0.0);
  Predictions predictions(belief.model().task, std::move(poses));
  for (const std::int32_t waypoint : predictions.first_contacts(motion))
    result[static_cast<std::size_t>(waypoint)] += 1.0 / total;
  return result;
}

}  // namespace

std::vector<double> forecast(const belief::Belief& belief, const action::Action& action, belief::Likelihood likelihood,
                             support::Rng& rng) {
  const action::MotionPtr motion = motion_of(belief.task(), action);
  const std::size_t count = belief.model().options.particles;
  if (belief.phase() == belief::Phase::poses)
    return forecast_of(belief::poses_of(belief.draw(count, rng)), belief, motion);
  std::vector<geometry::Pose> feasible;
  if (likelihood == belief::Likelihood::calibrated) feasible = belief::poses_of(belief.draw_feasible(count, rng));
  return std::make_shared<VoxelProblem>(belief.shared_model(), nullptr, std::move(feasible), 0.0)
      ->forecast(belief.voxels(), motion);
}

}  // namespace tactus::solver
