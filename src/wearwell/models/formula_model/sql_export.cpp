#include "wearwell/models/formula_model/sql_export.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/sha1.h"
#include "wearwell/models/formula_model/formula_drawn.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/formula_sql.h"
#include "wearwell/models/formula_model/node_rows.h"
#include "wearwell/models/formula_model/rate_change.h"
#include "wearwell/models/formula_model/sql_statements.h"
#include "wearwell/models/formula_model/unit_nodes.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t most_numbers = 2'000'000;

/// The nodes at even steps of the cumulative weight. Sorted along the effect, if there is one: then
/// quantities monotone in it have nearly the same quantiles as over all nodes.
Nodes draws_of(const Nodes& nodes, const std::vector<double>& weight, std::size_t count) {
  Nodes drawn;
  auto values =
      std::make_shared<Points>(static_cast<Eigen::Index>(count), nodes.parameters->cols());
  std::vector<std::size_t> order(weight.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!nodes.effect[0].empty())
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return nodes.effect[0][a] < nodes.effect[0][b];
    });
  std::size_t at = 0;
  double sum = weight[order[0]];
  for (std::size_t i = 0; i < count; ++i) {
    const double until = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    while (sum < until && at + 1 < order.size()) sum += weight[order[++at]];
    const std::size_t node = order[at];
    values->row(static_cast<Eigen::Index>(i)) =
        nodes.parameters->row(static_cast<Eigen::Index>(node / nodes.per_line));
    for (std::size_t e = 0; e < 2; ++e)
      if (!nodes.effect[e].empty()) drawn.effect[e].push_back(nodes.effect[e][node]);
  }
  drawn.parameters = values;
  return drawn;
}

/// Of a unit of the study with rows `seen`, or of a new one.
Nodes draws_of(const NodePopulation& population, const NodeRows& rows,
               const std::vector<UnitReading>& seen, std::size_t count) {
  const UnitNodes laid = place_nodes(population, seen, seen, {});
  std::vector<double> log_weight = laid.log_before, value(log_weight.size()), weight;
  auto path = rows.paths();
  for (const UnitReading& each : seen) {
    auto after = path;
    rows.look(laid.nodes, each, path, &after, value, nullptr, nullptr);
    path = std::move(after);
    for (std::size_t i = 0; i < log_weight.size(); ++i) log_weight[i] += value[i];
  }
  normalize(log_weight, weight);
  return draws_of(laid.nodes, weight, count);
}

/// "force=F:kN", by the study's name.
std::map<std::string, std::string> named_columns(const std::vector<std::string>& options,
                                                 const std::vector<std::string>& names) {
  std::map<std::string, std::string> given;
  for (const std::string& option : options) {
    const std::size_t equals = option.find('=');
    const std::string name = option.substr(0, equals);
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw InputError(fmt::format("--columns: the value does not depend on '{}', but on {}",
                                   printable(name), fmt::join(names, ", ")));
    if (equals == option.npos || equals + 1 == option.size())
      throw InputError(fmt::format("--columns: '{0}' has no column: write '{0}=COLUMN'", name));
    if (!given.emplace(name, option.substr(equals + 1)).second)
      throw InputError(fmt::format("--columns: '{}' occurs twice", name));
  }
  return given;
}

