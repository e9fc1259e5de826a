#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/plan/test_study.h"

namespace wearwell::plan {

/// A test that could be done next.
struct Candidate {
  std::string name;     ///< of its table, or its conditions: "alternating_stress 250 MPa"
  std::size_t row = 0;  ///< of `Candidates::conditions`
  std::optional<double> stop = {};  ///< unit of the measured column
  int specimens = 1;
  std::string unit = {};            ///< that the study has and the test is of; empty: a new one
  std::optional<double> cost = {};  ///< of all its specimens
  std::vector<std::string> outside = {};  ///< conditions beyond the tested range, as clauses
};

struct Candidates {
  std::string source;  ///< file, or "--grid"
  Table conditions;    ///< headings of `TestStudy::conditions`, units of the study's table
  std::vector<Candidate> all;
  std::string currency = {};  ///< of costs, from the heading "cost [EUR]"; may be empty
  std::vector<std::string> notes = {};
};

/// The column with exactly this heading, which the table has.
const Column& condition_column(const Table& conditions, const std::string& heading);

/// A number of the unit of a table as text: "400000 cycles" for 4 of "1e5 cycles".
std::string with_plain_unit(double value, const std::string& unit);
/// The factor before a unit, and the rest: 1e5 and "cycles".
std::pair<double, std::string> plain_unit(const std::string& unit);

/// Columns of a table of candidates, beside conditions and the cost.
inline constexpr const char* specimens_column = "specimens";
inline constexpr const char* stop_column = "stop";
inline constexpr const char* name_column = "name";

/// Reads candidates: a column for each condition of the study (by its heading, or its name with a
/// unit; a label whose effects vary may be left out, or its cell empty, for a new level), and optionally specimens, stop, name, and the column `cost`. `specimens` multiplies the
/// rows that do not have the column. Throws InputError that names row and column: columns that are
/// missing or unknown, cells that are empty, not numbers, or not allowed, labels that the study
/// does not know, equal candidates.
Candidates read_candidates(const TestStudy& study, const Table& table,
                           const std::optional<std::string>& cost,
                           const std::vector<int>& specimens = {1});

/// The table of a grid: "alternating_stress_MPa = 200 to 500 by 25; stop = 1e6, 5e6 cycles". Values
/// are a list, "A to B by STEP" or "A to B in COUNT"; a unit after the last number is that of the
/// column. Throws InputError.
Table grid_table(const std::string& text);

/// "1, 3, 5": numbers of specimens. Throws InputError that begins with the option.
std::vector<int> specimen_counts(const std::string& text);

}  // namespace wearwell::plan
