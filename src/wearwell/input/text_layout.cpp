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
#include "wearwell/input/heading.h"
#include "wearwell/input/table.h"
#include "wearwell/input/text_heading.h"
#include "wearwell/input/text_records.h"

// Longer than others: one survey of the marks in a text, and what it settles.
namespace wearwell {
namespace {

constexpr std::size_t most_to_see = 8 << 20;  // bytes, where more could change nothing

/// A cell that shows something, and its row of data.
struct Witness {
  std::size_t row = 0, line = 0;
  std::string cell;
};

/// What the cells of a column show of its numbers.
struct Evidence {
  std::optional<Witness> decimal[2], doubtful[2];  // of '.' and ','
  std::set<char> thousands;
  bool any_number = false, any_text = false;
  bool other_signs = false;  ///< such as no C number has

  bool shows(std::size_t mark) const { return decimal[mark].has_value(); }
  bool agrees_with(const NumberMarks& marks) const;
  /// Whether its numbers are as C has them.
  bool is_plain(char decimal_mark) const {
    if (!thousands.empty() || other_signs || shows(1) || doubtful[1]) return false;
    return decimal_mark == '.' || (!shows(0) && !doubtful[0]);
  }
};

/// A line that is no UTF-8.
struct NotUtf8 {
  std::size_t line = 0;
  std::string text;
  bool others_are = false;  ///< lines above it hold characters of UTF-8
};

constexpr char marks[2] = {'.', ','};
std::size_t place_of(char mark) {
  return mark == ',';
}

bool Evidence::agrees_with(const NumberMarks& with) const {
  const std::size_t other = with.decimal == '.';
  if (shows(other)) return false;
  const auto may_be = [&](char mark) {
    return mark != with.decimal && (with.thousands == '*' || with.thousands == mark);
  };
  return std::all_of(thousands.begin(), thousands.end(), may_be) &&
         (!doubtful[other] || may_be(marks[other]));
}

void look_at(std::string_view cell, std::size_t row, std::size_t line, Evidence& seen) {
  const NumberForm form = number_form(cell);
  if (form.kind == NumberForm::Kind::empty) return;
  if (form.kind == NumberForm::Kind::text) {
    seen.any_text = true;
    return;
  }
  seen.any_number = true;
  const auto note = [&](std::optional<Witness>& witness) {
    if (!witness) witness = {row, line, std::string(cell)};
  };
  if (form.doubtful) note(seen.doubtful[place_of(form.doubtful)]);
  if (form.decimal) note(seen.decimal[place_of(form.decimal)]);
  if (form.thousands) seen.thousands.insert(form.thousands);
  // A mark for thousands cannot be the decimal mark.
  if (form.thousands == '.' && !form.decimal) note(seen.decimal[1]);
  if (form.thousands == ',' && !form.decimal) note(seen.decimal[0]);
  if (form.thousands || cell.front() == '+' || static_cast<unsigned char>(cell.front()) >= 0x80 ||
      static_cast<unsigned char>(cell.back()) >= 0x80)
    seen.other_signs = true;
}

std::string at(const Witness& witness, const std::string& column) {
  return fmt::format("{}, column '{}'", row_name(witness.row, witness.line), column);
}

/// The decimal mark that the columns of numbers show; 0 where they show none, '?' where both.
char shown_by_all(const std::vector<Evidence>& all) {
  bool shown[2] = {};
  for (const Evidence& each : all) {
    if (each.any_text) continue;
    for (const std::size_t m : {0u, 1u}) shown[m] = shown[m] || each.shows(m);
  }
  return shown[0] && shown[1] ? '?' : shown[0] ? '.' : shown[1] ? ',' : 0;
}

const Witness& witness_of(const std::vector<Evidence>& all, std::size_t mark) {
  for (const Evidence& each : all) {
    if (!each.any_text && each.shows(mark)) return *each.decimal[mark];
  }
  return *all.front().decimal[mark];  // nobody asks where there is none
}

/// Which marks the numbers of a column have, or why nobody can tell.
void decide(const Evidence& seen, char of_all, const std::vector<Evidence>& all, char delimiter,
            const TableSettings& settings, TextColumn& column) {
  column.is_number = seen.any_number && !seen.any_text;
  column.marks.thousands = settings.thousands.value_or('*');
  const auto is_set = [&](char decimal) {
    column.marks.decimal = decimal;
    column.is_number = column.is_number && seen.agrees_with(column.marks);
  };
  if (settings.decimal) return is_set(*settings.decimal);
  if (settings.thousands == '.') return is_set(',');
  if (settings.thousands == ',') return is_set('.');
  if (seen.shows(0) && seen.shows(1)) {
    const Witness &point = *seen.decimal[0], &comma = *seen.decimal[1];
    const bool first = comma.row < point.row;
    column.doubt = fmt::format(
        "{}: '{}' has a decimal {} and '{}' in row {} a decimal {}; a column has one of them (say "
        "which in [data], as in decimal = \".\")",
        at(first ? point : comma, column.name), (first ? point : comma).cell,
        first ? "point" : "comma", (first ? comma : point).cell, (first ? comma : point).row,
        first ? "comma" : "point");
    return;
  }
  if (seen.shows(0) || seen.shows(1)) {
    column.marks.decimal = marks[seen.shows(1)];
    return;
  }
  if (!seen.doubtful[0] && !seen.doubtful[1]) {
    // Of whole numbers the others' mark, for what people are told.
    column.marks.decimal = of_all == ',' ? ',' : '.';
    return;
  }
  const auto doubt = [&](const std::string& why) {
    const Witness& witness = *seen.doubtful[seen.doubtful[0] ? 0 : 1];
    column.doubt = fmt::format("{}: {}{}; or say in [data] which it is, as in decimal = \",\"",
                               at(witness, column.name), two_readings(witness.cell), why);
  };
  const auto others = [&](std::size_t mark) {
    const Witness& other = witness_of(all, mark);
    return fmt::format(" (the file has '{}', with a decimal {})", other.cell,
                       mark ? "comma" : "point");
  };
  if (seen.doubtful[0] && seen.doubtful[1]) return doubt("");
  if (of_all == '?') return doubt(others(seen.doubtful[0] ? 1 : 0));
  // Where commas separate the columns, the point is the decimal mark of most files.
  if (of_all == ',' && seen.doubtful[0] && delimiter == ',') return doubt(others(1));
  if (of_all == 0 && seen.doubtful[0] && delimiter == ',') {
    column.marks.decimal = '.';
  } else if (of_all == 0) {
    doubt("");
  } else {
    column.marks.decimal = of_all;
  }
}

/// Whether what was seen so far settles every column, whatever follows.
bool is_settled(const std::vector<Evidence>& all, char delimiter) {
  const char of_all = shown_by_all(all);
  if (of_all != '.' && !(of_all == 0 && delimiter == ',')) return false;
  return std::none_of(all.begin(), all.end(), [](const Evidence& each) {
    return each.shows(1) || each.doubtful[1] || each.other_signs ||
           (each.doubtful[0] && !each.shows(0));
  });
}

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
      throw InputError(fmt::format("{}: line {} is empty; it must hold the headings", file.source(),
                                   heading_.line));
    evidence_.resize(heading_.names.size());
  }

