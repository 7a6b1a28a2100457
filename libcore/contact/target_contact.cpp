// SPDX-License-Identifier: BSD-3-Clause
#include "contact/target_contact.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace tactus::contact {
namespace {

constexpr double relative_detail = 0.4;  // of the reach or the depth asked for
constexpr double field_spacing = 0.001;
constexpr double field_border = 0.01;
constexpr std::size_t field_samples = 1'000'000;
constexpr double facet_reach = 0.002;  // m: the radius of the largest piece that needs no tree of triangles
constexpr std::size_t candidates = 8;  // pieces, by their middles, among which the nearest point is looked for;
constexpr std::size_t looked_at = 3;   // of them, by their corners, are looked at closely
constexpr int halvings = 4;            // of a piece in which the nearest point is looked for
constexpr double box_slack = 2e-6;     // m, of boxes and triangles compared in single precision

/// The lanes of sixteen from `first` on that are in [from, to).
std::uint32_t lanes_within(std::size_t first, std::size_t from, std::size_t to) {
  std::uint32_t mask = 0xffffu;
  if (from > first) mask &= 0xffffu << (from - first);
  if (to < first + kernel::lanes) mask &= 0xffffu >> (first + kernel::lanes - to);
  return mask;
}

/// Sends for the pieces that a walk has listed: the wait for one is then the wait for all.
void fetch(const std::vector<Piece>& pieces, const kernel::Walk& walk) {
  constexpr std::size_t line = 64;
  for (int i = 0; i < walk.piece_count; ++i) {
    const char* const piece = reinterpret_cast<const char*>(&pieces[walk.pieces[i]]);
    for (std::size_t k = 0; k < sizeof(Piece); k += line) __builtin_prefetch(piece + k);
  }
}

// Eigen's own are not inlined, and take twice as long.
Pose product(const Pose& a, const Pose& b) {
  Pose result;
  result.linear() = a.linear().lazyProduct(b.linear());
  result.translation() = a.linear().lazyProduct(b.translation()) + a.translation();
  result.makeAffine();
  return result;
}

Pose inverse(const Pose& a) {
  Pose result;
  result.linear() = a.linear().transpose();
  result.translation() = -a.linear().transpose().lazyProduct(a.translation());
  result.makeAffine();
  return result;
}

/// Of the four triangles into which its sides' middles cut a triangle, the one whose middle is nearest to `p`.
Corners quarter_nearest_to(const Vector3& p, const Corners& corners, const Corners& middle) {
  const std::array<Corners, 4> quarters{{{corners[0], middle[1], middle[2]},
                                         {corners[1], middle[2], middle[0]},
                                         {corners[2], middle[0], middle[1]},
                                         middle}};
  const auto away = [&p](const Corners& c) { return ((c[0] + c[1] + c[2]) / 3.0 - p).squaredNorm(); };
  return *std::min_element(quarters.begin(), quarters.end(),
                           [&](const Corners& a, const Corners& b) { return away(a) < away(b); });
}

}  // namespace

/// A shell that crosses nothing is inside the target or outside it as a whole: one of its pieces is asked. Only shells
/// with pieces that the field leaves undecided can be inside.
struct TargetContact::Sides {
  std::vector<const Piece*> asked;  ///< one a shell

  void ask(const Body& body, const kernel::Walk& walk) {
    for (int i = 0; i < walk.piece_count; ++i) {
      const Piece& piece = body.balls().pieces()[walk.pieces[i]];
      if (std::none_of(asked.begin(), asked.end(), [&](const Piece* p) { return p->shell == piece.shell; }))
        asked.push_back(&piece);
    }
  }
  bool inside(const TargetContact& contact, const Pose& target_from_body) const {
    return std::any_of(asked.begin(), asked.end(), [&](const Piece* piece) {
      const Vector3 centre = target_from_body * piece->centre;
      return contact.field_.bounds(centre).lower < 0.0 && contact.field_.tree().contains(centre);
    });
  }
};

TargetContact::TargetContact(std::shared_ptr<const RobotBodies> bodies, const Mesh& target, double margin,
                             const kernel::Kernel& kernel)
    : bodies_(std::move(bodies)),
      target_(target),
      field_(target, field_spacing, field_border, field_samples),
      image_(field_),
      facets_(field_.tree(), facet_reach + margin),
      extent_(extent(field_.tree().box())),
      kernel_(kernel),
      margin_(margin) {
  for (const Mesh& shell : geometry::shells(geometry::merged_vertices(target)))
    shell_points_.push_back(shell.vertices.front());
}

