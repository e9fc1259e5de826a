#pragma once

#include <string>

#include "wearwell/embed/fitted.h"

namespace wearwell::embed {

/// A formula model as C: header, source and test, and what `wearwell export c` prints of sizes.
struct CCode {
  Files files;
  std::string text;
  bool trusted = true;
};
/// `arguments`: a JSON object with name, unit and lines. Throws InputError.
CCode export_c(const Fitted& fitted, const std::string& arguments);

/// What `wearwell export sql` prints.
struct SqlCode {
  std::string text;
  bool trusted = true;
};
/// `arguments`: a JSON object with dialect, table, value, unit, columns, keep, prefix, draws, part.
/// Throws InputError.
SqlCode export_sql(const Fitted& fitted, const std::string& arguments);

}  // namespace wearwell::embed
