// SPDX-License-Identifier: BSD-3-Clause
#include "action/fingerprint.hpp"

#include <cmath>

namespace tactus::action {

void Fingerprint::add(const std::string& text) {
  add(text.size());
  for (const char letter : text) add(std::uint64_t{static_cast<std::uint8_t>(letter)});
}

void Fingerprint::add_rounded(double value) { add(static_cast<std::uint64_t>(std::llround(1e6 * value))); }

void Fingerprint::add(const geometry::Pose& pose) {
  for (const double x : pose.matrix().reshaped()) add_rounded(x);
}

void Fingerprint::add(const geometry::Mesh& mesh) {
  add(mesh.vertices.size());
  for (const geometry::Vector3& v : mesh.vertices)
    for (const double x : v) add(x);
  for (const geometry::Triangle& t : mesh.triangles)
    for (const std::int32_t index : t) add(static_cast<std::uint64_t>(index));
}

void Fingerprint::add(const scene::Prior& prior) {
  for (int d = 0; d < 6; ++d) {
    add(prior.centre[d]);
    add(prior.width[d]);
  }
  for (const scene::Guess& guess : prior.guesses) {
    add(guess.share);
    for (const double x : guess.normal.mean()) add(x);
    for (const double x : guess.normal.covariance().reshaped()) add(x);
  }
}

void Fingerprint::add(const scene::Scene& scene) {
  add(scene.target.mesh);
  add(scene.tool);
  add(scene.target.target_from_seated.size());
  for (const geometry::Pose& target_from_seated : scene.target.target_from_seated) add(target_from_seated);
  add(scene.target.position_tolerance);
  add(scene.target.angle_tolerance);
  for (const robot::Joint& joint : scene.robot->joints) add(joint.name);
  for (const scene::StaticPart& part : scene.world)
    for (const geometry::Vector3& v : part.mesh.vertices)
      for (const double x : v) add_rounded(x);
}

}  // namespace tactus::action
