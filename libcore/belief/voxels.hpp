// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "belief/trace.hpp"
#include "contact/swept_voxels.hpp"

namespace tactus::belief {

using contact::Bitset;
using contact::VoxelGrid;

/// What is const of the volumetric belief: the grid over the prior's volume, and what the target's shape says about
/// voxels. Shared.
struct VoxelModel {
  VoxelGrid grid;         ///< base frame, over everything the target may occupy
  double diameter = 0.0;  ///< D_max, m
  double cover = 0.0;     ///< m within which every point of the target has a voxel centre that lies inside the target;
                          ///< D_max if the target is too thin for one
  double target_voxels = 0.0;  ///< N: the target's volume in voxels
  struct InteriorPoint {
    Vector3 point;  ///< target frame
    double depth;   ///< m below the surface, at least
  };
  std::vector<InteriorPoint> interior;  ///< the deepest first

  VoxelModel(const Task& task, double voxel_size);
};

/// A contact in the collision history C: where on the grid its point may be, and how far every voxel is from there.
struct ContactRecord {
  Bitset candidates;            ///< S(q_i, a): one of these cubes holds the contact point
  std::vector<float> distance;  ///< from each voxel to the nearest candidate, m
};

/// Phase 1: PO, the voxels whose centres may lie inside the target, and the collision history C. A value; the model is
/// shared.
class VoxelBelief {
 public:
  VoxelBelief(std::shared_ptr<const VoxelModel> model);

  const VoxelModel& model() const { return *model_; }
  const Bitset& possibly_occupied() const { return possibly_occupied_; }
  const std::vector<ContactRecord>& contacts() const { return contacts_; }

  /// PO \ V for the free part of the trace; for a contact (q_i, a) joins C and PO \ U follows for all of C, to a fixed
  /// point.
  void update(const Task& task, const Trace& trace);

  /// The same for a predicted outcome: `swept` voxels are free, and then, for a contact, one of `candidates` holds its
  /// point.
  void remove_free(const std::vector<std::uint32_t>& swept, std::size_t count);
  void add_contact(const Bitset& candidates);

  /// Whether no pose within `radius` of `base_from_target` lies inside PO: a voxel is certainly inside the target and
  /// not in PO.
  bool excludes(const Pose& base_from_target, double radius) const;

  static VoxelBelief restored(std::shared_ptr<const VoxelModel> model, Bitset possibly_occupied,
                              std::vector<Bitset> candidates);

 private:
  void remove_entered(const Task& task, const Trace& trace);
  bool shrink(ContactRecord& record, std::vector<float>& to_possible);

  std::shared_ptr<const VoxelModel> model_;
  Bitset possibly_occupied_;
  std::vector<ContactRecord> contacts_;
};

}  // namespace tactus::belief
