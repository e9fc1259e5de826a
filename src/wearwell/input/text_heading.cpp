#include "wearwell/input/text_heading.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <map>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/trimmed.h"
#include "wearwell/input/equal_names.h"
#include "wearwell/input/number_text.h"
#include "wearwell/input/text_records.h"

namespace wearwell {
namespace {

constexpr std::size_t sampled_records = 1000;
constexpr std::size_t farthest_heading = 200;  // maximum number of records before the heading

// In the order of trial.
constexpr char delimiters[] = {'\t', ';', '|', ','};

struct Record {
  std::vector<std::string> cells;
  std::size_t line = 0;
};

bool has_number(const Record& record) {
  return std::any_of(record.cells.begin(), record.cells.end(), [](const std::string& cell) {
    return number_form(cell).kind == NumberForm::Kind::number;
  });
}

/// The number of values in a record without trailing empty ones.
std::size_t filled(const Record& record) {
  std::size_t count = record.cells.size();
  while (count > 0 && record.cells[count - 1].empty()) --count;
  return count;
}

/// Whether every value is a word, as in headings but not in rows of data.
bool looks_like_heading(const Record& record) {
  return !has_number(record) && std::none_of(record.cells.begin(), record.cells.end(),
                                             [](const std::string& cell) { return cell.empty(); });
}

/// Whether most values are words; of merged headings only the first is not empty.
bool looks_like_merged_heading(const Record& record) {
  const auto words = std::count_if(record.cells.begin(), record.cells.end(),
                                   [](const std::string& cell) { return !cell.empty(); });
  return !has_number(record) && 2 * static_cast<std::size_t>(words) > record.cells.size();
}

/// One way to split the text into cells.
struct Cut {
  char delimiter = ',';
  std::vector<Record> records;
  std::size_t heading = 0;  ///< index of the heading record
  bool even = false;        ///< all records from the heading on have equally many values
};

std::vector<Record> sample(const TableFile& file, Encoding encoding, const TableSettings& settings,
                           char delimiter) {
  TextLines lines(file.path(), file.source(), encoding);
  TextRecords records(lines, delimiter, settings.comment.value_or(""),
                      settings.header_row.value_or(1));
  std::vector<Record> sampled;
  while (sampled.size() < sampled_records) {
    try {
      if (!records.next()) break;
    } catch (const OpenQuote&) {
      break;  // an unclosed quote is reported later, when the delimiter is known
    }
    sampled.push_back({{}, records.line()});
    for (const std::string_view cell : records.cells())
      sampled.back().cells.emplace_back(trimmed(cell));
  }
  return sampled;
}

/// The most frequent number of values in a record.
std::size_t usual_count(const std::vector<Record>& records) {
  std::map<std::size_t, std::size_t> seen;
  for (const Record& record : records) ++seen[record.cells.size()];
  // Ties go to the larger number, because text above a table has fewer values than its lines.
  return std::max_element(seen.rbegin(), seen.rend(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

/// The first record with words where those below have values, if the records above it cannot belong
/// to the table; else the first record.
std::size_t find_heading(const std::vector<Record>& records, std::size_t count) {
  if (count < 2) return 0;
  for (std::size_t i = 0; i < std::min(records.size(), farthest_heading); ++i) {
    const Record& record = records[i];
    if (record.cells.size() == count && looks_like_heading(record)) {
      if (i == 0) return 0;
      const bool numbers_below = std::any_of(records.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                             records.end(), has_number);
      return numbers_below ? i : 0;
    }
    if (i > 0 && record.cells.size() == count && looks_like_merged_heading(record) &&
        i + 1 < records.size() && has_number(records[i + 1]))
      return i;
    if (filled(record) == count) return 0;  // a row of data above any heading
  }
  return 0;
}

Cut cut_by(char delimiter, const TableFile& file, const TableSettings& settings,
           Encoding encoding) {
  Cut cut{delimiter, sample(file, encoding, settings, delimiter)};
  if (cut.records.empty()) return cut;
  if (!settings.header_row) cut.heading = find_heading(cut.records, usual_count(cut.records));
  const std::size_t count = cut.records[cut.heading].cells.size();
  cut.even =
      count > 1 && std::all_of(cut.records.begin() + static_cast<std::ptrdiff_t>(cut.heading),
                               cut.records.end(), [&](const Record& record) {
                                 return record.cells.size() == count ||
                                        (record.cells.size() > count && filled(record) <= count);
                               });
  return cut;
}

std::string delimiter_name(char delimiter) {
  return delimiter == '\t' ? "tab" : std::string(1, delimiter);
}

Cut find_cut(const TableFile& file, const TableSettings& settings, Encoding encoding) {
  if (settings.delimiter) return cut_by(*settings.delimiter, file, settings, encoding);
  std::vector<Cut> candidates;
  for (const char each : delimiters) {
    Cut cut = cut_by(each, file, settings, encoding);
    if (!cut.records.empty() && cut.records[cut.heading].cells.size() > 1)
      candidates.push_back(std::move(cut));
  }
  if (candidates.empty()) return cut_by(',', file, settings, encoding);
  const auto even = std::stable_partition(candidates.begin(), candidates.end(),
                                          [](const Cut& cut) { return cut.even; });
  if (even - candidates.begin() > 1)
    throw InputError(fmt::format(
        "{}: both '{}' and '{}' can separate its columns; state which in [data], for example "
        "delimiter = \"{}\", or put cells with the other character in double quotes",
        file.source(), delimiter_name(candidates[0].delimiter),
        delimiter_name(candidates[1].delimiter), delimiter_name(candidates[0].delimiter)));
  return std::move(candidates.front());
}

}  // namespace

TextHeading find_heading(const TableFile& file, const TableSettings& settings, Encoding encoding) {
  Cut cut = find_cut(file, settings, encoding);
  if (cut.records.empty())
    throw InputError(settings.header_row
                         ? fmt::format("{} has no line {}, where the headings should be",
                                       file.source(), *settings.header_row)
                         : fmt::format("{} has no line with headings", file.source()));
  Record& heading = cut.records[cut.heading];
  if (settings.header_row && heading.line != *settings.header_row)
    throw InputError(fmt::format(
        "{}, line {}: the line is empty, but header_row states that it has the headings",
        file.source(), *settings.header_row));
  for (const std::string& name : heading.cells) {
    if (name.find('\0') != name.npos)
      throw InputError(fmt::format("{} is not a text file: line {} has zero bytes", file.source(),
                                   heading.line));
    if (name.find('\r') != name.npos)
      throw InputError(fmt::format(
          "{}: its lines end with only a carriage return; save it with standard line endings",
          file.source()));
  }
  refuse_equal_names(heading.cells, file.source());
  return {cut.delimiter, heading.line, std::move(heading.cells)};
}

}  // namespace wearwell