/// Decides a piece that the look-ups leave undecided: they are as good as its size, so a reach or a depth wider than
/// that is left at them, which errs to a hit, or to none. Else its triangle, or for a depth its middle, is asked.
bool TargetContact::piece_hit(const Piece& piece, const Pose& target_from_body, const kernel::Placement& at,
                              const Asked& asked) const {
  const auto [threshold, errs_to_hit] = asked;
  const geometry::TriangleTree& tree = field_.tree();
  if (std::abs(threshold) > std::max(margin_, piece.radius) || (threshold < 0.0 && errs_to_hit)) return errs_to_hit;
  if (threshold >= 0.0) return crosses(piece, target_from_body, at, threshold);
  const Vector3 centre = target_from_body * piece.centre;
  const geometry::DistanceBounds bounds = field_.narrow_bounds(centre);
  if (bounds.lower > threshold || bounds.upper <= threshold) return bounds.upper <= threshold;
  return !tree.is_nearer(centre, -threshold) && tree.contains(centre);
}

/// Whether a piece is within `reach` of the target's triangles: those beside it that no plane parts from it are
/// measured.
bool TargetContact::crosses(const Piece& piece, const Pose& target_from_body, const kernel::Placement& at,
                            double reach) const {
  const geometry::TriangleTree& tree = field_.tree();
  if (piece.radius + reach > facets_.reach())
    return tree.within(geometry::transformed(piece.corners, target_from_body), reach);
  const Facets::Near beside = facets_.near(target_from_body * piece.centre);
  for (std::size_t k = 0; k < beside.blocks.size(); ++k) {
    std::uint32_t near = kernel_.facets_near(piece.facet, at, beside.blocks[k], static_cast<float>(reach + box_slack));
    for (; near != 0; near &= near - 1)
      if (tree.within(geometry::transformed(piece.corners, target_from_body),
                      beside.faces[k * kernel::lanes + static_cast<std::size_t>(std::countr_zero(near))], reach))
        return true;
  }
  return false;
}

/// Goes through the body's balls, deepest detail only where the target is near. A reach much wider than a ball takes
/// the ball for its part of the surface, which errs to a hit, and a depth much greater gives it up, which errs to none.
Reach TargetContact::reach(const Body& body, const Pose& target_from_body, const Asked& asked) const {
  const double threshold = asked.threshold;
  const bool wide = std::abs(threshold) > margin_;
  const kernel::Question question{static_cast<float>(threshold),
                                  wide ? static_cast<float>(relative_detail * std::abs(threshold)) : 0.0f,
                                  wide && asked.errs_to_hit};
  const kernel::Placement at = placement(target_from_body);
  Sides sides;
  kernel::Walk walk;
  walk.start(body.balls().root());
  const auto all_outside = [&] { return walk.clearance < kernel::none_above && body.balls().shells() == 1; };
  bool pieces_free = false;
  std::uint64_t looks = 0;
  do {
    ++looks;
    if (kernel_.walk(body.balls().blocks().data(), image_.view(), at, question, walk) == kernel::Verdict::hit)
      return {true, 0.0, looks};
    fetch(body.balls().pieces(), walk);
    for (int i = 0; i < walk.piece_count; ++i)
      if (++looks; piece_hit(body.balls().pieces()[walk.pieces[i]], target_from_body, at, asked))
        return {true, 0.0, looks};
    pieces_free = pieces_free || walk.piece_count > 0;
    if (threshold >= 0.0 && !all_outside()) sides.ask(body, walk);
  } while (walk.depth > 0);
  if (threshold >= 0.0 &&
      ((!all_outside() && sides.inside(*this, target_from_body)) || target_inside(body, target_from_body)))
    return {true, 0.0, looks};
  return {false, pieces_free ? 0.0 : std::max(0.0, static_cast<double>(walk.clearance)), looks};
}

bool TargetContact::target_inside(const Body& body, const Pose& target_from_body) const {
  return std::any_of(shell_points_.begin(), shell_points_.end(), [&](const Vector3& point) {
    const Vector3 p = target_from_body.linear().transpose() * (point - target_from_body.translation());
    return body.tree().box().contains(p) && body.field().bounds(p).lower <= 0.0 && body.tree().contains(p);
  });
}

std::uint32_t TargetContact::near_waypoints(const BodyPath& path, std::size_t body, std::size_t block,
                                            const kernel::Placement& target_from_base, double reach) const {
  return kernel_.near(path.pose_block(block, body), bodies_->body(body).extent(), target_from_base, extent_,
                      static_cast<float>(std::max(0.0, reach) + box_slack));
}

