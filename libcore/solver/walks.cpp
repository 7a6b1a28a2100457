// SPDX-License-Identifier: BSD-3-Clause
#include "solver/walks.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <queue>
#include <unordered_set>

#include "action/task.hpp"

namespace tactus::solver {
namespace {

using action::Lattice;
using action::MotionPtr;
using geometry::Pose;
using geometry::Vector3;
using support::Bitset;

constexpr double blocked = 1e300;
constexpr double near_by = 0.08;        // m to the nearest place, which a walk may begin at then
constexpr int longest_walk = 160;       // steps after the first that touches something
constexpr double least_missing = 0.02;  // share of the poses for which a walk does not go on
constexpr double farther = 2.0;         // than it is on average is it to those that a beam touches late
constexpr double given_up = 2.0;        // m that it is worth to walk rather than leave a pose untouched

std::size_t count_without(const Bitset& set, const Bitset& other) {
  std::size_t count = 0;
  for (std::size_t w = 0; w < set.words().size(); ++w)
    count += static_cast<std::size_t>(std::popcount(set.words()[w] & ~other.words()[w]));
  return count;
}

/// The place nearest to a position, of those that count, if it is nearer than `reach`.
template <typename Counts>
std::optional<std::size_t> nearest_place(const Lattice& lattice, const Vector3& position, double reach,
                                         const Counts& counts) {
  std::optional<std::size_t> nearest;
  for (std::size_t place = 0; place < lattice.size(); ++place) {
    if (!counts(place)) continue;
    const double distance = (lattice.base_from_tool(place).translation() - position).norm();
    if (distance < reach) reach = distance, nearest = place;
  }
  return nearest;
}

}  // namespace

Walks::Walks(std::shared_ptr<const action::Task> task, std::shared_ptr<const Lattice> lattice, Predictions& predictions)
    : task_(std::move(task)),
      lattice_(std::move(lattice)),
      predictions_(predictions),
      steps_(lattice_->size() * Lattice::directions) {}

/// What a way costs that is gone in the longest small moves.
double Walks::with_actions(double way) const {
  const action::TaskOptions& options = task_->options();
  const std::vector<double>& lengths = options.actions.primitive_lengths;
  const double longest = lengths.empty() ? 0.0 : options.cost.metre * *std::max_element(lengths.begin(), lengths.end());
  return longest > 0.0 ? way * (1.0 + options.cost.action / longest) : way;
}

const Walks::Step& Walks::step(std::size_t place, std::size_t direction) const {
  std::optional<Step>& kept = steps_[place * Lattice::directions + direction];
  if (!kept) kept = made_step(place, direction);
  return *kept;
}

/// On the retreat plane no way is looked for, and nothing touched.
Walks::Step Walks::made_step(std::size_t place, std::size_t direction) const {
  Step made{0, blocked, Bitset(predictions_.poses().size())};
  const auto next = lattice_->neighbour(place, direction);
  if (!next) return made;
  made.to = *next;
  if (lattice_->is_on_plane(place) && lattice_->is_on_plane(*next)) {
    made.cost = with_actions(task_->options().cost.metre * lattice_->pitch());
    return made;
  }
  const MotionPtr motion = lattice_->step(place, direction, predictions_.cancellation());
  if (!motion) return made;
  made.cost = with_actions(motion->cost_to.back());
  const std::vector<std::int32_t>& first_contacts = predictions_.first_contacts(motion);
  for (std::size_t pose = 0; pose < first_contacts.size(); ++pose)
    if (first_contacts[pose] < static_cast<std::int32_t>(motion->path.size())) made.touched.set(pose);
  return made;
}

double Walks::entry_cost(const Pose& base_from_tool, std::size_t place) const {
  const Pose& there = lattice_->base_from_tool(place);
  if (lattice_->is_on_plane(place)) return with_actions(action::transit_cost(*task_, base_from_tool, there));
  const double distance = (there.translation() - base_from_tool.translation()).norm();
  const action::CostWeights& weights = task_->options().cost;
  return distance < near_by ? weights.metre * distance + weights.radian * geometry::angle_between(base_from_tool, there)
                            : blocked;
}

std::vector<MotionPtr> Walks::steps_from(const robot::JointVector& q, std::size_t first) const {
  const auto any = [](std::size_t) { return true; };
  const auto here = nearest_place(*lattice_, task_->base_from_tool(q).translation(), Lattice::same_place, any);
  std::vector<MotionPtr> steps;
  for (std::size_t i = 0; here && i < Lattice::directions; ++i) {
    const auto next = lattice_->neighbour(*here, (first + i) % Lattice::directions);
    if (!next) continue;
    auto path = task_->straight_path(q, lattice_->base_from_tool(*next), task_->options().motion.step,
                                     predictions_.cancellation());
    if (!path || path->size() < 2) continue;
    action::Motion step;
    step.path = std::move(*path);
    steps.push_back(action::finished(*task_, std::move(step)));
  }
  return steps;
}

/// A beam search: of the ways of so many steps those are followed that have spent the least and have the least left.
class Walks::Beam {
 public:
  Beam(const Walks& walks, const Bitset& members, std::size_t width)
      : walks_(walks), members_(members), count_(members.count()), total_(static_cast<double>(count_)), width_(width) {}

