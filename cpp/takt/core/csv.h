// Tables in CSV files. Not for use within the cycle.
//
// A line with the names of the columns, in any order, then a line for each row. Columns are separated by commas,
// semicolons or tabs; unless commas separate them, numbers may have a decimal comma. Empty lines and lines that begin
// with # are skipped.
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
  std::vector<std::string_view> required;  // columns that must be present ...
  std::vector<std::string_view> optional;  // ... and that may be present
  std::size_t most = 0;                    // maximum number of rows
  std::string_view most_text;              // the same in words: "100,000 points"
  std::string_view hint = {};              // advice about other columns, for messages
};

struct CsvCell {
  std::string_view text;  // without surrounding blanks; also empty if there is no such column
  Place place;
  bool decimal_comma = false;  // the number may have a decimal comma
};

// Calls `take` for each row with a cell for each required column, then each optional one. All problems, including those
// that `take` finds, are added to `problems`.
void ReadCsvTable(std::string_view text, const CsvFormat& format, ProblemList& problems,
                  const std::function<void(std::span<const CsvCell>)>& take);

// Reads the number in a cell. Returns false, and adds a problem, if there is none.
bool ReadCsvNumber(const CsvCell& cell, std::string_view column, ProblemList& problems, double& value);

}  // namespace takt
