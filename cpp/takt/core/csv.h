// Tables in CSV files. Not for the cycle.
//
// A line with the names of the columns, in any order; then a line for each row. Between the columns stands a comma, a
// semicolon or a tabulator; without commas between the columns, numbers may have a decimal comma. Empty lines and those
// that begin with # are skipped.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "takt/core/problem.h"

namespace takt {

struct CsvFormat {
  std::vector<std::string_view> required;  // columns that must be there ...
  std::vector<std::string_view> optional;  // ... and that may
  std::size_t most = 0;                    // rows
  std::string_view most_text;              // the same for people: "100,000 points"
  std::string_view hint = {};              // what to do about other columns, for people
};

struct CsvCell {
  std::string_view text;  // without blanks around it; empty, too, where there is no such column
  Place place;
  bool decimal_comma = false;  // a number may have one
};

// Calls `take` for each row with a cell for each required column, then each optional one. What is wrong, `take`'s
// findings included, goes to `problems`.
void ReadCsvTable(std::string_view text, const CsvFormat& format, ProblemList& problems,
                  const std::function<void(std::span<const CsvCell>)>& take);

// The number in a cell. False, and problems gets it, if there is none.
bool ReadCsvNumber(const CsvCell& cell, std::string_view column, ProblemList& problems, double& value);

}  // namespace takt
