// SPDX-License-Identifier: BSD-3-Clause
#include "contact/known_world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "contact/link_pairs.hpp"
#include "contact/solid.hpp"
#include "support/error.hpp"
#include "support/rng.hpp"

namespace tactus::contact {

using geometry::Box;
using geometry::Vector3;
using robot::LinkPair;
using robot::RobotModel;

namespace {

constexpr int random_configurations = 200;
constexpr std::uint64_t random_seed = 0x7ac7;
constexpr std::size_t most_shells = 64;  // of one mesh, to be treated one by one

// One shape of the robot or of the static world, and the name of the link or the object it belongs to.
struct Part {
  Solid solid;
  int link = -1;  // -1: static
  std::string name;
};

// Indices of parts, first < second: the one order in which the two are ever handed to FCL.
using PartPair = std::pair<std::size_t, std::size_t>;

// Where everything stands at one configuration.
struct Placement {
  std::vector<Pose> links;
  std::vector<Box> boxes;  // of the parts, in the base frame
};

JointVector random_configuration(const RobotModel& model, support::Rng& rng) {
  JointVector q(model.dof());
  for (int j = 0; j < model.dof(); ++j) {
    const robot::Joint& joint = model.joints[static_cast<std::size_t>(j)];
    const bool bounded = std::isfinite(joint.lower) && std::isfinite(joint.upper);
    q[j] = bounded ? rng.uniform(joint.lower, joint.upper) : rng.uniform(-std::numbers::pi, std::numbers::pi);
  }
  return q;
}

// A mesh as one solid a shell: the boards of a shelf have boxes that keep most queries away from their triangles, the
// shelf has not.
std::vector<Solid> in_shells(const Mesh& mesh, const std::string& name) {
  std::vector<Solid> solids{Solid(mesh, name)};
  const std::vector<Mesh> shells = geometry::shells(geometry::merged_vertices(mesh));
  if (shells.size() > most_shells) return solids;
  solids.clear();
  for (const Mesh& shell : shells) solids.emplace_back(shell, name);
  return solids;
}

// What is wrong with the joint values themselves; empty if nothing is.
std::string describe_joints(const RobotModel& model, const JointVector& q) {
  if (q.size() != model.dof())
    return "found " + std::to_string(q.size()) + " joint values, expected " + std::to_string(model.dof());
  std::string text;
  for (int j = 0; j < model.dof(); ++j) {
    const robot::Joint& joint = model.joints[static_cast<std::size_t>(j)];
    const std::string separator = text.empty() ? "" : ", ";
    if (!std::isfinite(q[j]))
      text += separator + joint.name + " is not a finite number";
    else if (q[j] < joint.lower - 1e-9 || q[j] > joint.upper + 1e-9)
      text += separator + joint.name + " at " + std::to_string(q[j]) + " outside [" + std::to_string(joint.lower) +
              ", " + std::to_string(joint.upper) + "]";
  }
  return text;
}

}  // namespace

struct KnownWorld::Impl {
  std::shared_ptr<const RobotModel> model;
  std::vector<Part> parts;  // the links' in the order of the links, then the static ones
  std::size_t static_begin = 0;
  std::vector<Box> static_boxes;
  std::vector<LinkPair> link_pairs;
  std::vector<PartPair> part_pairs;  // of the robot with the world, then with itself
  std::vector<double> reach;

