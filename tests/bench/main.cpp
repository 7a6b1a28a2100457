// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <iostream>

#include "bench/arguments.hpp"
#include "support/error.hpp"

namespace tactus::bench {
namespace {

void write_json(const std::string& file, const std::vector<Row>& rows) {
  if (file == "-") {
    print_json(std::cout, rows);
    return;
  }
  std::ofstream out(file);
  print_json(out, rows);
  if (!out.flush()) throw support::Error(support::Status::file_unreadable, "--json: cannot write " + file);
}

/// 0, or 1 if an answer disagrees with the baseline's.
int run(const Arguments& arguments) {
  std::ostream& table = arguments.json == "-" ? std::cerr : std::cout;
  std::vector<Row> rows;
  print_heading(table);
  for (const Work& work : arguments.works)
    for (Row& row : work.run(arguments.options)) {
      print(table, row);
      rows.push_back(std::move(row));
    }
  if (!arguments.json.empty()) write_json(arguments.json, rows);
  for (const Row& row : rows)
    if (!row.disagreements.empty()) return 1;
  return 0;
}

int main_of(const std::vector<std::string>& words) {
  try {
    const Arguments arguments = parse_arguments(words);
    if (!arguments.help) return run(arguments);
    std::cout << usage;
    return 0;
  } catch (const UsageError& error) {
    std::cerr << "tactus-bench: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "tactus-bench: " << error.what() << '\n';
    return 3;
  }
}

}  // namespace
}  // namespace tactus::bench

int main(int argc, char** argv) { return tactus::bench::main_of({argv + 1, argv + argc}); }
