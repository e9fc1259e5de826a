#include "wearwell/input/sheet_numbers.h"

#include <fmt/format.h>

#include "wearwell/input/cell_text.h"
#include "wearwell/input/number_text.h"

namespace wearwell {
namespace {

std::string_view number_part(const std::string& cell) {
  if (number_form(cell).kind == NumberForm::Kind::number) return cell;
  const auto found = cell_text(cell);
  return found ? found->number : std::string_view();
}

}  // namespace

SheetNumbers::SheetNumbers(const TableSettings& settings) {
  if (settings.decimal) said_ = *settings.decimal;
  if (settings.thousands == '.') said_ = ',';
  if (settings.thousands == ',') said_ = '.';
}

void SheetNumbers::look_at(std::size_t column, std::size_t row, const std::string& cell) {
  const std::string_view number = number_part(cell);
  if (number.empty()) return;
  const NumberForm form = number_form(number);
  char shown = form.decimal;
  // The thousands separator cannot be the decimal mark.
  if (!shown && form.thousands == '.') shown = ',';
  if (!shown && form.thousands == ',') shown = '.';
  if (!shown && !form.doubtful) return;
  Evidence& seen = columns_[column];
  std::optional<Witness>& witness = form.doubtful  ? seen.doubtful
                                    : shown == ',' ? seen.comma
                                                   : seen.point;
  if (!witness) witness = {row, cell};
  any_point_ = any_point_ || shown == '.';
  any_comma_shown_ = any_comma_shown_ || shown == ',';
}

char SheetNumbers::mark_of(const Evidence& evidence) const {
  if (said_) return said_;
  if (evidence.point || evidence.comma)
    return evidence.point && evidence.comma ? '\0' : evidence.comma ? ',' : '.';
  return any_point_ == any_comma_shown_ ? '\0' : any_comma_shown_ ? ',' : '.';
}

std::string SheetNumbers::rewritten(std::size_t column, const std::string& cell) {
  const auto seen = columns_.find(column);
  const std::string_view number = number_part(cell);
  if (number.empty() || seen == columns_.end()) return cell;
  const char mark = mark_of(seen->second);
  if (!mark) return cell;
  const auto plain = plain_number(number, {mark, '*'});
  if (!plain) return cell;
  any_comma_ = any_comma_ || (mark == ',' && *plain != number);
  const auto begin = static_cast<std::size_t>(number.data() - cell.data());
  return cell.substr(0, begin) + *plain + cell.substr(begin + number.size());
}

std::map<std::size_t, std::string> SheetNumbers::doubts() const {
  std::map<std::size_t, std::string> all;
  for (const auto& [column, seen] : columns_) {
    if (mark_of(seen)) continue;
    if (seen.point && seen.comma) {
      all[column] = fmt::format(
          "the text '{}' in row {} of the sheet has a decimal comma and '{}' in row {} a decimal "
          "point; a column must have one decimal mark (state it in [data], for example decimal = "
          "\",\")",
          seen.comma->cell, seen.comma->row, seen.point->cell, seen.point->row);
    } else if (seen.doubtful) {
      all[column] = fmt::format(
          "row {} of the sheet: the text {}; or state the decimal mark in [data], for example "
          "decimal = \",\"",
          seen.doubtful->row, two_readings(number_part(seen.doubtful->cell)));
    }
  }
  return all;
}

}  // namespace wearwell
