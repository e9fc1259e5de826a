#pragma once

#include <filesystem>
#include <string>

#include "wearwell/study/posterior_summary.h"

/// Tables with a row for each observation. Up to `most_rows_inline` rows they stand in summary.json;
/// longer ones stand beside it, and summary.json names the file.
namespace wearwell {

inline constexpr std::size_t most_rows_inline = 2000;

inline constexpr const char* loo_table_file = "loo.csv";
inline constexpr const char* coverage_table_file = "coverage.csv";
inline constexpr const char* pointwise_table_file = "pointwise.csv";

/// The tables of a result that are too long for summary.json: name of the file and content.
std::vector<std::pair<std::string, std::string>> long_tables(const PosteriorSummary& result);

/// What a table of so many rows shows in the report: "WHAT: 2000 of 1000000, WHICH; all are in FILE".
std::string shown_caption(const std::string& what, std::size_t rows, const char* which,
                          const char* file);

/// Of very many terms the `most_rows_inline` least probable, in order.
std::vector<std::size_t> shown_terms(const std::vector<LooTerm>& terms);

/// " among 500 of 100000 tests, evenly chosen,"; empty where the table has all of them.
std::string chosen_tests(const CoverageTable& table);

/// Reads what `long_tables` wrote into a folder. Throws InputError naming file, row and column.
std::vector<LooTerm> read_loo_table(const std::filesystem::path& folder);

}  // namespace wearwell
