#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "wearwell/bayes/draws.h"
#include "wearwell/present/section.h"
#include "wearwell/study/posterior_summary.h"
#include "wearwell/study/result.h"

namespace wearwell {

/// A fit read from a result folder, for comparison.
struct SavedResult {
  Header header = {};
  std::vector<ParameterSummary> parameters = {};
  std::optional<ModeSummary> mode = {};
  std::optional<LooSummary> loo = {};
  Draws draws = {};  ///< in the parameters' units; empty without draws
  std::vector<QuantitySummary> quantities = {};
  std::vector<html::Figure> figures = {};  ///< of its report; empty without a report
};

/// summary.json of a folder of results. Throws InputError if the folder or summary.json is missing.
std::filesystem::path summary_file(const std::filesystem::path& folder);

/// Reads summary.json, loo.csv if summary.json names it, and draws_1.csv, draws_2.csv, ... (the
/// parameters and divergences), and the figures of report.json if present. Throws InputError that
/// names the file and the missing or invalid key.
SavedResult read_saved_result(const std::filesystem::path& folder);

/// The content of a report, from report.json.
struct SavedReport {
  Header header;
  std::vector<present::Section> sections;
};
SavedReport read_saved_report(const std::filesystem::path& folder);
/// The same from the texts of summary.json and report.json.
SavedReport read_saved_report(const std::string& summary, const std::string& report);

}  // namespace wearwell