class Exporter {
 public:
  Exporter(const prognosis::CarriedState& state, const SqlExportChoice& choice)
      : choice_(choice),
        root_(TomlReader::parse(state.source.study)),
        model_(read_formula_model(root_, state.source)),
        population_(model_, state.posterior) {
    refuse_unsupported(*model_, "exported");
    refuse_rate_change(root_);
    // Speed does not matter here.
    population_.few = population_.many;
    if (model_->has_process())
      throw InputError(
          "the study's readings have random increments: the position of a unit is not a function "
          "of a row; SQL export does not support it");
    if (choice.draws < 20 || choice.draws % 20 != 0 || choice.draws > 100'000)
      throw InputError("--draws: must be a multiple of 20, from 20 to 100000");
  }

  SqlExport make() {
    read_value();
    sql_ = formula_sql(model_->lines, out_.wanted, model_->row_symbols, choice_.dialect);
    if (sql_.steps.back().drawn.empty())
      throw InputError(fmt::format("'{}' contains no parameter of the study", out_.expression));
    read_columns();
    draw();
    SqlStatements statements{sql_, choice_, columns_, unit_column_,
                             {},   {},      answer_,  out_.units.size() > 1};
    add_rows(statements);
    out_.setup = statements.setup();
    out_.query = statements.query();
    return std::move(out_);
  }

 private:
  void read_value() {
    const Measured& measured = model_->measured.front();
    out_.wanted = {"--value", choice_.value, {}, {}};
    if (choice_.value.empty()) {
      for (std::size_t o = measured.wanted.size(); o-- > 0;)
        if (measured.form->family_parameters[measured.family_parameter[o]].kind ==
            ParameterKind::location)
          out_.wanted = measured.wanted[o];
      if (out_.wanted.text.empty())
        throw InputError(
            fmt::format("the {} family has no parameter that is a value of '{}': give the "
                        "expression with --value",
                        measured.form->name, measured.column));
    }
    const formula::Program program =
        formula::compile(model_->lines, {out_.wanted}, model_->row_symbols);
    const formula::Powers& powers = program.outputs()[0].powers;
    out_.expression = program.text(0);
    answer_ = {powers.empty() ? "1" : formula::description(powers), 1, 0};
    if (powers == measured.powers && choice_.value.empty()) answer_ = measured.unit;
    if (!choice_.unit.empty()) {
      const formula::AnyUnit unit = formula::read_any_unit(choice_.unit);
      if (unit.powers != powers)
        throw InputError(fmt::format("--unit: '{}' is {}, but {} is {}", printable(choice_.unit),
                                     formula::description(unit.powers), out_.expression,
                                     formula::description(powers)));
      answer_ = unit.unit;
    }
    out_.unit = answer_.text;
  }

  void read_columns() {
    std::vector<std::string> names;
    for (const std::size_t c : sql_.columns) names.push_back(model_->row_symbols.columns[c].name);
    for (const std::size_t l : sql_.labels) names.push_back(model_->row_symbols.labels[l].name);
    if (model_->has_random_effects() &&
        std::find(names.begin(), names.end(), *model_->label) == names.end())
      names.push_back(*model_->label);
    const auto given = named_columns(choice_.columns, names);
    for (const std::size_t c : sql_.columns) {
      const std::string& name = model_->row_symbols.columns[c].name;
      const NumberColumn& number = *model_->data.number(name);
      const auto at = given.find(name);
      columns_.push_back(at == given.end() ? SqlInput{fmt::format("formula_x{}", c), number.column,
                                                      number.unit.unit}
                                           : with_unit(c, at->second, number));
    }
    const auto label_column = [&](const std::string& name) {
      const auto at = given.find(name);
      return at == given.end() ? model_->data.label(name)->column : at->second;
    };
    for (const std::size_t l : sql_.labels) {
      const formula::LabelSymbol& label = model_->row_symbols.labels[l];
      // A new unit has a name that the study does not know.
      SqlInput input{fmt::format("formula_l{}", l), label_column(label.name), Unit{"1", 1, 0},
                     true};
      if (label.name != model_->label) input.levels = label.levels;
      columns_.push_back(std::move(input));
    }
    if (model_->has_random_effects()) unit_column_ = label_column(*model_->label);
  }

  static SqlInput with_unit(std::size_t c, const std::string& text, const NumberColumn& number) {
    const std::size_t colon = text.rfind(':');
    if (colon == text.npos) {
      if (!number.unit.powers.empty())
        throw InputError(fmt::format("--columns: '{0}={1}' has no unit: write '{0}={1}:{2}'",
                                     number.name, printable(text), number.unit.unit.text));
      return {fmt::format("formula_x{}", c), text, {"1", 1, 0}};
    }
    const formula::AnyUnit unit = formula::read_any_unit(text.substr(colon + 1));
    if (unit.powers != number.unit.powers)
      throw InputError(fmt::format("--columns: '{}' is {}, but {} is {}",
                                   printable(text.substr(colon + 1)),
                                   formula::description(unit.powers), number.name,
                                   formula::description(number.unit.powers)));
    return {fmt::format("formula_x{}", c), text.substr(0, colon), unit.unit};
  }

  void draw() {
    const NodeRows rows(model_, {});
    const ReadingReader reader(model_);
    const std::size_t known = model_->has_random_effects() ? model_->units.size() : 0;
    const std::size_t numbers = sql_.parameters.size() + sql_.effects.size();
    if ((known + 1) * choice_.draws * numbers > most_numbers)
      throw InputError(fmt::format(
          "{} units with {} draws of {} numbers exceed the maximum of {}: use fewer --draws",
          known + 1, choice_.draws, numbers, most_numbers));
    out_.units.push_back("");
    out_.draws.push_back(draws_of(population_, rows, {}, choice_.draws));
    for (std::size_t u = 0; u < known; ++u) {
      std::vector<UnitReading> seen = reader.of_study(u);
      sort_along(seen);
      out_.units.push_back(model_->units[u]);
      out_.draws.push_back(draws_of(population_, rows, seen, choice_.draws));
    }
  }

  void add_rows(SqlStatements& statements) const {
    // Effects in the order of the row symbols.
    std::vector<std::size_t> order(model_->effects.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return model_->effects[a].symbol < model_->effects[b].symbol;
    });
    std::vector<std::string> of_parameter;  // by slots(row_symbols)
    for (const std::size_t p : model_->shared) of_parameter.push_back(model_->parameters[p].name);
    for (const std::size_t p : sql_.parameters)
      statements.numbers.push_back({fmt::format("formula_p{}", p), of_parameter[p]});
    for (const std::size_t e : sql_.effects)
      statements.numbers.push_back(
          {fmt::format("formula_e{}", e), model_->effects[order[e]].name + " of the unit"});
    for (std::size_t u = 0; u < out_.units.size(); ++u) {
      const Nodes& nodes = out_.draws[u];
      for (std::size_t i = 0; i < choice_.draws; ++i) {
        SqlStatements::Draw row{out_.units[u], i, {}};
        for (const std::size_t p : sql_.parameters)
          row.numbers.push_back((*nodes.parameters)(static_cast<Eigen::Index>(i),
                                                    static_cast<Eigen::Index>(model_->shared[p])));
        for (const std::size_t e : sql_.effects) row.numbers.push_back(nodes.effect[order[e]][i]);
        statements.draws.push_back(std::move(row));
      }
    }
  }

  const SqlExportChoice& choice_;
  TomlReader root_;
  std::shared_ptr<const FormulaModel> model_;
  NodePopulation population_;
  FormulaSql sql_;
  Unit answer_;
  std::vector<SqlInput> columns_;
  std::string unit_column_;
  SqlExport out_;
};

}  // namespace

double quantile_of_draws(const std::vector<double>& sorted, double p) {
  const auto k = static_cast<std::size_t>(std::llround(p * static_cast<double>(sorted.size())));
  return 0.5 * (sorted[k - 1] + sorted[k]);
}

SqlExport sql_export(const prognosis::CarriedState& state, const SqlExportChoice& choice) {
  return Exporter(state, choice).make();
}

}  // namespace wearwell::formula_model
