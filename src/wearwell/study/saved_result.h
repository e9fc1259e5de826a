#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "wearwell/bayes/draws.h"
#include "wearwell/present/section.h"
#include "wearwell/study/posterior_summary.h"
#include "wearwell/study/result.h"

namespace wearwell {

/// What a result folder tells of a fit, to be compared with others.
struct SavedResult {
  Header header = {};
  std::vector<ParameterSummary> parameters = {};
  std::optional<ModeSummary> mode = {};
  std::optional<LooSummary> loo = {};
  Draws draws = {};  ///< in the parameters' units; none where the fit drew none
  std::vector<QuantitySummary> quantities = {};
  std::vector<html::Figure> figures = {};  ///< of its report; none where it has none
};

/// summary.json of a folder of results. Throws InputError where it holds none, or is no folder.
std::filesystem::path summary_file(const std::filesystem::path& folder);

/// Reads summary.json, loo.csv where that names it, and draws_1.csv, draws_2.csv, ...: the parameters
/// and which draws were divergent; and the figures of report.json, where there is one. Throws InputError naming the file and key that is missing or is
/// not what wearwell writes.
SavedResult read_saved_result(const std::filesystem::path& folder);

/// What a report is made of, as report.json keeps it.
struct SavedReport {
  Header header;
  std::vector<present::Section> sections;
};
SavedReport read_saved_report(const std::filesystem::path& folder);
/// Of the texts of summary.json and report.json.
SavedReport read_saved_report(const std::string& summary, const std::string& report);

}  // namespace wearwell