  void add_robot();
  void add_static(const std::vector<Mesh>& meshes, const std::vector<std::string>& names);
  void choose_pairs();
  bool always_collides(const LinkPair& pair, const std::vector<Placement>& samples) const;
  std::vector<PartPair> parts_of(const LinkPair& pair) const;
  bool well_formed(const JointVector& q) const;
  void place(const JointVector& q, Placement& placement) const;
  bool collides(const PartPair& pair, const Placement& placement) const;
  const Pose& pose_of(const Part& part, const Placement& placement) const;
};

void KnownWorld::Impl::add_robot() {
  reach.assign(model->links.size(), 0.0);
  for (std::size_t i = 0; i < model->links.size(); ++i)
    for (const Mesh& shape : model->links[i].shapes) {
      parts.push_back({Solid(shape, model->links[i].name), static_cast<int>(i), model->links[i].name});
      reach[i] = std::max(reach[i], parts.back().solid.reach());
    }
  static_begin = parts.size();
}

void KnownWorld::Impl::add_static(const std::vector<Mesh>& meshes, const std::vector<std::string>& names) {
  if (meshes.size() != names.size())
    throw support::Error(support::Status::invalid_argument, "static world: found " + std::to_string(names.size()) +
                                                                " names, expected one for each of " +
                                                                std::to_string(meshes.size()) + " meshes");
  for (std::size_t i = 0; i < meshes.size(); ++i)
    for (Solid& solid : in_shells(meshes[i], names[i])) {
      static_boxes.push_back(solid.box());
      parts.push_back({std::move(solid), -1, names[i]});
    }
}

void KnownWorld::Impl::choose_pairs() {
  support::Rng rng(random_seed);
  std::vector<Placement> samples(random_configurations);
  for (Placement& sample : samples) place(random_configuration(*model, rng), sample);
  for (const LinkPair& pair : collidable_pairs(*model))
    if (!always_collides(pair, samples)) link_pairs.push_back(pair);

  const std::vector<bool> moving = moving_links(*model);
  for (std::size_t part = 0; part < static_begin; ++part)
    for (std::size_t other = static_begin; other < parts.size(); ++other)
      if (moving[static_cast<std::size_t>(parts[part].link)]) part_pairs.emplace_back(part, other);
  for (const LinkPair& pair : link_pairs)
    for (const PartPair& two : parts_of(pair)) part_pairs.push_back(two);
}

bool KnownWorld::Impl::always_collides(const LinkPair& pair, const std::vector<Placement>& samples) const {
  const std::vector<PartPair> pairs = parts_of(pair);
  return std::all_of(samples.begin(), samples.end(), [&](const Placement& sample) {
    return std::any_of(pairs.begin(), pairs.end(), [&](const PartPair& two) { return collides(two, sample); });
  });
}

std::vector<PartPair> KnownWorld::Impl::parts_of(const LinkPair& pair) const {
  std::vector<PartPair> pairs;
  for (std::size_t a = 0; a < static_begin; ++a)
    for (std::size_t b = a + 1; b < static_begin; ++b)
      if (parts[a].link == pair.first && parts[b].link == pair.second) pairs.emplace_back(a, b);
  return pairs;
}

bool KnownWorld::Impl::well_formed(const JointVector& q) const {
  return q.size() == model->dof() && q.allFinite() && robot::inside_limits(*model, q);
}

void KnownWorld::Impl::place(const JointVector& q, Placement& placement) const {
  robot::forward(*model, q, placement.links);
  placement.boxes.resize(parts.size());
  for (std::size_t i = 0; i < static_begin; ++i)
    placement.boxes[i] = moved_box(parts[i].solid.box(), pose_of(parts[i], placement));
  std::copy(static_boxes.begin(), static_boxes.end(),
            placement.boxes.begin() + static_cast<std::ptrdiff_t>(static_begin));
}

const Pose& KnownWorld::Impl::pose_of(const Part& part, const Placement& placement) const {
  static const Pose at_base = Pose::Identity();
  return part.link < 0 ? at_base : placement.links[static_cast<std::size_t>(part.link)];
}

bool KnownWorld::Impl::collides(const PartPair& pair, const Placement& placement) const {
  if (!placement.boxes[pair.first].overlaps(placement.boxes[pair.second])) return false;
  const Part& a = parts[pair.first];
  const Part& b = parts[pair.second];
  return touching(a.solid, pose_of(a, placement), b.solid, pose_of(b, placement));
}

KnownWorld::KnownWorld(std::shared_ptr<const RobotModel> model, std::vector<Mesh> static_world,
                       std::vector<std::string> static_names)
    : impl_(std::make_unique<Impl>()) {
  impl_->model = std::move(model);
  impl_->add_robot();
  impl_->add_static(static_world, static_names);
  impl_->choose_pairs();
}

KnownWorld::~KnownWorld() = default;

bool KnownWorld::is_free(const JointVector& q) const {
  if (!impl_->well_formed(q)) return false;
  Placement placement;
  impl_->place(q, placement);
  return std::none_of(impl_->part_pairs.begin(), impl_->part_pairs.end(),
                      [&](const PartPair& pair) { return impl_->collides(pair, placement); });
}

std::string KnownWorld::describe_collision(const JointVector& q) const {
  if (std::string wrong = describe_joints(*impl_->model, q); !wrong.empty()) return wrong;
  Placement placement;
  impl_->place(q, placement);
  std::vector<std::string> found;
  for (const PartPair& pair : impl_->part_pairs) {
    if (!impl_->collides(pair, placement)) continue;
    std::string text = impl_->parts[pair.first].name + " with " + impl_->parts[pair.second].name;
    if (std::find(found.begin(), found.end(), text) == found.end()) found.push_back(std::move(text));
  }
  std::string all;
  for (const std::string& text : found) all += (all.empty() ? "" : ", ") + text;
  return all;
}

const RobotModel& KnownWorld::model() const { return *impl_->model; }

const std::vector<LinkPair>& KnownWorld::checked_pairs() const { return impl_->link_pairs; }

const std::vector<double>& KnownWorld::link_reach() const { return impl_->reach; }

double KnownWorld::displacement(const JointVector& from, const JointVector& to) const {
  if ((to - from).cwiseAbs().maxCoeff() > 0.3) return robot::motion_bound(*impl_->model, impl_->reach, from, to);
  std::vector<Pose> before, after;
  robot::forward(*impl_->model, from, before);
  robot::forward(*impl_->model, to, after);
  double largest = 0.0;
  for (std::size_t i = 0; i < impl_->static_begin; ++i) {
    const auto link = static_cast<std::size_t>(impl_->parts[i].link);
    largest = std::max(largest, geometry::largest_displacement(impl_->parts[i].solid.box(), before[link], after[link]));
  }
  return largest;
}

}  // namespace tactus::contact
