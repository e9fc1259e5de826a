#include "wearwell/input/column_evidence.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/unit_system.h"
#include "wearwell/input/cell_text.h"
#include "wearwell/input/heading.h"
#include "wearwell/input/table.h"

namespace wearwell {

bool ColumnEvidence::agrees_with(const NumberMarks& with) const {
  const std::size_t other = with.decimal == '.';
  if (shows(other)) return false;
  const auto may_be = [&](char mark) {
    return mark != with.decimal && (with.thousands == '*' || with.thousands == mark);
  };
  return std::all_of(thousands.begin(), thousands.end(), may_be) &&
         (!doubtful[other] || may_be(decimal_signs[other]));
}

void look_at(std::string_view cell, std::size_t row, std::size_t line, ColumnEvidence& seen) {
  NumberForm form = number_form(cell);
  if (form.kind == NumberForm::Kind::empty) return;
  const auto note = [&](std::optional<CellWitness>& witness) {
    if (!witness) witness = {row, line, std::string(cell)};
  };
  if (form.kind == NumberForm::Kind::text) {
    if (is_missing_mark(cell)) {
      note(seen.missing);
      ++seen.missing_cells;
      return;
    }
    const auto found = cell_text(cell);
    if (!found) {
      seen.any_text = true;
      return;
    }
    if (found->sign) {
      note(seen.limit);
      ++seen.limits;
    }
    if (found->number.empty()) return;
    form = number_form(found->number);
    const std::string unit(found->unit);
    if (unit.empty()) {
      note(seen.bare);
    } else if (!seen.with_unit) {
      note(seen.with_unit);
      seen.unit = unit;
    } else if (unit != seen.unit) {
      note(seen.other_unit);
    }
    cell = found->number;
  } else if (!seen.bare) {
    note(seen.bare);
  }
  seen.any_number = true;
  if (form.doubtful) note(seen.doubtful[mark_place(form.doubtful)]);
  if (form.decimal) note(seen.decimal[mark_place(form.decimal)]);
  if (form.thousands) seen.thousands.insert(form.thousands);
  // The thousands separator cannot be the decimal mark.
  if (form.thousands == '.' && !form.decimal) note(seen.decimal[1]);
  if (form.thousands == ',' && !form.decimal) note(seen.decimal[0]);
  if (form.thousands || cell.front() == '+' || static_cast<unsigned char>(cell.front()) >= 0x80 ||
      static_cast<unsigned char>(cell.back()) >= 0x80)
    seen.other_signs = true;
}

namespace {

std::string at(const CellWitness& witness, const std::string& column) {
  return fmt::format("{}, column '{}'", row_name(witness.row, witness.line), column);
}

}  // namespace

char shown_by_all(const std::vector<ColumnEvidence>& all) {
  bool shown[2] = {};
  for (const ColumnEvidence& each : all) {
    if (each.any_text) continue;
    for (const std::size_t m : {0u, 1u}) shown[m] = shown[m] || each.shows(m);
  }
  return shown[0] && shown[1] ? '?' : shown[0] ? '.' : shown[1] ? ',' : 0;
}

namespace {

const CellWitness& witness_of(const std::vector<ColumnEvidence>& all, std::size_t mark) {
  for (const ColumnEvidence& each : all) {
    if (!each.any_text && each.shows(mark)) return *each.decimal[mark];
  }
  return *all.front().decimal[mark];  // called only if there is one
}

}  // namespace

void decide_marks(const ColumnEvidence& seen, char of_all, const std::vector<ColumnEvidence>& all,
                  char delimiter, const TableSettings& settings, TextColumn& column) {
  column.is_number = seen.any_number && !seen.any_text && !seen.limit && !seen.with_unit;
  column.marks.thousands = settings.thousands.value_or('*');
  const auto is_set = [&](char decimal) {
    column.marks.decimal = decimal;
    column.is_number = column.is_number && seen.agrees_with(column.marks);
  };
  if (settings.decimal) return is_set(*settings.decimal);
  if (settings.thousands == '.') return is_set(',');
  if (settings.thousands == ',') return is_set('.');
  if (seen.shows(0) && seen.shows(1)) {
    const CellWitness &point = *seen.decimal[0], &comma = *seen.decimal[1];
    const bool first = comma.row < point.row;
    column.doubt = fmt::format(
        "{}: '{}' has a decimal {} and '{}' in row {} a decimal {}; a column must have one decimal "
        "mark (state it in [data], for example decimal = \".\")",
        at(first ? point : comma, column.name), (first ? point : comma).cell,
        first ? "point" : "comma", (first ? comma : point).cell, (first ? comma : point).row,
        first ? "comma" : "point");
    return;
  }
  if (seen.shows(0) || seen.shows(1)) {
    column.marks.decimal = decimal_signs[seen.shows(1)];
    return;
  }
  if (!seen.doubtful[0] && !seen.doubtful[1]) {
    // Whole numbers get the mark of the other columns, for messages.
    column.marks.decimal = of_all == ',' ? ',' : '.';
    return;
  }
  const auto doubt = [&](const std::string& why) {
    const CellWitness& witness = *seen.doubtful[seen.doubtful[0] ? 0 : 1];
    column.doubt =
        fmt::format("{}: {}{}; or state the decimal mark in [data], for example decimal = \",\"",
                    at(witness, column.name), two_readings(witness.cell), why);
  };
  const auto others = [&](std::size_t mark) {
    const CellWitness& other = witness_of(all, mark);
    return fmt::format(" (the file has '{}', with a decimal {})", other.cell,
                       mark ? "comma" : "point");
  };
  if (seen.doubtful[0] && seen.doubtful[1]) return doubt("");
  if (of_all == '?') return doubt(others(seen.doubtful[0] ? 1 : 0));
  // Most files with commas between columns use the decimal point.
  if (of_all == ',' && seen.doubtful[0] && delimiter == ',') return doubt(others(1));
  if (of_all == 0 && seen.doubtful[0] && delimiter == ',') {
    column.marks.decimal = '.';
  } else if (of_all == 0) {
    doubt("");
  } else {
    column.marks.decimal = of_all;
  }
}

bool is_settled(const std::vector<ColumnEvidence>& all, char delimiter) {
  const char of_all = shown_by_all(all);
  if (of_all != '.' && !(of_all == 0 && delimiter == ',')) return false;
  return std::none_of(all.begin(), all.end(), [](const ColumnEvidence& each) {
    return each.shows(1) || each.doubtful[1] || each.other_signs || each.missing || each.limit ||
           each.with_unit || (each.doubtful[0] && !each.shows(0));
  });
}

void decide_unit(const ColumnEvidence& seen, TextColumn& column) {
  if (!seen.with_unit || seen.any_text || !column.doubt.empty()) return;
  const CellWitness& first = *seen.with_unit;
  const auto refuse = [&](const CellWitness& other, const std::string& has) {
    column.doubt = fmt::format(
        "{}: '{}' has the unit {} and '{}' in {} has {}; write all numbers of a column in one "
        "unit, and state it once in the heading: '{} [{}]'",
        at(first, column.name), first.cell, seen.unit, other.cell, row_name(other.row, other.line),
        has, column.name, seen.unit);
  };
  if (seen.other_unit) return refuse(*seen.other_unit, "another");
  if (seen.bare) return refuse(*seen.bare, "none");
  const std::string above =
      !column.unit.empty() ? bare_unit(column.unit) : read_heading(column.name, "").unit;
  const auto heading = parse_unit(above), cells = parse_unit(seen.unit);
  if (!above.empty() && heading && cells &&
      (heading->dimension != cells->dimension || heading->scale != cells->scale)) {
    column.doubt =
        fmt::format("{}: '{}' is in {}, and the column is in {} by its {}; which is right?",
                    at(first, column.name), first.cell, seen.unit, above,
                    column.unit.empty() ? "heading" : "row of units");
    return;
  }
  column.unit = seen.unit;
  column.unit_in_cells = true;
}

}  // namespace wearwell
