#include "wearwell/prognosis/matched_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "wearwell/base/contains.h"
#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/input/as_read.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/heading.h"

namespace wearwell::prognosis {
namespace {

// The unit of a column: in a row of units, in the study, or in the heading.
std::string unit_of(const Column& column, const std::string& said) {
  if (!said.empty()) return said;
  return column.unit.empty() ? read_heading(column.name, "").unit : bare_unit(column.unit);
}

class Matching {
 public:
  Matching(const Table& fresh, const DataRoles& roles, const std::vector<std::string>& needed,
           Table& like)
      : fresh_(fresh), roles_(roles), needed_(needed), like_(like) {}

  MatchedRows matched() {
    found_.table.source = fresh_.source;
    found_.table.rows = fresh_.rows;
    for (Column& like : like_.columns) {
      const Column* const column = column_for(like);
      found_.given.push_back(column != nullptr);
      if (!column) {
        add_empty(like);
      } else if (words(like, *column)) {
        add_words(*column, like);
      } else {
        add_numbers(*column, like);
      }
      if (column) taken_.push_back(column->name);
    }
    for (const Column& each : fresh_.columns) {
      if (!contains(taken_, each.name))
        found_.notes.push_back(
            fmt::format("column '{}' is not in the study's data and is ignored", each.name));
    }
    return std::move(found_);
  }

 private:
  const DataRoles::Named* named(const Column& like) const {
    for (const DataRoles::Named& each : roles_.used) {
      if (each.column == like.name) return &each;
    }
    return nullptr;
  }

  // By its heading, or else the only one with its name.
  const Column* column_for(const Column& like) const {
    std::vector<std::string> headings;
    const Column* of_name = nullptr;
    const DataRoles::Named* const as = named(like);
    const std::string name = read_heading(like.name, "").name;
    for (const Column& each : fresh_.columns) {
      if (each.name == like.name) return &each;
      headings.push_back(each.name);
      const std::string own = read_heading(each.name, "").name;
      if (own != name && own != like.name && !(as && own == as->name)) continue;
      if (of_name)
        throw InputError(fmt::format("{}: column '{}' may be '{}' or '{}'; keep one", fresh_.source,
                                     like.name, of_name->name, each.name));
      of_name = &each;
    }
    if (!of_name && contains(needed_, like.name))
      throw InputError(fmt::format("{} has no column '{}', which the study reads (nearest: '{}')",
                                   fresh_.source, like.name, nearest_name(like.name, headings)));
    return of_name;
  }

  bool words(const Column& like, const Column& column) const {
    if (!holds_numbers(like)) return true;
    return !column.is_number && contains(roles_.words, like.name);
  }

  void add_empty(const Column& like) {
    Column column{like.name, like.is_number, {}, {}};
    column.is_number ? column.numbers.assign(fresh_.rows, NAN)
                     : column.text.assign(fresh_.rows, "");
    found_.table.columns.push_back(std::move(column));
  }

  void add_words(const Column& from, Column& like) {
    Column column{like.name, false, {}, {}};
    for (std::size_t i = 0; i < fresh_.rows; ++i) column.text.push_back(cell_word(from, i));
    if (like.is_number) {
      for (std::size_t i = 0; i < like_.rows; ++i) like.text.push_back(cell_word(like, i));
      like.numbers.clear();
      like.is_number = false;
    }
    found_.table.columns.push_back(std::move(column));
  }

  // A value of `from` in the units of `like`.
  struct Way {
    double scale = 1, offset = 0;
    bool same = true;
  };

  Way way(const Column& from, const Column& like) {
    const DataRoles::Named* const as = named(like);
    if (from.name == like.name && bare_unit(from.unit) == bare_unit(like.unit)) return {};
    const std::string to_text = unit_of(like, as ? as->unit : ""), from_text = unit_of(from, "");
    if (to_text == from_text) return {};
    const auto to = parse_unit(to_text), own = parse_unit(from_text);
    if (to_text.empty() || from_text.empty() || !to || !own)
      throw InputError(fmt::format(
          "{}, column '{}': {} {}; the study's data have '{}'{}. Write the heading in that form",
          fresh_.source, from.name, from_text.empty() ? "has no unit" : "is in",
          from_text.empty() ? "and may be in any unit" : from_text, like.name,
          to_text.empty() ? ", without a unit" : " in " + to_text));
    if (to->dimension != own->dimension || !to->linear || !own->linear)
      throw InputError(
          fmt::format("{}, column '{}' is in {}, and the study's '{}' in {}: these units have "
                      "different dimensions",
                      fresh_.source, from.name, from_text, like.name, to_text));
    found_.notes.push_back(
        fmt::format("column '{}' was converted from {} to {}", from.name, from_text, to_text));
    return {own->scale / to->scale, (own->offset - to->offset) / to->scale, false};
  }

  void add_numbers(const Column& from, Column& like) {
    if (!like.is_number) as_numbers(like);
    const Way way = this->way(from, like);
    Column column{like.name, true, {}, {}};
    for (std::size_t i = 0; i < fresh_.rows; ++i) {
      const double value = cell_number(fresh_, from, i);
      // Rounds to decimal digits: 16.7 um becomes 0.0167 mm.
      column.numbers.push_back(
          way.same ? value
                   : std::strtod(fmt::format("{:.15g}", way.offset + way.scale * value).c_str(),
                                 nullptr));
    }
    found_.table.columns.push_back(std::move(column));
  }

  void as_numbers(Column& like) const {
    for (std::size_t i = 0; i < like_.rows; ++i)
      like.numbers.push_back(cell_number(like_, like, i));
    like.text.clear();
    like.marks.reset();
    like.is_number = true;
  }

  const Table& fresh_;
  const DataRoles& roles_;
  const std::vector<std::string>& needed_;
  Table& like_;
  MatchedRows found_;
  std::vector<std::string> taken_;
};

}  // namespace

MatchedRows matched_rows(const Table& fresh, const DataRoles& roles,
                         const std::vector<std::string>& needed, Table& like) {
  return Matching(fresh, roles, needed, like).matched();
}

}  // namespace wearwell::prognosis
