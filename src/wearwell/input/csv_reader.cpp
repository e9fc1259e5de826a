#include "wearwell/input/csv_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell {
namespace {

bool inside_quotes(const std::string& line) {
  return std::count(line.begin(), line.end(), '"') % 2 == 1;
}

template <class T>
bool read(const std::string& cell, T& value) {
  const char* end = cell.data() + cell.size();
  const auto [rest, error] = std::from_chars(cell.data(), end, value);
  return error == std::errc() && rest == end;
}

}  // namespace

CsvReader::CsvReader(const std::filesystem::path& file, const char* row, const char* cells)
    : file_(file.string()), noun_(row), cells_are_(cells), stream_(file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    throw InputError(fmt::format("{} is missing", file_));
  }
  if (!stream_ || std::filesystem::is_directory(file, ignored)) {
    throw InputError(fmt::format("cannot read {}", file_));
  }
  if (!read_row(heading_)) throw InputError(fmt::format("{} is empty", file_));
}

std::size_t CsvReader::column(const std::string& name) const {
  const auto found = std::find(heading_.begin(), heading_.end(), name);
  if (found == heading_.end()) {
    throw InputError(fmt::format("{} has no column '{}'", file_, printable(name)));
  }
  return static_cast<std::size_t>(found - heading_.begin());
}

bool CsvReader::read_row(std::vector<std::string>& cells) {
  do {
    if (!std::getline(stream_, line_)) return false;
  } while (line_.empty() || line_.front() == '#');
  for (std::string more; inside_quotes(line_) && std::getline(stream_, more);) line_ += '\n' + more;
  std::size_t count = 0;
  bool quoted = false, closed = false, fresh = true;
  for (const char c : line_) {
    if (fresh) {
      if (count == cells.size()) cells.emplace_back();
      cells[count++].clear();
      fresh = closed = false;
    }
    std::string& cell = cells[count - 1];
    if (c == '"') {
      if (closed) cell += '"';  // a doubled quote means one quote
      closed = quoted;
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fresh = true;
    } else {
      cell += c;
    }
  }
  if (fresh) {
    if (count == cells.size()) cells.emplace_back();
    cells[count++].clear();
  }
  cells.resize(count);
  return true;
}

bool CsvReader::next() {
  if (!read_row(cells_)) return false;
  ++row_;
  if (cells_.size() != heading_.size()) {
    throw InputError(fmt::format("{}, {} {}: should have {} {}", file_, noun_, row_,
                                 heading_.size(), cells_are_));
  }
  return true;
}

void CsvReader::fail(std::size_t column, const std::string& expected) const {
  throw InputError(fmt::format("{}, {} {}, column '{}': should be {}, and is '{}'", file_, noun_,
                               row_, printable(shortened(heading_[column])), expected,
                               printable(shortened(cells_[column]))));
}

double CsvReader::number(std::size_t column) const {
  double value = 0;
  if (!read(cells_[column], value)) fail(column, "a number");
  return value;
}

long long CsvReader::integer(std::size_t column) const {
  long long value = 0;
  if (!read(cells_[column], value)) fail(column, "a whole number");
  return value;
}

bool CsvReader::flag(std::size_t column) const {
  const long long value = integer(column);
  if (value != 0 && value != 1) fail(column, "0 or 1");
  return value == 1;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r#") == text.npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::string printable_csv_cell(const std::string& text) {
  return csv_cell(printable(text, "\n\t"));
}

}  // namespace wearwell
