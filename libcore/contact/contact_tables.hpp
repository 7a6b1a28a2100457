// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "contact/lattice.hpp"
#include "contact/target_contact.hpp"
#include "support/bytes.hpp"

namespace tactus::contact {

/// Which cells of a lattice a motion of the tool would first touch the target at which waypoint: sets of cells, as the
/// words of a `Bitset` over them that are not zero. No cell is in two.
class FirstContacts {
 public:
  /// Of the cells in `possible`, how many are first touched at each waypoint; at the end, how many never. O(words
  /// held).
  std::vector<std::size_t> split(const Bitset& possible) const;

  /// What is left of `possible` once the motion was stopped by its first contact at `waypoint`, and once it was not.
  Bitset after_contact(const Bitset& possible, std::size_t waypoint) const;
  Bitset after_none(const Bitset& possible) const;

  std::size_t waypoints() const { return begin_.size() - 1; }

 private:
  friend class ContactTables;
  std::vector<std::uint32_t> word_;   ///< by waypoint
  std::vector<std::uint64_t> cells_;  ///< of that word
  std::vector<std::size_t> begin_{0};
};

/// First contacts of a tool that moves on a lattice, without its links, from tables of the offsets at which tool and
/// target touch. A table is made from the general path when it is first asked for, one for each pair of turns and each
/// offset in z, and kept while there is room. Any number of threads.
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
  void restore(const std::uint8_t* bytes, std::size_t size);

 private:
  /// Offsets target - tool at one z, for one pair of turns: a bit each, rows of x.
  struct Table {
    std::array<int, 2> low{}, count{};
    std::vector<std::uint64_t> words;  ///< a row has one more than it needs, so that windows may begin anywhere

    std::size_t row_words() const { return static_cast<std::size_t>(count[0]) / 64 + 2; }
    void fill(int x, int y, int size_x, int size_y);
    std::uint64_t window(std::size_t row, int x) const;
  };
  using TablePtr = std::shared_ptr<const Table>;
  using Key = std::array<int, 3>;  ///< turn of the tool, turn of the target, offset in z

  TablePtr table(const Key& key) const;
  class Along;
  using Touched = std::vector<std::pair<std::uint32_t, std::uint64_t>>;  ///< words of a set of cells, and the members
  void take_touched(const Table& table, const LatticePose& tool, std::size_t first_word,
                    std::vector<std::uint64_t>& left, Touched& touched) const;
  Table blank(const Key& key) const;
  Table make(const Key& key) const;
  void check(const support::ByteReader& in, const Key& key, const Table& table) const;
  void decide(const Key& key, int x, int y, int size_x, int size_y, Table& table) const;
  std::array<std::array<int, 3>, 2> offsets(int tool_turn, int target_turn) const;
  std::uint64_t fingerprint() const;

  const TargetContact& contact_;
  Lattice lattice_;
  double threshold_;
  std::size_t most_bytes_;
  mutable std::mutex mutex_;
  mutable std::map<Key, TablePtr> tables_;
  mutable std::size_t bytes_ = 0;
};

}  // namespace tactus::contact
