#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/infer/check.h"
#include "wearwell/present/section.h"
#include "wearwell/present/terminal_style.h"

namespace wearwell {

struct PosteriorSummary;

/// Increases when a key of summary.json is removed or changes its meaning.
inline constexpr int summary_schema = 1;

/// The common beginning of summary.json for all models.
struct Header {
  std::string version = {};  ///< of wearwell
  int schema = summary_schema;
  std::string title = {}, model = {}, equation = {};
  struct Data {
    std::vector<std::string> files = {};  ///< the names in the study
    std::size_t rows = 0;                 ///< of the data
    std::string fingerprint = {};         ///< of the observed values: equal for the same data
    /// Remarks on how the tables were read: "2 hidden rows read like the others (rows 5, 9)".
    std::vector<std::string> remarks = {};

    std::string names() const;  ///< "a.csv, b.csv"
  } data = {};
  std::uint64_t seed = 0;
  bool trusted = true;  ///< no check failed
  std::vector<Check> checks = {};
};

/// The result of a study. summary.json, the report, its tables and the terminal output are views of
/// it.
struct Result {
  Header header;
  nlohmann::ordered_json body = {};             ///< of summary.json, after the header
  std::vector<present::Section> sections = {};  ///< of the report; empty if no report is requested
  /// Other files of the result folder: name and content.
  std::vector<std::pair<std::string, std::string>> files = {};
  /// For a terminal; ends with a newline. If empty, the tables of the sections are shown.
  std::function<std::string(const TerminalStyle&)> text = {};
  std::shared_ptr<const PosteriorSummary> posterior = {};  ///< of a study with a posterior
};

/// summary.json.
nlohmann::ordered_json summary_json(const Result& result);

/// The result as readable text, ending with a newline.
std::string terminal_text(const Result& result, const TerminalStyle& style);

/// report.html.
std::string report_html(const Header& header, const std::vector<present::Section>& sections);

}  // namespace wearwell
