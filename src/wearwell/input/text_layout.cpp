#include "wearwell/input/text_layout.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/trim.hpp>
#include <map>
#include <optional>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/cell_text.h"
#include "wearwell/input/column_evidence.h"
#include "wearwell/input/heading.h"
#include "wearwell/input/summary_words.h"
#include "wearwell/input/table.h"
#include "wearwell/input/text_heading.h"
#include "wearwell/input/text_records.h"

// Longer than others: one survey of the marks in a text, and its conclusions.
namespace wearwell {
namespace {

constexpr std::size_t most_to_see = 8 << 20;  // bytes; enough if the rest cannot change the result

/// A line that is not UTF-8.
struct NotUtf8 {
  std::size_t line = 0;
  std::string text;
  bool others_are = false;  ///< lines above it contain UTF-8 characters
};

class Survey {
 public:
  Survey(const TableFile& file, const TableSettings& settings, Encoding encoding)
      : file_(file), settings_(settings), heading_(find_heading(file, settings, encoding)) {
    layout_.encoding = encoding;
    layout_.delimiter = heading_.delimiter;
    layout_.heading_line = heading_.line;
    layout_.comment = settings.comment.value_or("");
    while (!heading_.names.empty() && heading_.names.back().empty()) {
      heading_.names.pop_back();
      layout_.plain = false;
    }
    if (heading_.names.empty())
      throw InputError(fmt::format("{}: line {} is empty, but it should have the headings",
                                   file.source(), heading_.line));
    evidence_.resize(heading_.names.size());
  }

  TextLayout run(bool whole) {
    TextLines lines(file_.path(), file_.source(), layout_.encoding);
    TextRecords records(lines, layout_.delimiter, layout_.comment, heading_.line);
    records.next();  // the headings
    require_utf8(records);
    records_ = &records;
    std::size_t bytes = 0;
    std::optional<bool> returns;
    const std::size_t wanted = heading_.names.size();
    for (bool first = true; records.next(); first = false) {
      require_utf8(records);
      refuse_mixed_ends(lines, returns);
      const auto& cells = records.cells();
      if (records.text_behind_quote()) records.refuse_text_behind_quote(file_.source());
      if (first && is_units_row(cells)) {
        layout_.units_row = true;
        units_.assign(cells.begin(), cells.end());
        continue;
      }
      if (cells.size() != wanted) refuse_ragged();
      bool any = false;
      for (std::size_t c = 0; c < std::min(wanted, cells.size()); ++c)
        any = any || !cells[c].empty();
      if (!any) {
        ++layout_.empty_rows;
        continue;
      }
      if (const auto summary = summary_in(cells, settings_); !summary.empty()) {
        pending_.push_back({{cells.begin(), cells.end()}, records.line(), summary});
        continue;
      }
      for (const PendingRow& each : pending_) {
        summaries_that_are_data_.insert(each.word);  // data follow
        look_at_row(each.cells, each.line);
      }
      pending_.clear();
      look_at_row(cells, records.line());
      bytes += records.text().size();
      if (!whole && bytes > most_to_see && rows_ % 1024 == 0 && is_plain() &&
          is_settled(evidence_, layout_.delimiter))
        break;
    }
    settle_summary();
    layout_.comments = records.comments();
    layout_.plain = layout_.plain && !records.blank_beside_quote();
    finish();
    return std::move(layout_);
  }

 private:
  /// A row that may contain means or sums; undecided until it is known whether data follow.
  struct PendingRow {
    std::vector<std::string> cells;
    std::size_t line = 0;
    std::string word;
  };

  template <class Cells>
  void look_at_row(const Cells& cells, std::size_t line) {
    ++rows_;
    for (std::size_t c = 0; c < evidence_.size(); ++c) look_at(cells[c], rows_, line, evidence_[c]);
  }

  /// Omits the last rows if they are means, sums and the like. In a column of labels such a word
  /// may be a label.
  void settle_summary() {
    const bool left_out =
        !pending_.empty() && rows_ > 0 &&
        std::none_of(pending_.begin(), pending_.end(), [&](const PendingRow& each) {
          return summaries_that_are_data_.contains(each.word);
        });
    if (!left_out) {
      for (const PendingRow& each : pending_) look_at_row(each.cells, each.line);
      return;
    }
    const PendingRow& first = pending_.front();
    const auto word = std::find_if(first.cells.begin(), first.cells.end(),
                                   [](const std::string& cell) { return !cell.empty(); });
    const auto column = static_cast<std::size_t>(word - first.cells.begin());
    if (!settings_.summary_rows && evidence_[column].any_text)
      throw InputError(fmt::format(
          "{}, line {}: '{}' is ambiguous: either this row is computed from the rows above, or it "
          "is data with a name like the others in column '{}'; state which in [data]: summary_rows "
          "= \"last\" (the last rows are omitted) or \"none\" (all are data)",
          file_.source(), first.line, *word, heading_.names[column]));
    std::vector<std::string> words;
    for (const PendingRow& each : pending_) words.push_back(each.word);
    layout_.summary_line = first.line;
    layout_.plain = false;
    layout_.notes.push_back(fmt::format(
        "the last {} left out ({})",
        words.size() == 1 ? "row" : fmt::format("{} rows", words.size()), fmt::join(words, ", ")));
  }

