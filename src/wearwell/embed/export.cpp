#include "wearwell/embed/export.h"

#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/embed/fork_guard.h"
#include "wearwell/embed/plan_arguments.h"
#include "wearwell/models/formula_model/export_files.h"

namespace wearwell::embed {
namespace {

// Runs `work` of read arguments; messages name these.
template <class Answer, class Read, class Work>
Answer answered(const char* function, const std::string& arguments, const Read& read,
                const Work& work) {
  const ForkGuard guard;
  const auto json = nlohmann::ordered_json::parse(arguments, nullptr, false);
  if (json.is_discarded()) throw InputError(std::string(function) + ": an argument is not Unicode");
  PlanArguments reading(function, json);
  read(reading);
  reading.finish();
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(reading.in_arguments(error.what()));
  }
}

}  // namespace

CCode export_c(const Fitted& fitted, const std::string& arguments) {
  constexpr std::size_t least_lines = 16, most_lines = 20'000;
  formula_model::CExportChoice choice;
  return answered<CCode>(
      "export_c", arguments,
      [&](PlanArguments& reading) {
        reading.text("name", choice.name);
        reading.text("unit", choice.unit);
        reading.whole("lines", choice.lines, least_lines, most_lines);
      },
      [&] {
        const prognosis::CarriedState state = state_of(fitted);
        formula_model::require_formula_state(state, fitted.name(), "C");
        const formula_model::CExport made =
            formula_model::c_export(state, choice, WEARWELL_VERSION);
        return CCode{formula_model::c_files(made, choice.name), formula_model::c_sizes(made),
                     state.trusted};
      });
}

SqlCode export_sql(const Fitted& fitted, const std::string& arguments) {
  formula_model::SqlExportChoice choice;
  std::string dialect, part = "all";
  return answered<SqlCode>(
      "export_sql", arguments,
      [&](PlanArguments& reading) {
        reading.text("dialect", dialect);
        reading.text("table", choice.table);
        reading.text("value", choice.value);
        reading.text("unit", choice.unit);
        reading.texts("columns", choice.columns);
        reading.texts("keep", choice.keep);
        reading.text("prefix", choice.prefix);
        reading.whole("draws", choice.draws);
        reading.text("part", part);
      },
      [&] {
        const prognosis::CarriedState state = state_of(fitted);
        formula_model::require_formula_state(state, fitted.name(), "SQL");
        choice.dialect = fleet::read_dialect(dialect);
        const formula_model::SqlExport made = formula_model::sql_export(state, choice);
        return SqlCode{formula_model::sql_script(made, choice, part, WEARWELL_VERSION),
                       state.trusted};
      });
}

}  // namespace wearwell::embed
