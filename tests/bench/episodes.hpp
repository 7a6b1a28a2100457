// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "belief/belief.hpp"

namespace tactus::bench {

/// What the robot knows in the middle of an episode.
struct State {
  const belief::Belief& belief;
  const geometry::Pose& truth;
  std::size_t contacts = 0;  ///< so far
  std::uint64_t episode = 0;
};

/// After how many contacts episodes are looked at.
inline constexpr std::size_t contacts_looked_at[] = {4, 8, 12, 16};

/// On cells of poses.
std::shared_ptr<const belief::Model> model_of(const std::string& scenario);

/// Three episodes at random true poses, played by the rate rule: visits each after the contacts above, as far as it
/// comes.
void for_each_state(const std::shared_ptr<const belief::Model>& model, std::uint64_t seed,
                    const std::function<void(const State&, support::Rng&)>& visit);

}  // namespace tactus::bench