  void require_utf8(const TextRecords& records) {
    if (layout_.encoding != Encoding::utf8) return;
    const std::string_view text = records.text();
    if (is_ascii(text)) return;
    if (!is_utf8(text)) throw NotUtf8{records.line(), valid_utf8(text), any_utf8_};
    any_utf8_ = true;
  }

  void refuse_mixed_ends(const TextLines& lines, std::optional<bool>& returns) const {
    if (lines.last) return;
    if (returns.value_or(lines.has_return) != lines.has_return)
      throw InputError(
          fmt::format("{}, line {}: its line ending (with or without a carriage return) is not "
                      "that of the lines above",
                      file_.source(), lines.number));
    returns = lines.has_return;
  }

  void refuse_ragged() {
    const auto& cells = records_->cells();
    const std::size_t wanted = heading_.names.size();
    const bool only_empty_behind =
        cells.size() > wanted && std::all_of(cells.begin() + static_cast<std::ptrdiff_t>(wanted),
                                             cells.end(), [](auto cell) { return cell.empty(); });
    if (only_empty_behind) {
      layout_.plain = false;
      return;
    }
    const std::string_view text = records_->text();
    const bool comment = records_->line() > 1 &&
                         (text.starts_with("#") || text.starts_with("%") || text.starts_with("//"));
    throw InputError(fmt::format(
        "{}, line {}: {} value{} but the heading has {}: '{}'{}", file_.source(), records_->line(),
        cells.size(), cells.size() == 1 ? "" : "s", wanted, shortened(text, 200),
        comment ? fmt::format(" (comment lines are not allowed by default; to omit them write "
                              "comment = \"{}\" in [data])",
                              text.starts_with("//") ? "//" : text.substr(0, 1))
        : wanted == 1 ? " (the first line must be the heading)"
        : layout_.delimiter == ',' && cells.size() > wanted
            ? " (if commas separate the columns, quote numbers with a decimal comma)"
            : ""));
  }

  /// Whether the row has only units, in columns that have numbers below.
  bool is_units_row(const std::vector<std::string_view>& cells) const {
    if (settings_.units_row) return *settings_.units_row;
    if (cells.size() < heading_.names.size()) return false;
    bool any = false;
    for (const std::string_view cell : cells) {
      const std::string text = boost::algorithm::trim_copy(std::string(cell));
      if (text.empty() || text == "-" || is_units_word(text)) continue;
      if (number_form(text).kind == NumberForm::Kind::number || !is_unit_cell(text)) return false;
      any = true;
    }
    return any && numbers_follow(cells);
  }

  /// Whether the next record has a number in every column in which this one has a unit.
  bool numbers_follow(const std::vector<std::string_view>& units) const {
    TextLines lines(file_.path(), file_.source(), layout_.encoding);
    TextRecords records(lines, layout_.delimiter, layout_.comment, heading_.line);
    for (int i = 0; i < 3; ++i) {
      if (!records.next()) return false;
    }
    for (std::size_t c = 0; c < std::min(units.size(), records.cells().size()); ++c) {
      if (boost::algorithm::trim_copy(std::string(units[c])).empty()) continue;
      const std::string_view cell = records.cells()[c];
      if (is_units_word(units[c]) || is_missing_mark(cell) || cell_text(cell)) continue;
      if (number_form(cell).kind == NumberForm::Kind::text) return false;
    }
    return true;
  }

  bool is_plain() const {
    return layout_.plain && layout_.encoding == Encoding::utf8 && layout_.heading_line == 1 &&
           !layout_.units_row && layout_.comment.empty() && layout_.empty_rows == 0 &&
           !settings_.decimal && !settings_.thousands &&
           std::none_of(heading_.names.begin(), heading_.names.end(),
                        [](const std::string& name) { return name.empty(); });
  }

  void finish() {
    const char of_all = shown_by_all(evidence_);
    layout_.plain = is_plain();
    for (std::size_t c = 0; c < heading_.names.size(); ++c) {
      const ColumnEvidence& seen = evidence_[c];
      TextColumn column;
      column.name = heading_.names[c].empty() ? fmt::format("column{}", c + 1) : heading_.names[c];
      if (c < units_.size() && !is_units_word(units_[c]))
        column.unit = boost::algorithm::trim_copy(units_[c]);
      decide_marks(seen, of_all, evidence_, layout_.delimiter, settings_, column);
      decide_unit(seen, column);
      layout_.plain =
          layout_.plain && !seen.limit && !seen.with_unit &&
          (!column.is_number || (column.doubt.empty() && seen.is_plain(column.marks.decimal)));
      tell(seen, column);
      add_notes(seen, column, heading_.names[c].empty());
      layout_.columns.push_back(std::move(column));
    }
  }

