#include "wearwell/prognosis/doubted_rows.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/error.h"

namespace wearwell::prognosis {

void refuse_doubted_rows(const Table& fresh, const Table& of_study) {
  const auto is_mark = [](const Column& column) { return column.name == "doubt"; };
  if (std::any_of(of_study.columns.begin(), of_study.columns.end(), is_mark)) return;
  for (const Column& column : fresh.columns) {
    if (!is_mark(column) || !column.is_number) continue;
    const auto doubted = std::count(column.numbers.begin(), column.numbers.end(), 1.0);
    if (doubted == 0) continue;
    throw InputError(fmt::format(
        "{}: {} of {} rows have doubt = 1: the monitor found that these readings do not follow the "
        "forecast of their unit. Remove these rows, or the column to learn from all of them",
        fresh.source, doubted, fresh.rows));
  }
}

}  // namespace wearwell::prognosis
