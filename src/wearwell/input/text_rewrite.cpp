#include "wearwell/input/text_rewrite.h"

#include <algorithm>

#include "wearwell/input/cell_text.h"
#include "wearwell/input/csv_reader.h"
#include "wearwell/input/memory_text.h"
#include "wearwell/input/text_records.h"

namespace wearwell {

std::unique_ptr<TableFile> rewritten(const TableFile& file, const TextLayout& layout,
                                     std::vector<std::size_t>& lines) {
  MemoryText out;
  std::string row;
  const std::size_t columns = layout.columns.size();
  for (std::size_t c = 0; c < columns; ++c)
    row += (c ? "," : "") + csv_cell(layout.columns[c].name);
  out.add_line(row);
  TextLines text(file.path(), file.source(), layout.encoding);
  TextRecords records(text, layout.delimiter, layout.comment, layout.heading_line);
  records.next();
  if (layout.units_row) records.next();
  while (records.next()) {
    if (layout.summary_line && records.line() >= *layout.summary_line) break;
    const auto& cells = records.cells();
    row.clear();
    bool any = false;
    for (std::size_t c = 0; c < columns; ++c) {
      if (c) row += ',';
      const std::string_view cell = c < cells.size() ? cells[c] : std::string_view();
      if (cell.empty()) continue;
      any = true;
      const TextColumn& column = layout.columns[c];
      if (column.is_number && column.doubt.empty()) {
        if (is_missing_mark(cell)) continue;
        row += plain_number(cell, column.marks).value_or(csv_cell(std::string(cell)));
      } else {
        row += csv_cell(std::string(cell));
      }
    }
    if (!any) continue;
    out.add_line(row);
    lines.push_back(records.line());
  }
  return out.table(file.source());
}

}  // namespace wearwell
