// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "contact/kernel/sets.hpp"
#include "contact/lattice.hpp"
#include "contact/target_contact.hpp"
#include "support/bytes.hpp"

namespace tactus::contact {

/// Which cells of a lattice a motion of the tool would first touch the target at which waypoint: sets of cells, as the
/// words of a `Bitset` over them that are not zero. No cell is in two. A value.
class FirstContacts {
 public:
  /// Of the cells in `possible`, how many are first touched at each waypoint; at the end, how many never. O(words
  /// held).
  std::vector<std::size_t> split(const Bitset& possible) const;

  /// What is left of `possible` once the motion was stopped by its first contact at `waypoint`, and once it was not.
  Bitset after_contact(const Bitset& possible, std::size_t waypoint) const;
  Bitset after_none(const Bitset& possible) const;

  std::size_t waypoints() const { return touched_.size(); }

  /// Calls `visit(word, cells)` for every word with cells that are touched at any waypoint; a word may come again, with
  /// other cells.
  template <typename Visit>
  void for_each_touched(Visit&& visit) const {
    for (const Words& words : touched_)
      for (std::size_t i = 0; i < words.filled; ++i) visit(words.word[i], words.cells[i]);
  }

 private:
  friend class ContactTables;
  struct Words {
    std::vector<std::uint32_t> word;
    std::vector<std::uint64_t> cells;  ///< of that word
    std::size_t filled = 0;            ///< behind them there may be room

    void add(std::size_t first, std::size_t step, const std::vector<std::uint64_t>& added, std::size_t count);
    void trim();
  };
  explicit FirstContacts(std::size_t waypoints) : touched_(waypoints) {}
  std::vector<Words> touched_;  ///< by waypoint
};

/// First contacts of a tool that moves on a lattice, without its links, from tables of the offsets at which tool and
/// target touch. A table is made from the general path when it is first asked for, one for each way in which the tool
/// stands, each turn of the target and each offset in z, and kept while there is room. Any number of threads.
///
/// For cells that stand for every pose within a radius r of theirs (no point of the target farther than r from where it
/// is at the cell's), tables with the thresholds margin + r and -r give the interval of first contacts: the former
/// never too late, the latter never too early (as `TargetContact::first_contact_interval`).
class ContactTables {
 public:
  /// `contact` must outlive the tables. Where more than `most_bytes` would be kept, all tables are dropped first.
  ContactTables(const TargetContact& contact, Lattice lattice, std::size_t most_bytes = std::size_t{512} << 20)
      : ContactTables(contact, std::move(lattice), contact.margin(), most_bytes) {}

  /// `threshold` (m): of the tool, inflated by it if positive, deflated if negative.
  ContactTables(const TargetContact& contact, Lattice lattice, double threshold, std::size_t most_bytes);

  const Lattice& lattice() const { return lattice_; }

  /// The first waypoint does not count. Once the tables are there: O(waypoints * rows near the motion).
  FirstContacts first_contacts(const LatticeMotion& motion) const;

  std::size_t bytes() const;  ///< of the tables kept

  /// The tables kept, as bytes; and taken in again. Throws `bad_saved_state`, and `wrong_scenario` if they were made
  /// for other shapes, another margin or another lattice.
  std::vector<std::uint8_t> save() const;
  void restore(const std::uint8_t* bytes, std::size_t size) const;

 private:
  /// Offsets target - tool at one z: a bit each, in words along x. A word's rows (along y) stand side by side. Before
  /// and behind the words are some of zeros, so that 64 bits may begin anywhere.
  struct Table {
    std::array<int, 2> low{}, count{};
    std::vector<std::uint64_t> words;

    std::size_t columns() const { return (static_cast<std::size_t>(count[0]) + 63) / 64 + 2; }
    void fill(int x, int y, int size_x, int size_y);
    const std::uint64_t* column(int x) const;
  };
  using TablePtr = std::shared_ptr<const Table>;
  using Key = std::array<int, 3>;  ///< way in which the tool stands, turn of the target, offset in z

  TablePtr table(const Key& key) const;
  class Along;
  struct Layer;
  void take_touched(const Table& table, const std::array<int, 3>& tool, Layer& layer,
                    FirstContacts::Words& touched) const;
  Table blank(const Key& key) const;
  Table make(const Key& key) const;
  void check(const support::ByteReader& in, const Key& key, const Table& table) const;
  void decide(const Key& key, int x, int y, int size_x, int size_y, Table& table) const;
  std::array<std::array<int, 3>, 2> offsets(int way, int target_turn) const;
  std::uint64_t fingerprint() const;

  const TargetContact& contact_;
  Lattice lattice_;
  double threshold_;
  std::size_t most_bytes_;
  const kernel::SetKernel& kernel_ = kernel::fastest_set_kernel();
  mutable std::mutex mutex_;
  mutable std::map<Key, TablePtr> tables_;
  mutable std::size_t bytes_ = 0;
};

}  // namespace tactus::contact
