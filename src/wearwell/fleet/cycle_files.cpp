#include "wearwell/fleet/cycle_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <filesystem>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/quoted.h"
#include "wearwell/input/text_heading.h"
#include "wearwell/input/text_layout.h"
#include "wearwell/input/text_lines.h"
#include "wearwell/input/text_records.h"
#include "wearwell/input/text_rewrite.h"

namespace wearwell::fleet {
namespace {

/// The marks by which DuckDB reads a file.
struct Marks {
  char delimiter = ',', decimal = '.';
  bool operator==(const Marks&) const = default;
};

/// Whether a decimal comma is all that keeps DuckDB from reading a file as it is.
bool only_decimal_comma(const TextLayout& layout) {
  return layout.encoding == Encoding::utf8 && layout.heading_line == 1 && !layout.units_row &&
         layout.comment.empty() && layout.comments == 0 && layout.empty_rows == 0 &&
         !layout.summary_line && layout.notes.empty() && layout.thousands_marks.empty() &&
         layout.decimal_marks == "," &&
         std::none_of(layout.columns.begin(), layout.columns.end(),
                      [](const TextColumn& each) { return !each.doubt.empty(); });
}

/// Empty if DuckDB cannot read it as it is.
std::optional<Marks> marks_of(const TextLayout& layout) {
  if (layout.plain) return Marks{layout.delimiter, '.'};
  if (only_decimal_comma(layout)) return Marks{layout.delimiter, ','};
  return {};
}

/// Whether a cell is a number with this decimal mark, which others cannot be: "1,5".
bool has_mark(std::string_view cell, char mark) {
  const std::size_t at = cell.find(mark);
  if (at == cell.npos || at == 0 || at + 1 == cell.size()) return false;
  const std::size_t first = cell.front() == '-' || cell.front() == '+' ? 1 : 0;
  for (std::size_t i = first; i < cell.size(); ++i)
    if (i != at && (cell[i] < '0' || cell[i] > '9')) return false;
  return at > first;
}

/// The decimal mark of the lines that have as many cells as the heading: ',' or '.'; nothing if
/// they have both.
std::optional<char> decimal_of(const TableFile& file, const TextHeading& heading) {
  constexpr std::size_t enough = 100'000;  // lines
  TextLines lines(file.path(), file.source(), Encoding::utf8);
  TextRecords records(lines, heading.delimiter, "", heading.line + 1);
  bool comma = false, point = false;
  for (std::size_t n = 0; n < enough && records.next(); ++n) {
    if (records.cells().size() != heading.names.size()) continue;
    for (const std::string_view cell : records.cells()) {
      comma = comma || has_mark(cell, ',');
      point = point || has_mark(cell, '.');
    }
  }
  if (comma && point) return {};
  return comma ? ',' : '.';
}

/// A line with too few or too many cells has no layout; the heading shows the separator, and the
/// other lines the decimal mark.
TextLayout layout_of(const TableFile& file, bool skip_bad) {
  try {
    return find_layout(file, {});
  } catch (const InputError&) {
    if (!skip_bad) throw;
    TextLayout layout;
    const TextHeading heading = find_heading(file, {}, Encoding::utf8);
    layout.delimiter = heading.delimiter;
    layout.heading_line = heading.line;
    if (layout.delimiter == ',') return layout;
    const std::optional<char> decimal = decimal_of(file, heading);
    if (!decimal) throw;
    layout.decimal_marks = std::string(1, *decimal);
    layout.plain = *decimal == '.';
    return layout;
  }
}

class Survey {
 public:
  Survey(CycleFiles& files, bool skip_bad, double most_bytes)
      : files_(files), skip_bad_(skip_bad), most_bytes_(most_bytes) {}

  void run() {
    // With thousands of files the first ones decide; DuckDB refuses what does not fit them.
    constexpr std::size_t first = 16;
    const std::size_t some = std::min(first, files_.names.size());
    bool uniform = true;
    for (std::size_t i = 0; i < some; ++i) {
      look(i);
      uniform = uniform && marks_.back() && *marks_.back() == *marks_.front();
    }
    if (uniform) {
      files_.delimiter = marks_.front()->delimiter;
      files_.decimal = marks_.front()->decimal;
      files_.paths = files_.names;
      if (files_.decimal == ',') {
        for (const TextColumn& each : layouts_.front().columns)
          if (each.is_number) files_.numbers.push_back(each.name);
      }
    } else {
      for (std::size_t i = some; i < files_.names.size(); ++i) look(i);
      for (std::size_t i = 0; i < files_.names.size(); ++i) files_.paths.push_back(standard(i));
    }
    const auto other = std::find_if(marks_.begin(), marks_.end(),
                                    [](const auto& each) { return !each || *each != Marks{}; });
    if (other != marks_.end())
      files_.layout = description(layouts_[static_cast<std::size_t>(other - marks_.begin())], "");
  }

