#pragma once

#include <string>
#include <utility>
#include <vector>

#include "wearwell/models/formula_model/c_export.h"
#include "wearwell/models/formula_model/sql_export.h"

namespace wearwell::formula_model {

/// Throws InputError that names the result and its model unless it is a formula model. `language`:
/// "C", "SQL".
void require_formula_state(const prognosis::CarriedState& state, const std::string& result,
                           const std::string& language);

/// Header, source and test of an export as C: name and content.
std::vector<std::pair<std::string, std::string>> c_files(const CExport& made,
                                                         const std::string& name);

/// Sizes of an export as C, as text, ending with a newline.
std::string c_sizes(const CExport& made);

/// The statements of an export as SQL, with comments: `part` is "all", "setup" or "query". Throws
/// InputError that begins with "--part" for another one.
std::string sql_script(const SqlExport& made, const SqlExportChoice& choice,
                       const std::string& part, const std::string& version);

}  // namespace wearwell::formula_model
