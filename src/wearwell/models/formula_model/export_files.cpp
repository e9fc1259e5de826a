#include "wearwell/models/formula_model/export_files.h"

#include <fmt/format.h>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/present/text_table.h"

namespace wearwell::formula_model {

void require_formula_state(const prognosis::CarriedState& state, const std::string& result,
                           const std::string& language) {
  if (state.model != "formula")
    throw InputError(
        fmt::format("{}: {} export needs a study of model \"formula\"; this one is of model \"{}\"",
                    result, language, printable(state.model)));
}

std::vector<std::pair<std::string, std::string>> c_files(const CExport& made,
                                                         const std::string& name) {
  return {{name + "_unit.h", made.header},
          {name + "_unit.c", made.source},
          {name + "_test.c", made.test}};
}

std::string c_sizes(const CExport& made) {
  return fmt::format("{} nodes on {} lines, effective sample size {:.0f} at the start\n",
                     made.nodes, made.lines, made.effective) +
         text_table({{"", "bytes"},
                     {"  tables, read only", fmt::format("{}", made.table_bytes)},
                     {"  per unit", fmt::format("{}", made.unit_bytes)},
                     {"  scratch, shared by all units", fmt::format("{}", made.scratch_bytes)}});
}

std::string sql_script(const SqlExport& made, const SqlExportChoice& choice,
                       const std::string& part, const std::string& version) {
  if (part != "all" && part != "setup" && part != "query")
    throw InputError(
        fmt::format("--part: {} is neither 'all', 'setup' nor 'query'", printable(part)));
  std::string text = fleet::comment(fmt::format("wearwell {}: {} [{}] of each row of {}, for {}",
                                                version, made.expression, made.unit, choice.table,
                                                fleet::name_of(choice.dialect)));
  if (part != "query") {
    const bool whole = choice.dialect != fleet::Dialect::clickhouse;
    text += fmt::format("{}{}{}", whole ? "begin;\n" : "", made.setup, whole ? "commit;\n" : "");
  }
  if (part != "setup")
    text += fmt::format(
        "-- 2. Query: quantiles over the draws at 5, 50 and 95 %, each the mean of two order "
        "statistics; measurement scatter is not included.\n"
        "{};\n",
        made.query);
  return text;
}

}  // namespace wearwell::formula_model
