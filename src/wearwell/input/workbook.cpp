#include "wearwell/input/workbook.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <map>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/input/csv_reader.h"
#include "wearwell/input/memory_text.h"
#include "wearwell/input/merged_cells.h"
#include "wearwell/input/sheet_numbers.h"
#include "wearwell/input/spreadsheet_cell.h"
#include "wearwell/input/zip_xml.h"

// Longer than others: the parts of a workbook, and one pass through the XML of a sheet.
namespace wearwell {
namespace {

constexpr std::size_t most_sheet = std::size_t(512) << 20, most_parts = 64 << 20;  // bytes
constexpr std::size_t most_text = 1 << 16;      // limit for a cell; Excel's limit is half of it
constexpr std::size_t most_cells = 50'000'000;  // limit for the used range, with empty cells

struct SheetName {
  std::string name, part;
  bool hidden = false;
};

int whole(std::string_view text) {
  int value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

std::string attribute(const XmlHandler::Attributes& attributes, std::string_view name) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? "" : found->second;
}

/// The parts of an .xlsx other than its sheets.
class Workbook {
 public:
  explicit Workbook(const TableFile& file) : source_(file.source()), zip_(file) {
    read_sheet_names();
    if (zip_.has("xl/sharedStrings.xml")) read_strings();
    if (zip_.has("xl/styles.xml")) read_styles();
  }

  const std::string& source() const { return source_; }
  const std::vector<SheetName>& sheets() const { return sheets_; }

  /// Calls `row` with each non-empty row. Ranges of merged cells, which follow the rows, are added
  /// to `merged`.
  void read_rows(const SheetName& sheet, const SheetRange& range,
                 const std::function<void(SheetRow& row)>& row,
                 std::vector<SheetRange>* merged = nullptr) const;

 private:
  void read_sheet_names() {
    std::map<std::string, std::string> parts;  // target of each relation
    const auto nothing = [](std::string_view) {};
    const char* const relations = "xl/_rels/workbook.xml.rels";
    if (!zip_.has("xl/workbook.xml") || !zip_.has(relations))
      throw InputError(
          fmt::format("{} is not an Excel workbook (.xlsx): it has no xl/workbook.xml", source_));
    zip_.read(
        relations,
        {[&](std::string_view name, const auto& attributes) {
           if (name != "Relationship" || !attribute(attributes, "Type").ends_with("/worksheet"))
             return;
           const std::string target = attribute(attributes, "Target");
           parts[attribute(attributes, "Id")] =
               target.starts_with("/") ? target.substr(1) : "xl/" + target;
         },
         nothing},
        most_parts);
    zip_.read("xl/workbook.xml",
              {[&](std::string_view name, const auto& attributes) {
                 if (name == "workbookPr") {
                   const std::string from = attribute(attributes, "date1904");
                   from_1904_ = from == "1" || from == "true";
                 }
                 if (name != "sheet") return;
                 const auto part = parts.find(attribute(attributes, "id"));
                 if (part == parts.end()) return;  // a chart
                 sheets_.push_back({attribute(attributes, "name"), part->second,
                                    attribute(attributes, "state").ends_with("idden")});
               },
               nothing},
              most_parts);
    if (sheets_.empty()) throw InputError(fmt::format("{} has no sheet with cells", source_));
  }

  void read_strings() {
    bool in_text = false, in_reading = false;
    zip_.read("xl/sharedStrings.xml",
              {[&](std::string_view name, const auto&) {
                 if (name == "si") strings_.emplace_back();
                 if (name == "rPh") in_reading = true;  // phonetic reading
                 in_text = name == "t" && !in_reading;
               },
               [&](std::string_view name) {
                 if (name == "rPh") in_reading = false;
                 in_text = false;
               },
               [&](std::string_view text) {
                 if (in_text && !strings_.empty()) strings_.back() += text;
               }},
              most_parts);
  }

  void read_styles() {
    std::map<int, CellFormat> own;
    bool in_cells = false;
    zip_.read("xl/styles.xml",
              {[&](std::string_view name, const auto& attributes) {
                 const int number = whole(attribute(attributes, "numFmtId"));
                 if (name == "numFmt")
                   own[number] = format_of_code(attribute(attributes, "formatCode"));
                 if (name == "cellXfs") in_cells = true;
                 if (name != "xf" || !in_cells) return;
                 const auto found = own.find(number);
                 formats_.push_back(found == own.end() ? built_in_format(number) : found->second);
               },
               [&](std::string_view name) {
                 if (name == "cellXfs") in_cells = false;
               }},
              most_parts);
  }

  std::string source_;
  ZipXml zip_;
  std::vector<SheetName> sheets_;
  std::vector<std::string> strings_;
  std::vector<CellFormat> formats_;
  bool from_1904_ = false;

  friend class SheetParser;
};

/// Parses the XML of a sheet.
class SheetParser {
 public:
  SheetParser(const Workbook& book, const SheetName& sheet, const SheetRange& range,
              const std::function<void(SheetRow&)>& row, std::vector<SheetRange>* merged)
      : book_(book), sheet_(sheet), range_(range), give_(row), merged_(merged) {}

