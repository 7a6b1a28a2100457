// SPDX-License-Identifier: BSD-3-Clause
#include "bench/fcl_baseline.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBB.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>

#include "support/error.hpp"

namespace tactus::bench {
namespace {

using Geometry = std::unique_ptr<const fcl::CollisionGeometryd>;

template <typename Volume>
Geometry tree_of(const geometry::Mesh& mesh) {
  std::vector<fcl::Triangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles)
    triangles.emplace_back(static_cast<std::size_t>(a), static_cast<std::size_t>(b), static_cast<std::size_t>(c));
  auto model = std::make_unique<fcl::BVHModel<Volume>>();
  const bool built = model->beginModel() == fcl::BVH_OK &&
                     model->addSubModel(mesh.vertices, triangles) == fcl::BVH_OK && model->endModel() == fcl::BVH_OK;
  if (!built) throw support::Error(support::Status::bad_mesh, "FCL could not build its tree");
  return model;
}

Geometry tree_of(const geometry::Mesh& mesh, FclTree tree) {
  return tree == FclTree::obb ? tree_of<fcl::OBBd>(mesh) : tree_of<fcl::OBBRSSd>(mesh);
}

}  // namespace

struct FclBaseline::Trees {
  std::vector<Geometry> bodies;
  Geometry target;
};

FclBaseline::FclBaseline(const contact::RobotBodies& bodies, const geometry::Mesh& target, FclTree tree) {
  auto trees = std::make_unique<Trees>();
  for (std::size_t body = 0; body < bodies.size(); ++body)
    trees->bodies.push_back(tree_of(bodies.body(body).mesh(), tree));
  trees->target = tree_of(target, tree);
  trees_ = std::move(trees);
}

FclBaseline::~FclBaseline() = default;

int FclBaseline::first_contact(const std::vector<geometry::Pose>& base_from_body,
                               const geometry::Pose& base_from_target) const {
  static const fcl::CollisionRequestd yes_or_no(1, false);
  fcl::CollisionResultd result;
  const std::size_t bodies = trees_->bodies.size();
  for (std::size_t i = bodies; i < base_from_body.size(); ++i)
    if (fcl::collide(trees_->bodies[i % bodies].get(), base_from_body[i], trees_->target.get(), base_from_target,
                     yes_or_no, result) > 0)
      return static_cast<int>(i / bodies);
  return -1;
}

}  // namespace tactus::bench
