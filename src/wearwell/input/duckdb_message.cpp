#include "wearwell/input/duckdb_message.h"

#include <fmt/format.h>

#include <boost/algorithm/string/predicate.hpp>
#include <regex>
#include <sstream>
#include <vector>

namespace wearwell {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  // Standard regular expressions recurse once per character, so long lines are cut.
  for (std::string line; std::getline(stream, line);) lines.push_back(line.substr(0, 2000));
  return lines;
}

/// Removes error classes such as "Binder Error: ".
std::string without_class(std::string text) {
  static const std::regex kind(R"(^([A-Z][A-Za-z/-]*( [A-Za-z/-]+){0,4}) (Error|Exception): )");
  std::smatch found;
  while (std::regex_search(text, found, kind)) text = found.suffix();
  return text;
}

/// Builds a sentence from "CSV Error on Line: 7", "Original Line: ..." and the cause.
std::string csv_sentence(const std::vector<std::string>& lines, const std::string& number) {
  std::string cause;
  for (std::size_t i = 1; i < lines.size() && cause.empty(); ++i) {
    if (!lines[i].empty() && !lines[i].starts_with("Original Line:")) cause = lines[i];
  }
  static const std::regex counts(R"(Expected Number of Columns: (\d+) Found: (\d+))");
  static const std::regex conversion(
      R"re(Error when converting column "(.*)"\. Could not convert string "(.*)" to '(.*)')re");
  std::smatch found;
  if (std::regex_search(cause, found, counts)) {
    cause = fmt::format("{} values where the heading has {}", found[2].str(), found[1].str());
  } else if (std::regex_search(cause, found, conversion)) {
    const std::string type = found[3].str();
    cause = fmt::format("'{}' in column '{}' is not a {}, unlike the cells above it",
                        found[2].str(), found[1].str(),
                        type == "BIGINT"   ? "whole number"
                        : type == "DOUBLE" ? "number"
                                           : type);
  }
  return fmt::format("line {}: {}", number, cause);
}

}  // namespace

std::string duckdb_sentence(const std::string& message) {
  const std::vector<std::string> lines = lines_of(message);
  if (lines.empty()) return "an unknown error";
  std::string first = without_class(lines.front());
  static const std::regex csv_line(R"(CSV Error on Line: (\d+))");
  static const std::regex access(R"re(Cannot access (?:file|directory) "(.*)" - )re");
  static const std::regex no_table(R"(Table with name (.*) does not exist!)");
  static const std::regex extension(R"re(with name "(.*)" is not in the catalog, but it exists)re");
  std::smatch found;
  if (first.starts_with("Error when sniffing file"))
    return "it cannot be read as a table: each line needs as many values as the heading, separated "
           "alike";
  if (std::regex_search(first, found, csv_line)) return csv_sentence(lines, found[1].str());
  if (std::regex_search(first, found, access))
    return fmt::format("it may read only the data file, not '{}'", found[1].str());
  if (std::regex_search(first, found, no_table))
    return fmt::format("there is no table '{}'; the file is the table 'data'", found[1].str());
  if (std::regex_search(first, found, extension))
    return fmt::format("there is no function '{}'; SQL extensions are disabled", found[1].str());
  return first;
}

}  // namespace wearwell