  void start(std::string_view name, const XmlHandler::Attributes& attributes) {
    if (name == "row") {
      const std::string number = attribute(attributes, "r"),
                        hidden = attribute(attributes, "hidden");
      hidden_ = hidden == "1" || hidden == "true";
      row_ = number.empty() ? row_ + 1 : static_cast<std::size_t>(std::max(whole(number), 0));
      column_ = 0;
      cells_.clear();
    } else if (name == "c") {
      at_ = {column_ + 1, row_};
      if (const std::string cell = attribute(attributes, "r"); !cell.empty()) {
        std::string_view rest;
        at_ = read_cell_name(cell, rest);
      }
      if (at_.row == 0 || at_.row > most_sheet_rows || at_.column <= column_ ||
          at_.column > most_sheet_columns)
        throw InputError(
            fmt::format("sheet '{}' has no cell {}", sheet_.name, attribute(attributes, "r")));
      column_ = at_.column;
      type_ = attribute(attributes, "t");
      style_ = static_cast<std::size_t>(std::max(whole(attribute(attributes, "s")), 0));
      value_.clear();
      has_value_ = has_formula_ = false;
    } else if (name == "v" || name == "t") {
      in_value_ = !in_reading_;
      has_value_ = true;
    } else if (name == "f") {
      has_formula_ = true;
    } else if (name == "rPh") {
      in_reading_ = true;
    } else if (name == "mergeCell" && merged_) {
      merged_->push_back(read_sheet_range(attribute(attributes, "ref"), sheet_.name));
    }
  }

  void text(std::string_view piece) {
    if (!in_value_) return;
    value_ += piece;
    if (value_.size() > most_text)
      throw InputError(fmt::format("cell {} exceeds the maximum length of a text", here()));
  }

  void end(std::string_view name) {
    if (name == "v" || name == "t") in_value_ = false;
    if (name == "rPh") in_reading_ = false;
    if (name == "c") end_cell();
    if (name != "row" || cells_.empty()) return;
    SheetRow row{row_, hidden_, std::move(cells_)};
    cells_.clear();
    give_(row);
  }

 private:
  std::string here() const {
    return fmt::format("{}{} of sheet '{}'", column_letters(at_.column), at_.row, sheet_.name);
  }

  void end_cell() {
    if (at_.row < range_.first.row || at_.row > range_.last.row ||
        at_.column < range_.first.column || at_.column > range_.last.column)
      return;
    if (has_formula_ && !has_value_ && type_ != "str")
      throw InputError(
          fmt::format("cell {} has a formula without its value; open the file in Excel or "
                      "LibreOffice and save it",
                      here()));
    std::string text = value_;
    if (type_ == "s") {
      const auto index = static_cast<std::size_t>(std::max(whole(value_), 0));
      if (index >= book_.strings_.size())
        throw InputError(
            fmt::format("cell {} refers to a text that the file does not contain", here()));
      text = book_.strings_[index];
    } else if (type_ == "b") {
      text = value_ == "1" ? "true" : "false";
    } else if ((type_.empty() || type_ == "n") && style_ < book_.formats_.size()) {
      text = formatted(value_, book_.formats_[style_], book_.from_1904_);
    }
    for (char& c : text) {
      if (c == '\n' || c == '\r') c = ' ';
    }
    const bool is_text = type_ == "s" || type_ == "str" || type_ == "inlineStr";
    if (!text.empty()) cells_.push_back({at_.column, std::move(text), is_text});
  }