std::size_t TargetContact::first_reach(const BodyPath& path, std::size_t body, const Pose& target_from_base,
                                       const Asked& asked, std::size_t from, std::size_t to, Effort* effort) const {
  const std::size_t none = to;
  if (from >= to) return none;
  if (asked.threshold < BodyPath::region_margin) {
    from = std::max(from, path.near_region(body).begin);
    to = std::min(to, path.near_region(body).end);
  }
  const kernel::Placement base = placement(target_from_base);
  double free_until = -1.0;  // of the way travelled
  for (std::size_t first = from / kernel::lanes * kernel::lanes; first < to; first += kernel::lanes) {
    std::uint32_t near = near_waypoints(path, body, first / kernel::lanes, base, asked.threshold);
    for (near &= lanes_within(first, from, to); near != 0; near &= near - 1) {
      const std::size_t i = first + static_cast<std::size_t>(std::countr_zero(near));
      if (path.travelled(i, body) < free_until) continue;
      const Reach at = reach(bodies_->body(body), product(target_from_base, path.base_from_body(i, body)), asked);
      if (effort) effort->looks += at.looks;
      if (at.hit) return i;
      free_until = path.travelled(i, body) + at.clearance;
    }
  }
  return none;
}

std::optional<std::size_t> TargetContact::first_reach(const BodyPath& path, const Pose& base_from_target,
                                                      const Asked& asked, std::size_t from, Effort* effort) const {
  const Pose target_from_base = inverse(base_from_target);
  std::size_t first = path.size();
  if (effort) ++effort->looks;
  for (std::size_t body = 0; body < bodies_->size(); ++body)
    first = std::min(first, first_reach(path, body, target_from_base, asked, from, first, effort));
  return first == path.size() ? std::nullopt : std::optional(first);
}

std::optional<std::size_t> TargetContact::first_contact(const BodyPath& path, const Pose& base_from_target) const {
  return first_reach(path, base_from_target, usual(margin_), 1);
}

std::optional<std::size_t> TargetContact::first_within(const BodyPath& path, const Pose& base_from_target,
                                                       double radius, std::size_t from, Effort* effort) const {
  return first_reach(path, base_from_target, usual(radius), from, effort);
}

bool TargetContact::touches(const BodyPath& path, std::size_t waypoint, const Pose& base_from_target) const {
  return within(path, waypoint, base_from_target, margin_);
}

bool TargetContact::within(const BodyPath& path, std::size_t waypoint, const Pose& base_from_target,
                           double radius) const {
  const Pose target_from_base = base_from_target.inverse();
  for (std::size_t body = 0; body < bodies_->size(); ++body)
    if (first_reach(path, body, target_from_base, usual(radius), waypoint, waypoint + 1) == waypoint) return true;
  return false;
}

std::optional<std::size_t> TargetContact::first_certain_contact(const BodyPath& path, const Pose& base_from_target,
                                                                double radius, std::size_t from, Effort* effort) const {
  return first_reach(path, base_from_target, usual(-radius), from, effort);
}

std::size_t TargetContact::first_certain_contact(const BodyPath& path, std::size_t body, const Pose& base_from_target,
                                                 double radius, std::size_t from, std::size_t to) const {
  return first_reach(path, body, inverse(base_from_target), usual(-radius), from, to);
}

std::size_t TargetContact::first_possible_contact(const BodyPath& path, std::size_t body, const Pose& base_from_target,
                                                  double radius, std::size_t from, std::size_t to) const {
  return first_reach(path, body, inverse(base_from_target), {-radius, true}, from, to);
}

ContactInterval TargetContact::first_contact_interval(const BodyPath& path, const Pose& base_from_target,
                                                      double radius) const {
  return {first_reach(path, base_from_target, usual(radius + margin_), 1).value_or(path.size()),
          first_certain_contact(path, base_from_target, radius).value_or(path.size())};
}

/// The pieces whose middles come nearest to the target.
struct TargetContact::Closest {
  struct Entry {
    double distance = 1e300;
    const Piece* piece = nullptr;
    Pose target_from_body = Pose::Identity();
  };
  std::array<Entry, candidates> entries;  ///< the nearest first

