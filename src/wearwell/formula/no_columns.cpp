#include "wearwell/formula/no_columns.h"

namespace wearwell::formula {

Data bind_no_columns(const Program& program, const Symbols& symbols) {
  Rows row;
  row.count = 1;
  row.columns.resize(symbols.columns.size());
  row.labels.resize(symbols.labels.size());
  return program.bind(row);
}

}  // namespace wearwell::formula
