// SPDX-License-Identifier: BSD-3-Clause
#include "belief/voxels.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::belief {
namespace {

constexpr double interior_spacing = 0.004;  // m between the points that stand for the target's inside

/// Points inside the target on a lattice, deepest first.
std::vector<VoxelModel::InteriorPoint> interior_points(const geometry::DistanceField& field) {
  std::vector<VoxelModel::InteriorPoint> points;
  const VoxelGrid lattice(field.tree().box(), interior_spacing);
  for (std::size_t i = 0; i < lattice.size(); ++i) {
    const Vector3 p = lattice.centre(i);
    const double upper = field.bounds(p).upper;
    if (upper < 0.0) points.push_back({p, -upper});
  }
  std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.depth > b.depth; });
  return points;
}

/// The longest distance from a point of the surface to a point of the inside deep enough to hold a voxel centre near
/// it, plus that depth.
double cover_radius(const geometry::Mesh& mesh, const std::vector<VoxelModel::InteriorPoint>& interior,
                    double half_diagonal, double diameter) {
  double longest = 0.0;
  for (const geometry::Triangle& t : mesh.triangles) {
    const geometry::Corners c = geometry::corners(mesh, t);
    const Vector3 centre = (c[0] + c[1] + c[2]) / 3.0;
    const double size = std::max({(c[0] - centre).norm(), (c[1] - centre).norm(), (c[2] - centre).norm()});
    double nearest = diameter;
    for (const VoxelModel::InteriorPoint& point : interior) {
      if (point.depth < half_diagonal) break;
      nearest = std::min(nearest, (point.point - centre).norm());
    }
    longest = std::max(longest, nearest + size);
  }
  return std::min(diameter, longest + half_diagonal);
}

}  // namespace

VoxelModel::VoxelModel(const Task& task, double voxel_size)
    : grid(scene::target_region(task.scene(), Pose::Identity()), voxel_size), diameter(task.target_diameter()) {
  const geometry::Mesh& mesh = task.scene().target.mesh;
  interior = interior_points(task.target_contact().field());
  cover = cover_radius(mesh, interior, grid.half_diagonal(), diameter);
  target_voxels = std::abs(geometry::signed_volume(mesh)) / std::pow(voxel_size, 3);
}

VoxelBelief::VoxelBelief(std::shared_ptr<const VoxelModel> model)
    : model_(std::move(model)), possibly_occupied_(model_->grid.size(), true) {}

void VoxelBelief::update(const Task& task, const Trace& trace) {
  remove_entered(task, trace);
  if (!trace.contact) return;
  const double slack = task.options().contact_margin + trace.error + trace.slack;
  Bitset candidates(model_->grid.size());
  for (std::size_t stop = trace.touch; stop < trace.bodies.size(); ++stop)
    candidates |= contact::contact_candidates(task.bodies(), trace.bodies, stop, model_->grid, slack);
  add_contact(candidates);
}

/// What the robot has certainly been in before it touched anything.
void VoxelBelief::remove_entered(const Task& task, const Trace& trace) {
  if (trace.error > 0.0) {
    possibly_occupied_.and_not(
        contact::voxels_deep_inside(task.bodies(), trace.bodies, trace.touch, model_->grid, trace.error));
    return;
  }
  const contact::SweptVoxels swept = contact::swept_voxels(task.bodies(), trace.bodies, model_->grid);
  remove_free(swept.voxels, trace.touch == 0 ? 0 : swept.entered_by(trace.touch - 1));
}

void VoxelBelief::remove_free(const std::vector<std::uint32_t>& swept, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) possibly_occupied_.reset(swept[i]);
}

void VoxelBelief::add_contact(const Bitset& candidates) {
  contacts_.push_back({candidates, {}});
  std::vector<float> to_possible = contact::distance_to(possibly_occupied_, model_->grid);
  for (bool changed = true; changed;) {
    changed = false;
    for (ContactRecord& record : contacts_) changed = shrink(record, to_possible) || changed;
  }
}

/// Drops candidates with no part of the target near enough, then applies U: drops voxels too far from every candidate.
/// `to_possible`: the distance from each voxel to PO, kept up to date. Says whether anything changed.
bool VoxelBelief::shrink(ContactRecord& record, std::vector<float>& to_possible) {
  const double half_diagonal = model_->grid.half_diagonal();
  Bitset kept(model_->grid.size());
  record.candidates.for_each([&](std::size_t v) {
    if (to_possible[v] <= model_->cover + half_diagonal + 1e-6) kept.set(v);
  });
  const bool first = record.distance.empty();
  if (!first && kept == record.candidates) return false;
  record.candidates = std::move(kept);
  record.distance = contact::distance_to(record.candidates, model_->grid);
  const double farthest = model_->diameter + half_diagonal + 1e-6;
  Bitset unoccupied(model_->grid.size());
  possibly_occupied_.for_each([&](std::size_t v) {
    if (record.distance[v] > farthest) unoccupied.set(v);
  });
  if (unoccupied.none()) return first;
  possibly_occupied_.and_not(unoccupied);
  to_possible = contact::distance_to(possibly_occupied_, model_->grid);
  return true;
}

bool VoxelBelief::excludes(const Pose& base_from_target, double radius) const {
  const double deep_enough = radius + model_->grid.half_diagonal();
  for (const VoxelModel::InteriorPoint& interior : model_->interior) {
    if (interior.depth < deep_enough) return false;
    const auto voxel = model_->grid.voxel_at(base_from_target * interior.point);
    if (voxel && !possibly_occupied_.test(*voxel)) return true;
  }
  return false;
}

VoxelBelief VoxelBelief::restored(std::shared_ptr<const VoxelModel> model, Bitset possibly_occupied,
                                  std::vector<Bitset> candidates) {
  VoxelBelief belief(std::move(model));
  belief.possibly_occupied_ = std::move(possibly_occupied);
  for (Bitset& set : candidates) {
    std::vector<float> distance = contact::distance_to(set, belief.model_->grid);
    belief.contacts_.push_back({std::move(set), std::move(distance)});
  }
  return belief;
}

}  // namespace tactus::belief
