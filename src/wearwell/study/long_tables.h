#pragma once

#include <filesystem>
#include <string>

#include "wearwell/study/posterior_summary.h"

/// Tables with a row for each observation. Tables of up to `most_rows_inline` rows are in
/// summary.json; longer ones are separate files that summary.json names.
namespace wearwell {

inline constexpr std::size_t most_rows_inline = 2000;

inline constexpr const char* loo_table_file = "loo.csv";
inline constexpr const char* coverage_table_file = "coverage.csv";
inline constexpr const char* pointwise_table_file = "pointwise.csv";

/// The tables of a result that are too long for summary.json: file name and content.
std::vector<std::pair<std::string, std::string>> long_tables(const PosteriorSummary& result);

/// The caption of a long table in the report: "WHAT: 2000 of 1000000, WHICH; all are in FILE".
std::string shown_caption(const std::string& what, std::size_t rows, const char* which,
                          const char* file);

/// The `most_rows_inline` least probable terms, in order.
std::vector<std::size_t> shown_terms(const std::vector<LooTerm>& terms);

/// " among 500 of 100000 tests, evenly chosen,"; empty if the table has all tests.
std::string chosen_tests(const CoverageTable& table);

/// Reads the files that `long_tables` writes into a folder. Throws InputError naming file, row and
/// column.
std::vector<LooTerm> read_loo_table(const std::filesystem::path& folder);

}  // namespace wearwell