  /// May be cut short: there is something then too.
  void search(const Pose& base_from_tool) {
    enter(base_from_tool);
    go_where_nothing_is_touched();
    current_.resize(stands_.size());
    for (std::size_t i = 0; i < stands_.size(); ++i) current_[i] = i;
    for (int length = 0; length < longest_walk && !current_.empty(); ++length) go_on();
  }

  Walk found() {
    if (best_ == none) give_up();
    return walk_to(best_);
  }

 private:
  static constexpr std::size_t none = SIZE_MAX;
  struct Stand {
    std::size_t place = 0, direction = 0;  ///< where it is, and how it came there
    std::size_t before = none;             ///< the stand that it came from
    std::size_t count = 0;                 ///< of the poses not touched so far
    double spent = 0.0;                    ///< if nothing was touched
    double expected = 0.0;                 ///< until something was touched, or up to here
    Bitset left{};                         ///< the poses not touched so far
  };

  /// Over the retreat plane to any place on it; where the tool is past it, also to the place next to it.
  void enter(const Pose& base_from_tool) {
    const Lattice& lattice = *walks_.lattice_;
    const auto past_plane = [&](std::size_t place) { return !lattice.is_on_plane(place); };
    const auto enter_at = [&](std::size_t place) {
      untouched(place, none, 0, walks_.entry_cost(base_from_tool, place));
    };
    for (std::size_t place = 0; lattice.is_on_plane(place); ++place) enter_at(place);
    if (const auto place = nearest_place(lattice, base_from_tool.translation(), near_by, past_plane)) enter_at(*place);
  }

  void untouched(std::size_t place, std::size_t before, std::size_t direction, double spent) {
    stands_.push_back({place, direction, before, count_, spent, spent, members_});
  }

  /// To each place by the cheapest way on which nothing is touched: only what they cost tells such ways apart, and a
  /// beam of them would stay about where it is.
  void go_where_nothing_is_touched() {
    using Reached = std::pair<double, std::size_t>;  // what was spent, and the stand
    std::vector<std::size_t> at(walks_.lattice_->size(), none);
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
    for (std::size_t i = 0; i < stands_.size(); ++i) {
      at[stands_[i].place] = i;
      open.emplace(stands_[i].spent, i);
    }
    for (double enough = blocked; !open.empty() && open.top().first < enough;) {
      const auto [spent, from] = open.top();
      open.pop();
      if (spent > stands_[from].spent) continue;
      for (std::size_t direction = 0; direction < Lattice::directions; ++direction) {
        const Step& taken = walks_.step(stands_[from].place, direction);
        if (taken.cost >= blocked) continue;
        if (count_without(members_, taken.touched) < count_) {
          enough = std::min(enough, spent + walks_.to_go_);
          continue;
        }
        const double then = spent + taken.cost;
        std::size_t& there = at[taken.to];
        if (there == none) {
          there = stands_.size();
          untouched(taken.to, from, direction, then);
        } else if (then < stands_[there].spent) {
          stands_[there].before = from;
          stands_[there].direction = direction;
          stands_[there].spent = stands_[there].expected = then;
        } else {
          continue;
        }
        open.emplace(then, there);
      }
    }
  }

  /// What a way has cost so far, and may cost still: the fewer are left, the less of it is about them.
  double promise(const Stand& stand) const {
    const double missing = static_cast<double>(stand.count) / total_;
    return stand.expected + farther * walks_.to_go_ * missing * missing * total_ / static_cast<double>(members_.size());
  }

