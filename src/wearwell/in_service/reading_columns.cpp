#include "wearwell/in_service/reading_columns.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/in_service/table_headings.h"
#include "wearwell/input/heading.h"
#include "wearwell/prognosis/change_watch.h"

namespace wearwell::in_service {
namespace {

std::vector<std::string> headings_of(const std::vector<fleet::EngineColumn>& known) {
  std::vector<std::string> headings;
  for (const fleet::EngineColumn& each : known) headings.push_back(each.name);
  return headings;
}

bool has_heading(const std::vector<std::string>& headings, const std::string& name) {
  return std::find(headings.begin(), headings.end(), name) != headings.end();
}

class ReadingColumnReader {
 public:
  ReadingColumnReader(const std::vector<std::string>& options,
                      const std::vector<fleet::EngineColumn>& known,
                      const prognosis::Tracker& tracker, const std::string& source)
      : known_(known), headings_(headings_of(known)), tracker_(tracker), source_(source) {
    std::vector<std::string> names = {"unit"};
    for (const prognosis::ReadingColumn& each : tracker.columns()) names.push_back(each.name);
    for (const std::string& each : tracker.labels()) names.push_back(each);
    given_ = fleet::split_columns(options, names);
  }

  std::string unit() const {
    if (const auto at = given_.find("unit"); at != given_.end()) return required(at->second, false);
    if (has_heading(headings_, "unit")) return "unit";
    const std::string& noun = tracker_.noun();
    fail_without_column("unit", has_heading(headings_, noun) ? "unit=" + noun : "unit=COLUMN",
                        headings_, source_);
  }

  std::string label(const std::string& name) const {
    if (const auto at = given_.find(name); at != given_.end()) return required(at->second, false);
    if (has_heading(headings_, name)) return name;
    fail_without_column(name, name + "=COLUMN", headings_, source_);
  }

  fleet::UnitColumn number(const prognosis::ReadingColumn& wanted) const {
    const std::string& si = wanted.unit.text;
    const std::string hint =
        si == "1" ? wanted.name + "=COLUMN" : fmt::format("'{}=COLUMN:{}'", wanted.name, si);
    fleet::UnitColumn column;
    if (const auto at = given_.find(wanted.name); at != given_.end()) {
      column = fleet::column_with_unit(wanted.name, at->second, si);
    } else if (has_column(headings_, wanted.name, si)) {
      column = column_by_heading(headings_, wanted.name, si, source_);
      // Counts may stand without a unit; here they could be of lives or of single cycles.
      if (si != "1" && read_heading(column.column, si).unit.empty())
        throw InputError(fmt::format("{}: the column '{}' has no unit: write --columns {}", source_,
                                     printable(column.column), hint));
    } else if (wanted.carried) {
      return {};
    } else {
      const bool axis = wanted.name == tracker_.axis().name && has_column(headings_, "age", si);
      fail_without_column(
          wanted.name,
          axis ? hint + "; for ages in place of readings leave out the measured column" : hint,
          headings_, source_);
    }
    required(column.column, true);
    return column;
  }

  char text_decimal() const {
    char mark = 0;
    for (const fleet::EngineColumn& each : known_)
      if (each.text_decimal != 0) mark = each.text_decimal;
    return mark;
  }

 private:
  std::string required(const std::string& column, bool is_number) const {
    fleet::require_column(known_, column, source_, is_number);
    return column;
  }

  const std::vector<fleet::EngineColumn>& known_;
  const std::vector<std::string> headings_;
  const prognosis::Tracker& tracker_;
  const std::string& source_;
  std::map<std::string, std::string> given_;
};

}  // namespace

bool has_readings(const std::vector<std::string>& options,
                  const std::vector<fleet::EngineColumn>& known,
                  const prognosis::Tracker& tracker) {
  const auto level = prognosis::watched_columns(tracker).level;
  if (!level) return false;
  const prognosis::ReadingColumn& measured = tracker.columns()[*level];
  return has_column(headings_of(known), measured.name, measured.unit.text) ||
         std::any_of(options.begin(), options.end(), [&](const std::string& each) {
           return each.starts_with(measured.name + "=");
         });
}

ReadingColumns read_reading_columns(const std::vector<std::string>& options,
                                    const std::vector<fleet::EngineColumn>& known,
                                    const prognosis::Tracker& tracker, const std::string& source) {
  const ReadingColumnReader reader(options, known, tracker, source);
  ReadingColumns columns;
  columns.unit = reader.unit();
  for (const prognosis::ReadingColumn& each : tracker.columns())
    columns.numbers.push_back(reader.number(each));
  for (const std::string& each : tracker.labels()) columns.labels.push_back(reader.label(each));
  columns.text_decimal = reader.text_decimal();
  return columns;
}

}  // namespace wearwell::in_service