  /// Remarks about other content in the cells of a number column.
  void add_notes(const ColumnEvidence& seen, const TextColumn& column, bool no_heading) {
    if (no_heading && (seen.any_number || seen.any_text))
      layout_.notes.push_back(fmt::format("a column without a heading, read as '{}'", column.name));
    if (seen.any_text || !seen.any_number) return;
    const auto cells = [](std::size_t count) {
      return fmt::format("{} cell{}", count, count == 1 ? "" : "s");
    };
    if (seen.missing)
      layout_.notes.push_back(fmt::format("{} of '{}' without a value ('{}')",
                                          cells(seen.missing_cells), column.name,
                                          seen.missing->cell));
    if (seen.limit)
      layout_.notes.push_back(
          fmt::format("{} of '{}' that {} ('{}')", cells(seen.limits), column.name,
                      seen.limits == 1 ? "is a limit" : "are limits", seen.limit->cell));
    if (column.unit_in_cells)
      layout_.notes.push_back(
          fmt::format("the unit {} in the cells of '{}'", column.unit, column.name));
  }

  /// Records the marks of numbers for the description.
  void tell(const ColumnEvidence& seen, const TextColumn& column) {
    if (seen.any_text || !seen.any_number || !column.doubt.empty()) return;
    const auto add = [](std::string& to, char mark) {
      if (to.find(mark) == to.npos) to += mark;
    };
    for (const std::size_t m : {0u, 1u}) {
      if (seen.doubtful[m])
        add(decimal_signs[m] == column.marks.decimal ? layout_.decimal_marks
                                                     : layout_.thousands_marks,
            decimal_signs[m]);
    }
    if (seen.shows(mark_place(column.marks.decimal)))
      add(layout_.decimal_marks, column.marks.decimal);
    for (const char mark : seen.thousands) add(layout_.thousands_marks, mark);
  }

  const TableFile& file_;
  const TableSettings& settings_;
  TextHeading heading_;
  TextLayout layout_;
  std::vector<ColumnEvidence> evidence_;
  std::vector<std::string> units_;
  std::vector<PendingRow> pending_;
  std::set<std::string> summaries_that_are_data_;
  std::size_t rows_ = 0;
  const TextRecords* records_ = nullptr;
  bool any_utf8_ = false;
};

const char* delimiter_words(char delimiter) {
  switch (delimiter) {
    case '\t':
      return "tabs";
    case ';':
      return "semicolons";
    case '|':
      return "bars";
    default:
      return delimiter == ',' ? "commas" : "other characters";
  }
}

}  // namespace

TextLayout find_layout(const TableFile& file, const TableSettings& settings, bool whole) {
  if (TextLines(file.path(), file.source(), Encoding::utf8).unpacks() && !file.gzip())
    throw InputError(fmt::format("{} is compressed; name it .gz at the end", file.source()));
  const Encoding shown = first_encoding(file.path());
  // A study does not state the byte order of UTF-16.
  const bool shows_utf16 = shown == Encoding::utf16_le || shown == Encoding::utf16_be;
  const bool wants_utf16 = settings.encoding == Encoding::utf16_le;
  const Encoding first = wants_utf16 && shows_utf16 ? shown : settings.encoding.value_or(shown);
  try {
    return Survey(file, settings, first).run(whole);
  } catch (const NotUtf8& fault) {
    if (settings.encoding || fault.others_are)
      throw InputError(fmt::format("{}, line {}: '{}' is not UTF-8{}; save the file as UTF-8",
                                   file.source(), fault.line, shortened(fault.text),
                                   fault.others_are ? ", unlike the lines above it" : ""));
  }
  return Survey(file, settings, Encoding::cp1252).run(whole);
}

std::string description(const TextLayout& layout, const std::string& sheet) {
  std::vector<std::string> words;
  if (!sheet.empty()) {
    words.push_back(fmt::format("sheet '{}'", sheet));
  } else {
    if (layout.columns.size() > 1) words.emplace_back(delimiter_words(layout.delimiter));
    for (const char mark : layout.decimal_marks) words.push_back("decimal " + mark_name(mark));
  }
  for (const char mark : layout.thousands_marks) words.push_back("thousands " + mark_name(mark));
  if (layout.encoding != Encoding::utf8) words.emplace_back(encoding_name(layout.encoding));
  if (layout.heading_line != 1)
    words.push_back(
        fmt::format("headings in {} {}", sheet.empty() ? "line" : "row", layout.heading_line));
  if (layout.units_row) words.emplace_back("units in the row below the headings");
  const auto left_out = [&](std::size_t count, const char* what) {
    if (count > 0)
      words.push_back(fmt::format("{} {}{} left out", count, what, count == 1 ? "" : "s"));
  };
  left_out(layout.comments, "comment line");
  left_out(layout.empty_rows, "empty row");
  words.insert(words.end(), layout.notes.begin(), layout.notes.end());
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace wearwell