  double bound() const { return entries.back().distance; }
  void add(const Entry& entry) {
    if (entry.distance >= bound()) return;
    entries.back() = entry;
    for (std::size_t i = entries.size() - 1; i > 0 && entries[i].distance < entries[i - 1].distance; --i)
      std::swap(entries[i], entries[i - 1]);
  }
  void sort_by_corners(const TargetContact& contact) {
    for (Entry& entry : entries)
      if (entry.piece != nullptr)
        for (const Vector3& corner : entry.piece->corners)
          entry.distance = std::min(entry.distance, contact.estimate(entry.target_from_body * corner));
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.distance < b.distance; });
  }
};

double TargetContact::estimate(const Vector3& p) const {
  const geometry::DistanceBounds bounds = field_.bounds(p);
  return bounds.lower > field_border ? 0.5 * (bounds.lower + bounds.upper) : field_.estimate(p);
}

void TargetContact::look_at(const Piece& piece, const Pose& target_from_body, Closest& closest) const {
  const Vector3 middle = target_from_body * piece.centre;
  if (field_.bounds(middle).lower < closest.bound()) closest.add({estimate(middle), &piece, target_from_body});
}

/// The deepest point of a piece, or the nearest, looked for where its quarters' corners are.
void TargetContact::look_closely(const Piece& piece, const Pose& target_from_body, Nearest& best) const {
  Corners corners = geometry::transformed(piece.corners, target_from_body);
  Vector3 nearest = target_from_body * piece.centre;
  double least = estimate(nearest);
  const auto consider = [&](const Vector3& p) {
    if (const double d = estimate(p); d < least) least = d, nearest = p;
  };
  for (const Vector3& corner : corners) consider(corner);
  for (int halving = 0; halving < halvings; ++halving) {
    const Corners middle{0.5 * (corners[1] + corners[2]), 0.5 * (corners[2] + corners[0]),
                         0.5 * (corners[0] + corners[1])};
    for (const Vector3& m : middle) consider(m);
    corners = quarter_nearest_to(nearest, corners, middle);
    consider((corners[0] + corners[1] + corners[2]) / 3.0);
  }
  if (least < best.distance) best.distance = least, best.point = nearest;
}

void TargetContact::nearest(const Body& body, const Pose& target_from_body, Closest& closest) const {
  const kernel::Placement at = placement(target_from_body);
  std::array<std::pair<float, std::int32_t>, kernel::Walk::most_blocks> stack;
  std::size_t depth = 0;
  stack[depth++] = {-1e30f, body.balls().root()};
  while (depth > 0) {
    const auto [bound, index] = stack[--depth];
    if (bound >= closest.bound()) continue;
    const kernel::Block& block = body.balls().blocks()[index / 4];
    float lower[kernel::lanes], upper[kernel::lanes];
    kernel_.measure(block, image_.view(), at, lower, upper);
    std::array<std::pair<float, std::int32_t>, kernel::lanes> open;
    std::size_t count = 0;
    for (int lane = 0; lane < kernel::lanes; ++lane)
      if (const float least = lower[lane] - (block.next[lane] < 0 ? 0.0F : block.radius[lane]);
          block.half[0][lane] > kernel::no_part && least < closest.bound())
        open[count++] = {least, block.next[lane]};
    std::sort(open.begin(), open.begin() + static_cast<std::ptrdiff_t>(count), std::greater<>());
    for (std::size_t k = count; k-- > 0;)
      if (open[k].second < 0 && open[k].first < closest.bound())
        look_at(body.balls().pieces()[~open[k].second], target_from_body, closest);
    for (std::size_t k = 0; k < count; ++k)
      if (open[k].second >= 0 && open[k].first < closest.bound()) stack[depth++] = open[k];
  }
}

Nearest TargetContact::nearest(const BodyPath& path, std::size_t waypoint, const Pose& base_from_target) const {
  Closest closest;
  const Pose target_from_base = base_from_target.inverse();
  for (std::size_t body = 0; body < bodies_->size(); ++body) {
    const BodyPath::Range& near = path.near_region(body);
    if (waypoint >= near.begin && waypoint < near.end)
      nearest(bodies_->body(body), target_from_base * path.base_from_body(waypoint, body), closest);
  }
  Nearest result;
  closest.sort_by_corners(*this);
  for (std::size_t i = 0; i < looked_at; ++i)
    if (const Closest::Entry& entry = closest.entries[i]; entry.piece != nullptr)
      look_closely(*entry.piece, entry.target_from_body, result);
  if (result.distance < field_border) result.distance = field_.exact(result.point);
  result.gradient = field_.gradient(result.point);
  return result;
}

}  // namespace tactus::contact
