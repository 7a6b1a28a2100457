// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "belief/cells.hpp"
#include "support/deadline.hpp"
#include "support/rng.hpp"

namespace tactus::belief {

/// How an observation may err.
enum class Fault : std::uint8_t {
  missed = 0,    ///< the robot touched the target, and did not feel it
  imagined = 1,  ///< it felt a contact where there was none
  inside = 2     ///< it set out inside the target after a contact that it missed: no fault of this observation
};

/// A fault that an observation of the history has if a pose is the true one.
struct Doubt {
  std::uint16_t trace = 0;
  Fault fault = Fault::missed;
  bool is_certain = false;  ///< for every pose of a cell; else perhaps for some
  bool operator==(const Doubt&) const = default;
};

/// What is unlikely, in bits.
struct FaultBits {
  double missed = 0.0, imagined = 0.0;

  explicit FaultBits(const action::Sensing& sensing);
};

/// Cells of poses for a robot whose observations may err: they cover the whole prior always, and each weighs what its
/// poses explain of the history. A cell's likelihood is the product, over the observations that no pose of it can have
/// given, of how often a contact is missed, or imagined just there; an upper bound for each of its poses, so that no
/// pose ever weighs too little. Where much weight is, cells are small: they are halved until each has about the same
/// share, and joined again where it has gone. A value.
class WeighedCells {
 public:
  struct Weighed {
    Cell cell;
    std::vector<Doubt> doubts{};
    double floor = 0.0;  ///< bits that every pose of it has from the traces before `floor_of`, whichever they are
    std::uint16_t floor_of = 0;
  };

  /// The prior as one cell. As many cells as the options allow, about, will carry the weight.
  WeighedCells(const Task& task, const action::Sensing& sensing, const CellOptions& options);

  const action::Sensing& sensing() const { return sensing_; }

  /// Takes in what the history has beyond what was taken in. False if no pose can have given it at all, as where a
  /// contact was missed though none ever is.
  bool update(const Task& task, const std::vector<Trace>& history);

  const CellFrame& frame() const { return frame_; }
  const std::vector<Weighed>& all() const { return cells_; }  ///< neighbours side by side: halves follow each other
  std::vector<Cell> cells() const;                            ///< with the bits beyond those of the likeliest

  /// The traces that the likeliest explanation takes for wrong: that which most weight agrees on.
  std::vector<std::size_t> doubted() const;

  /// `count` parts of cells of at most `radius` (m) drawn by weight: cells are halved, and again and again `count` are
  /// drawn of the halves. Stops early, with coarser parts, after `latest_draw`; none if no half of those drawn is
  /// possible.
  std::vector<Weighed> draw_parts(const Task& task, const std::vector<Trace>& history, std::size_t count, double radius,
                                  support::Rng& rng,
                                  const support::Deadline& deadline = support::Deadline::unlimited()) const;

  /// The traces that are right where a cell has the truth.
  static std::vector<const Trace*> explained(const std::vector<Trace>& history, const std::vector<Doubt>& doubts);

  /// From what `all` gave after this history. False if it is not possible in any of them.
  bool restore(std::vector<Weighed> cells, const std::vector<Trace>& history);

 private:
  double bits_of(const std::vector<Trace>& history, const Weighed& weighed) const;
  void ask(const Task& task, const std::vector<Trace>& history, std::size_t trace, Weighed& weighed) const;
  std::array<Weighed, 2> halves(const Task& task, const std::vector<Trace>& history, const Weighed& whole,
                                double enough) const;
  std::optional<Cell> whole_of(const Cell& low, const Cell& high) const;
  std::optional<Weighed> joined(const std::vector<Trace>& history, const Weighed& low, const Weighed& high) const;
  double weight(const Cell& cell) const;
  double likeliest() const;
  double total() const;
  void join_lighter(const std::vector<Trace>& history, double most);
  void make_room(const std::vector<Trace>& history);
  bool may_halve(const Weighed& weighed) const;
  std::size_t halve_heavier(const Task& task, const std::vector<Trace>& history, double most_weight, std::size_t most);
  void refine(const Task& task, const std::vector<Trace>& history);

  scene::Prior prior_;
  action::Sensing sensing_;
  FaultBits bits_;
  CellFrame frame_;
  CellPrior density_;
  std::vector<int> halved_;  ///< the dimension in which a cell of so many splits is halved
  CellOptions options_;
  std::size_t wanted_;    ///< cells
  std::size_t seen_ = 0;  ///< traces
  double least_ = 0.0;    ///< bits of the likeliest cell
  std::vector<Weighed> cells_;
};

}  // namespace tactus::belief