  /// One more step. Who stands where somebody stood before it, and has touched the same, does not go on.
  void go_on() {
    walks_.predictions_.cancellation().check();
    std::vector<Stand> next = steps_on();
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < next.size(); ++i) order.emplace_back(promise(next[i]), i);
    std::sort(order.begin(), order.end());
    current_.clear();
    for (const auto& [value, i] : order) {
      if (current_.size() >= width_ || value >= least_) break;
      Stand& stand = next[i];
      const Stand& from = stands_[stand.before];
      stand.left = from.left;
      if (stand.count < from.count) stand.left.and_not(walks_.step(from.place, stand.direction).touched);
      if (!been_.insert(stand.left.hash(stand.place).low).second) continue;
      const bool is_done = static_cast<double>(stand.count) <= least_missing * total_;
      if (is_done)
        least_ = value, best_ = stands_.size();
      else
        current_.push_back(stands_.size());
      stands_.push_back(std::move(stand));
    }
  }

  std::vector<Stand> steps_on() const {
    std::vector<Stand> next;
    for (const std::size_t at : current_) {
      const Stand& from = stands_[at];
      for (std::size_t direction = 0; direction < Lattice::directions; ++direction) {
        const Step& taken = walks_.step(from.place, direction);
        if (taken.cost >= blocked) continue;
        Stand to{taken.to, direction, at};
        to.count = count_without(from.left, taken.touched);
        if (to.count == count_) continue;
        to.spent = from.spent + taken.cost;
        to.expected = from.expected + taken.cost * 0.5 * static_cast<double>(from.count + to.count) / total_;
        if (to.expected < least_) next.push_back(std::move(to));
      }
    }
    return next;
  }

  /// What is left can't be walked to, or there is no time to find out how.
  void give_up() {
    for (std::size_t i = 0; i < stands_.size(); ++i) {
      const double value = stands_[i].expected + given_up * static_cast<double>(stands_[i].count) / total_;
      if (value < least_) least_ = value, best_ = i;
    }
  }

  Walk walk_to(std::size_t last) const {
    Walk walk;
    for (; stands_[last].before != none; last = stands_[last].before)
      walk.steps.emplace_back(stands_[stands_[last].before].place, stands_[last].direction);
    walk.entry = stands_[last].spent;
    std::reverse(walk.steps.begin(), walk.steps.end());
    return walk;
  }

  const Walks& walks_;
  const Bitset& members_;
  std::size_t count_;
  double total_;  ///< the same
  std::size_t width_;
  std::vector<Stand> stands_;
  std::vector<std::size_t> current_;
  std::unordered_set<std::uint64_t> been_;  ///< places, and what was left there
  std::size_t best_ = none;
  double least_ = 1e300;
};

Walk Walks::best(const Bitset& members, const Pose& base_from_tool, std::size_t beam) const {
  Beam search(*this, members, beam);
  search.search(base_from_tool);
  return search.found();
}

Walk Walks::best_in_time(const Bitset& members, const Pose& base_from_tool, std::size_t beam) const {
  Beam search(*this, members, beam);
  try {
    search.search(base_from_tool);
  } catch (const support::OutOfTime&) {
  }
  return search.found();
}

std::optional<Walk> Walks::rest(const Walk& walk, const Pose& base_from_tool) const {
  Walk rest{blocked, {}};
  for (auto from = walk.steps.begin(); from != walk.steps.end(); ++from) {
    const double entry = entry_cost(base_from_tool, from->first);
    if (entry < blocked && entry <= rest.entry) rest = {entry, {from, walk.steps.end()}};
  }
  return rest.entry < blocked ? std::optional(rest) : std::nullopt;
}

void Walks::look_ahead_as_on(const Walk& walk) {
  double length = 0.0, found = 0.0;
  Bitset left(predictions_.poses().size(), true);
  for (const auto& [place, direction] : walk.steps) {
    const std::size_t before = left.count();
    left.and_not(step(place, direction).touched);
    length += step(place, direction).cost;
    found += static_cast<double>(before - left.count()) * length;
  }
  const std::size_t count = left.size() - left.count();
  if (count > 0) to_go_ = found / static_cast<double>(count);
}

}  // namespace tactus::solver