  TextLayout run(bool whole) {
    TextLines lines(file_.path(), file_.source(), layout_.encoding);
    TextRecords records(lines, layout_.delimiter, layout_.comment, heading_.line);
    records.next();  // the headings
    require_utf8(records);
    records_ = &records;
    std::size_t bytes = 0, rows = 0;
    std::optional<bool> returns;
    const std::size_t wanted = heading_.names.size();
    for (bool first = true; records.next(); first = false) {
      require_utf8(records);
      refuse_mixed_ends(lines, returns);
      const auto& cells = records.cells();
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
      ++rows;
      for (std::size_t c = 0; c < wanted; ++c)
        look_at(cells[c], rows, records.line(), evidence_[c]);
      bytes += records.text().size();
      if (!whole && bytes > most_to_see && rows % 1024 == 0 && is_plain() &&
          is_settled(evidence_, layout_.delimiter))
        break;
    }
    layout_.comments = records.comments();
    layout_.plain = layout_.plain && !records.blank_before_quote();
    finish();
    return std::move(layout_);
  }

 private:
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
          fmt::format("{}, line {} ends in another way than those before it (with or without a "
                      "carriage return)",
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
        "{}, line {}: {} value{} where the heading has {}: '{}'{}", file_.source(),
        records_->line(), cells.size(), cells.size() == 1 ? "" : "s", wanted, shortened(text, 200),
        comment ? fmt::format(" (a table has no comment lines; to leave them out write comment = "
                              "\"{}\" into [data])",
                              text.starts_with("//") ? "//" : text.substr(0, 1))
        : wanted == 1 ? " (the first line must be the heading)"
        : layout_.delimiter == ',' && cells.size() > wanted
            ? " (a number with a decimal comma needs quotes where commas separate the columns)"
            : ""));
  }

  /// Units where the rows below have numbers, and nothing else.
  bool is_units_row(const std::vector<std::string_view>& cells) const {
    if (settings_.units_row) return *settings_.units_row;
    if (cells.size() < heading_.names.size()) return false;
    bool any = false;
    for (const std::string_view cell : cells) {
      const std::string text = boost::algorithm::trim_copy(std::string(cell));
      if (text.empty() || text == "-") continue;
      if (number_form(text).kind == NumberForm::Kind::number || !is_unit_cell(text)) return false;
      any = true;
    }
    return any && numbers_follow(cells);
  }

  /// Whether the next record has a number wherever this one has a unit.
  bool numbers_follow(const std::vector<std::string_view>& units) const {
    TextLines lines(file_.path(), file_.source(), layout_.encoding);
    TextRecords records(lines, layout_.delimiter, layout_.comment, heading_.line);
    for (int i = 0; i < 3; ++i) {
      if (!records.next()) return false;
    }
    for (std::size_t c = 0; c < std::min(units.size(), records.cells().size()); ++c) {
      if (boost::algorithm::trim_copy(std::string(units[c])).empty()) continue;
      if (number_form(records.cells()[c]).kind == NumberForm::Kind::text) return false;
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
      const Evidence& seen = evidence_[c];
      TextColumn column;
      column.name = heading_.names[c].empty() ? fmt::format("column{}", c + 1) : heading_.names[c];
      if (c < units_.size()) column.unit = boost::algorithm::trim_copy(units_[c]);
      decide(seen, of_all, evidence_, layout_.delimiter, settings_, column);
      layout_.plain =
          layout_.plain &&
          (!column.is_number || (column.doubt.empty() && seen.is_plain(column.marks.decimal)));
      tell(seen, column);
      layout_.columns.push_back(std::move(column));
    }
  }

  /// For people: the marks that numbers have.
  void tell(const Evidence& seen, const TextColumn& column) {
    if (!column.is_number || !column.doubt.empty()) return;
    const auto add = [](std::string& to, char mark) {
      if (to.find(mark) == to.npos) to += mark;
    };
    for (const std::size_t m : {0u, 1u}) {
      if (seen.doubtful[m])
        add(marks[m] == column.marks.decimal ? layout_.decimal_marks : layout_.thousands_marks,
            marks[m]);
    }
    if (seen.shows(place_of(column.marks.decimal)))
      add(layout_.decimal_marks, column.marks.decimal);
    for (const char mark : seen.thousands) add(layout_.thousands_marks, mark);
  }

  const TableFile& file_;
  const TableSettings& settings_;
  TextHeading heading_;
  TextLayout layout_;
  std::vector<Evidence> evidence_;
  std::vector<std::string> units_;
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
      return delimiter == ',' ? "commas" : "other signs";
  }
}

}  // namespace

TextLayout find_layout(const TableFile& file, const TableSettings& settings, bool whole) {
  if (TextLines(file.path(), file.source(), Encoding::utf8).unpacks() && !file.gzip())
    throw InputError(fmt::format("{} is compressed; name it .gz at the end", file.source()));
  const Encoding shown = first_encoding(file.path());
  // Which of the two halves comes first, a study does not say.
  const bool shows_utf16 = shown == Encoding::utf16_le || shown == Encoding::utf16_be;
  const bool wants_utf16 = settings.encoding == Encoding::utf16_le;
  const Encoding first = wants_utf16 && shows_utf16 ? shown : settings.encoding.value_or(shown);
  try {
    return Survey(file, settings, first).run(whole);
  } catch (const NotUtf8& fault) {
    if (settings.encoding || fault.others_are)
      throw InputError(fmt::format("{}, line {}: '{}' is not UTF-8{}; save the file as UTF-8",
                                   file.source(), fault.line, shortened(fault.text),
                                   fault.others_are ? ", as lines above it are" : ""));
  }
  return Survey(file, settings, Encoding::cp1252).run(whole);
}

std::string in_words(const TextLayout& layout, const std::string& sheet) {
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
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace wearwell