 private:
  void look(std::size_t i) {
    const TableFile file(files_.names[i]);
    layouts_.push_back(layout_of(file, skip_bad_));
    if (skip_bad_ && i == 0) files_.headings = find_heading(file, {}, Encoding::utf8).names.size();
    marks_.push_back(marks_of(layouts_.back()));
    if (skip_bad_ && (!marks_.back() || *marks_.back() != *marks_.front())) {
      // Cells that are no numbers, missing ones, are what is to be skipped.
      TextLayout& layout = layouts_.back();
      const bool standard = layout.encoding == Encoding::utf8 && layout.heading_line == 1 &&
                            !layout.units_row && layout.comments == 0 && !layout.summary_line &&
                            layout.thousands_marks.empty() && layout.decimal_marks.size() < 2;
      const Marks marks{layout.delimiter, layout.decimal_marks == "," ? ',' : '.'};
      if (!standard || (i > 0 && marks != *marks_.front()))
        throw InputError(
            fmt::format("{}: --skip-bad needs CSV files of one layout, in UTF-8, with headings in "
                        "line 1 and no thousands marks; this one has {}",
                        printable(files_.names[i]), description(layout, "")));
      marks_.back() = marks;
    }
  }

  /// The path of a file, or of its copy as standard CSV.
  std::string standard(std::size_t i) {
    if (marks_[i] == Marks{}) return files_.names[i];
    const std::string& name = files_.names[i];
    TextLayout layout = layouts_[i];
    if (static_cast<double>(std::filesystem::file_size(name)) > most_bytes_)
      throw InputError(
          fmt::format("{} ({}) is too large to be rewritten in memory (--memory): save it as "
                      "Parquet, or as CSV "
                      "in UTF-8 with headings in line 1 and no thousands marks",
                      printable(name), description(layout, "")));
    for (TextColumn& each : layout.columns)
      if (!each.unit.empty()) each.name += fmt::format(" [{}]", each.unit);
    std::vector<std::size_t> lines;
    files_.rewritten.push_back(wearwell::rewritten(TableFile(name), layout, lines));
    return files_.rewritten.back()->path();
  }

  CycleFiles& files_;
  bool skip_bad_;
  double most_bytes_;
  std::vector<TextLayout> layouts_;
  std::vector<std::optional<Marks>> marks_;
};

}  // namespace

void refuse_remote(const std::string& file) {
  const std::size_t scheme = file.find("://");
  if (scheme == std::string::npos) return;
  throw InputError(
      fmt::format("{}: files are read from folders; there is no access to '{}://'. Mount the store "
                  "as a folder, or copy the files first",
                  printable(shortened(file)), printable(shortened(file.substr(0, scheme)))));
}

CycleFiles cycle_files(const std::vector<std::string>& files, const std::string& source,
                       bool skip_bad, double most_bytes) {
  const auto ends = [](const std::string& file, const char* end) {
    return boost::algorithm::iends_with(file, end);
  };
  CycleFiles found;
  found.names = files;
  bool parquet = true, csv = true;
  for (const std::string& file : files) {
    if (file.find_first_of("*?[") != std::string::npos)
      throw InputError(
          fmt::format("DuckDB takes the name {} for a pattern: rename the file", printable(file)));
    parquet = parquet && (ends(file, ".parquet") || ends(file, ".pq"));
    csv = csv && (ends(file, ".csv") || ends(file, ".csv.gz"));
  }
  if (!parquet && !csv)
    throw InputError(fmt::format(
        "{}: a fleet's cycles must be Parquet files or CSV files, all of one kind", source));
  found.csv = csv;
  found.all_text = csv && skip_bad;
  if (csv) {
    Survey(found, skip_bad, most_bytes).run();
  } else {
    found.paths = files;
  }
  return found;
}

void refuse_invalid_lines(const CycleFiles& files) {
  for (const std::string& name : files.names) {
    const TableFile file(name);
    if (!files.all_text) {
      find_layout(file, {}, true);
      continue;
    }
    // Lines that are too short are left out.
    TextLines lines(file.path(), file.source(), Encoding::utf8);
    TextRecords records(lines, files.delimiter);
    while (records.next())
      if (records.text_behind_quote()) records.refuse_text_behind_quote(file.source());
  }
}

std::string reader_of(const CycleFiles& files, const std::string& unit) {
  std::vector<std::string> names, types;
  for (const std::string& path : files.paths) names.push_back(quoted(path, '\''));
  if (!files.csv)
    return fmt::format("read_parquet([{}], hive_partitioning = false)", fmt::join(names, ", "));
  for (const std::string& each : files.numbers)
    if (each != unit) types.push_back(fmt::format("{}: 'DOUBLE'", quoted(each, '\'')));
  if (!unit.empty()) types.push_back(fmt::format("{}: 'VARCHAR'", quoted(unit, '\'')));
  // Without BIGINT: if the first thousands of cells are integers, 2.5 would be read as 3.
  const std::string cells =
      files.all_text
          ? "null_padding = true, all_varchar = true"
          : fmt::format(
                "null_padding = false, decimal_separator = '{}', auto_type_candidates = "
                "['DOUBLE', 'VARCHAR']{}",
                files.decimal,
                types.empty() ? "" : fmt::format(", types = {{{}}}", fmt::join(types, ", ")));
  return fmt::format(
      "read_csv([{}], header = true, delim = {}, quote = '\"', escape = '\"', strict_mode = true, "
      "ignore_errors = false, hive_partitioning = false, {})",
      fmt::join(names, ", "), quoted(std::string(1, files.delimiter), '\''), cells);
}

}  // namespace wearwell::fleet