  const Workbook& book_;
  const SheetName& sheet_;
  const SheetRange& range_;
  const std::function<void(SheetRow&)>& give_;
  std::vector<SheetRange>* merged_;
  std::vector<SheetCell> cells_;
  std::size_t row_ = 0, column_ = 0, style_ = 0;
  CellName at_;
  std::string type_, value_;
  bool hidden_ = false, in_value_ = false, in_reading_ = false, has_value_ = false,
       has_formula_ = false;
};

void Workbook::read_rows(const SheetName& sheet, const SheetRange& range,
                         const std::function<void(SheetRow& row)>& row,
                         std::vector<SheetRange>* merged) const {
  SheetParser parser(*this, sheet, range, row, merged);
  zip_.read(sheet.part,
            {[&](std::string_view name, const auto& attributes) { parser.start(name, attributes); },
             [&](std::string_view name) { parser.end(name); },
             [&](std::string_view text) { parser.text(text); }},
            most_sheet);
}

/// The survey of a sheet before it is read: its columns, its last row (0 if empty), its numbers in
/// text cells and its merged cells.
struct SheetSurvey {
  std::size_t first = most_sheet_columns + 1, last = 0, last_row = 0;
  SheetNumbers numbers;
  std::vector<SheetRange> merged;
};
SheetSurvey survey_of(const Workbook& book, const SheetName& sheet, const SheetRange& range,
                      const TableSettings& settings) {
  SheetSurvey found{.numbers = SheetNumbers(settings), .merged = {}};
  book.read_rows(
      sheet, range,
      [&](SheetRow& row) {
        if (row.hidden && settings.hidden_rows == false) return;
        found.first = std::min(found.first, row.cells.front().column);
        found.last = std::max(found.last, row.cells.back().column);
        found.last_row = std::max(found.last_row, row.number);
        for (const SheetCell& cell : row.cells) {
          if (cell.is_text) found.numbers.look_at(cell.column, row.number, cell.text);
        }
      },
      &found.merged);
  std::erase_if(found.merged,
                [](const SheetRange& each) { return each.first.row >= each.last.row; });
  return found;
}

/// "2 hidden rows read like the others (rows 5, 9)".
std::string hidden_text(const std::vector<std::size_t>& rows, bool read) {
  constexpr std::size_t most = 5;
  std::vector<std::string> numbers;
  for (const std::size_t row : rows) {
    numbers.push_back(numbers.size() == most ? "..." : fmt::format("{}", row));
    if (numbers.size() > most) break;
  }
  return fmt::format("{} hidden row{} {} ({})", rows.size(), rows.size() == 1 ? "" : "s",
                     read ? "read like the others" : "left out", fmt::join(numbers, ", "));
}

const SheetName& named_sheet(const Workbook& book, const std::string& wanted) {
  std::vector<std::string> names;
  for (const SheetName& each : book.sheets()) {
    if (each.name == wanted) return each;
    names.push_back(each.name);
  }
  const auto number = static_cast<std::size_t>(std::max(whole(wanted), 0));
  const bool is_number = !wanted.empty() && wanted.find_first_not_of("0123456789") == wanted.npos;
  if (is_number && number >= 1 && number <= names.size()) return book.sheets()[number - 1];
  throw InputError(fmt::format("{} has no sheet '{}'; it has {} (nearest: '{}')", book.source(),
                               wanted, fmt::join(names, ", "), nearest_name(wanted, names)));
}

}  // namespace

SheetText sheet_text(const TableFile& file, const TableSettings& settings) {
  const Workbook book(file);
  const SheetRange range =
      settings.range ? read_sheet_range(*settings.range, file.source()) : SheetRange{};
  const SheetName* sheet = nullptr;
  SheetSurvey used{.numbers = SheetNumbers(settings), .merged = {}};
  if (settings.sheet) {
    sheet = &named_sheet(book, *settings.sheet);
    used = survey_of(book, *sheet, range, settings);
  } else {
    std::vector<std::string> full;
    for (const SheetName& each : book.sheets()) {
      if (each.hidden) continue;
      SheetSurvey here = survey_of(book, each, range, settings);
      if (here.last == 0) continue;
      full.push_back(each.name);
      if (!sheet) used = std::move(here);
      if (!sheet) sheet = &each;
    }
    if (full.size() > 1)
      throw SeveralSheets(fmt::format("{} has several sheets; state which in [data], for example "
                                      "sheet = \"{}\" (it has {})",
                                      file.source(), full.front(), fmt::join(full, ", ")),
                          full);
  }
  if (!sheet || used.last == 0)
    throw InputError(fmt::format("{} is empty{}", file.source(),
                                 settings.range ? " in the range " + *settings.range : ""));
  const std::size_t width = used.last - used.first + 1;
  if (width * used.last_row > most_cells)
    throw InputError(fmt::format(
        "{}: sheet '{}' uses {} columns and {} rows, too many for a table; give its range",
        file.source(), sheet->name, width, used.last_row));
  MemoryText out;
  std::size_t next_row = 1;
  std::string line;
  MergedCells merged(used.merged);
  std::vector<std::size_t> hidden;
  book.read_rows(*sheet, range, [&](SheetRow& row) {
    check_stop();
    if (row.number < next_row)
      throw InputError(
          fmt::format("row {} of sheet '{}' is out of order", row.number, sheet->name));
    merged.fill(row);
    if (row.hidden) hidden.push_back(row.number);
    if (row.hidden && settings.hidden_rows == false) return;
    for (; next_row < row.number; ++next_row) out.add_line("");
    line.clear();
    std::size_t column = used.first;
    for (const auto& [at, text, is_text] : row.cells) {
      for (; column < at; ++column) line += ',';
      line += csv_cell(is_text ? used.numbers.rewritten(at, text) : text);
    }
    for (; column < used.last; ++column) line += ',';
    out.add_line(line);
    ++next_row;
  });
  SheetText found{out.table(file.source()), sheet->name};
  for (auto& [column, doubt] : used.numbers.doubts())
    found.doubts[column - used.first] = std::move(doubt);
  if (used.numbers.any_comma()) found.notes.emplace_back("decimal comma in text cells");
  if (const std::string words = merged.description(); !words.empty()) found.notes.push_back(words);
  if (!hidden.empty()) found.notes.push_back(hidden_text(hidden, settings.hidden_rows != false));
  return found;
}

}  // namespace wearwell
