#include "wearwell/models/formula_model/c_export.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <regex>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/formula/c_text.h"
#include "wearwell/models/formula_model/c_likelihood.h"
#include "wearwell/models/formula_model/formula_drawn.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/node_lives.h"
#include "wearwell/models/formula_model/rate_change.h"
#include "wearwell/models/formula_model/unit_nodes.h"

namespace wearwell::resource {

std::string_view edge_header();
std::string_view edge_source();
std::string_view edge_test();

}  // namespace wearwell::resource

namespace wearwell::formula_model {
namespace {

using formula::c_number;
using Words = std::map<std::string, std::string>;

// The model to export, as the tracker has it.
struct Exported {
  TomlReader root;
  std::shared_ptr<const FormulaModel> model;
  NodeLives lives;
  NodeRows rows;
  NodePopulation population;
  std::vector<UnitReading> seen;
  UnitNodes laid;
  std::vector<double> log_weight;

  Exported(const prognosis::CarriedState& state, const CExportChoice& choice)
      : root(TomlReader::parse(state.source.study)),
        model(allowed(read_formula_model(root, state.source))),
        lives(root, model),
        rows(model, lives.wanted()),
        population(model, state.posterior) {
    refuse_rate_change(root);
    if (rows.follows())
      throw InputError(
          "the formula depends on earlier rows (cum, step, a state given by its rate); C export "
          "does not support such paths");
    if (choice.lines > 0)
      population.few = PopulationPoints(ThinnedPosterior(state.posterior, choice.lines));
    if (!choice.unit.empty()) see(choice.unit);
    laid = place_nodes(population, seen, seen, {});
    log_weight = laid.log_before;
    for (const UnitReading& each : seen) take(each);
  }

  static std::shared_ptr<const FormulaModel> allowed(std::shared_ptr<const FormulaModel> read) {
    refuse_formula(*read);
    refuse_unsupported(*read, "exported");
    return read;
  }

  void see(const std::string& name) {
    const auto at = std::find(model->units.begin(), model->units.end(), name);
    if (at == model->units.end())
      throw InputError(fmt::format("--unit: the study has no {} '{}'{}", lives.noun(),
                                   printable(name), did_you_mean(name, model->units)));
    seen = ReadingReader(model).of_study(static_cast<std::size_t>(at - model->units.begin()));
    sort_along(seen);
  }

  void take(const UnitReading& reading) {
    std::vector<double> value(log_weight.size());
    rows.look(laid.nodes, reading, rows.paths(), nullptr, value, nullptr, nullptr);
    for (std::size_t i = 0; i < value.size(); ++i) log_weight[i] += value[i];
  }

  std::size_t axis() const {
    std::size_t c = 0;
    while (model->row_symbols.columns[c].name != *model->along) ++c;
    return c;
  }
};

std::string shouted(std::string text) {
  for (char& each : text)
    each = std::isalnum(static_cast<unsigned char>(each))
               ? static_cast<char>(std::toupper(static_cast<unsigned char>(each)))
               : '_';
  return text;
}

// Inside a comment of C.
std::string commented(const std::string& text) {
  std::string out;
  for (const char each : printable(text)) {
    if (each == '/' && !out.empty() && out.back() == '*') out += ' ';
    if (each == '?' && !out.empty() && out.back() == '?') out += ' ';
    out += each == '\n' || each == '\\' ? ' ' : each;
  }
  return out;
}

std::string row_of(const std::vector<double>& numbers) {
  std::vector<std::string> all;
  for (const double each : numbers) all.push_back(c_number(each));
  return fmt::format("{}", fmt::join(all, ", "));
}

template <class Make>
std::string list(std::size_t count, const Make& make) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back(make(i));
  if (all.empty()) all.push_back("0");
  return fmt::format("{}", fmt::join(all, ", "));
}

std::string reading_of(const UnitReading& reading) {
  return fmt::format("{{{}}}, {{{}}}", row_of(reading.row.numbers),
                     list(reading.row.labels.size(),
                          [&](std::size_t i) { return fmt::format("{}", reading.row.labels[i]); }));
}

void add_tables(const Exported& from, Words& words) {
  const Nodes& nodes = from.laid.nodes;
  std::string parameters, effects, before;
  for (std::size_t j = 0; j < nodes.lines(); ++j) {
    std::vector<double> row;
    for (const std::size_t p : from.model->shared)
      row.push_back(
          (*nodes.parameters)(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(p)));
    if (row.empty()) row.push_back(0);
    parameters += fmt::format("    {{{}}},\n", row_of(row));
  }
  // Effects in the order of the row symbols.
  std::vector<std::size_t> order(from.model->effects.size());
  for (std::size_t e = 0; e < order.size(); ++e) order[e] = e;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return from.model->effects[a].symbol < from.model->effects[b].symbol;
  });
  for (std::size_t i = 0; i < nodes.count(); ++i) {
    std::vector<double> row;
    for (const std::size_t e : order) row.push_back(nodes.effect[e][i]);
    if (row.empty()) row.push_back(0);
    effects += fmt::format("    {{{}}},\n", row_of(row));
    before += fmt::format("    {},\n", c_number(from.log_weight[i]));
  }
  words["PARAMETER_TABLE"] = parameters;
  words["EFFECT_TABLE"] = effects;
  words["BEFORE_TABLE"] = before;
}

void add_symbols(const Exported& from, Words& words) {
  const formula::Symbols& symbols = from.model->row_symbols;
  const Conditions& given = from.lives.given();
  const formula::Program limited =
      formula::compile(from.model->lines, from.lives.wanted(), symbols);
  const auto flag = [](bool set) { return std::string(set ? "1" : "0"); };
  const std::size_t columns = symbols.columns.size(), labels = symbols.labels.size();
  const auto needed = [&](std::size_t c) {
    return symbols.columns[c].name == *from.model->along ||
           std::any_of(from.model->measured.begin(), from.model->measured.end(),
                       [&](const Measured& each) { return each.program.uses_column(c); });
  };
  const auto used_label = [&](std::size_t l) {
    return limited.uses_label(l) ||
           std::any_of(from.model->measured.begin(), from.model->measured.end(),
                       [&](const Measured& each) { return each.program.uses_label(l); });
  };
  words["COLUMNS"] = list(columns, [&](std::size_t c) {
    return fmt::format("{}EDGE_{}", c == 0 ? " " : "", shouted(symbols.columns[c].name));
  });
  words["LABELS"] = fmt::format("{}", std::max<std::size_t>(labels, 1));
  std::string levels;
  for (std::size_t l = 0; l < labels; ++l) {
    if (!used_label(l)) continue;
    levels += fmt::format("/* label[{}], {}: ", l, commented(symbols.labels[l].name));
    levels += list(symbols.labels[l].levels.size(), [&](std::size_t i) {
      return fmt::format("{} {}", i, commented(symbols.labels[l].levels[i]));
    });
    levels += " */\n";
  }
  words["LEVELS"] = levels;
  words["GIVEN_NUMBERS"] = list(columns, [&](std::size_t c) {
    return flag(given.numbers.contains(symbols.columns[c].name));
  });
  words["GIVEN_VALUES"] = list(columns, [&](std::size_t c) {
    const auto at = given.numbers.find(symbols.columns[c].name);
    return at == given.numbers.end() ? "0" : c_number(at->second);
  });
  words["GIVEN_LABELS"] = list(
      labels, [&](std::size_t l) { return flag(given.labels.contains(symbols.labels[l].name)); });
  words["GIVEN_LEVELS"] = list(labels, [&](std::size_t l) {
    const auto at = given.labels.find(symbols.labels[l].name);
    return fmt::format("{}", at == given.labels.end() ? 0 : at->second);
  });
  words["NEEDED_NUMBERS"] = list(columns, [&](std::size_t c) { return flag(needed(c)); });
  words["LIMIT_NUMBERS"] =
      list(columns, [&](std::size_t c) { return flag(limited.uses_column(c)); });
  words["LIMIT_LABELS"] = list(labels, [&](std::size_t l) { return flag(limited.uses_label(l)); });
  words["LEVEL_COUNTS"] = list(std::max<std::size_t>(labels, 1), [&](std::size_t l) {
    return l < labels && used_label(l) ? fmt::format("{}", symbols.labels[l].levels.size())
                                       : std::string("32767");
  });
  words["FUNCTIONS"] +=
      formula::c_function(from.model->lines, from.lives.wanted()[0], symbols, "limited");
}

// Readings of the unit itself, or else of the most often read unit of the study, with the expected
// results.
void add_test(Exported& from, Words& words) {
  std::vector<UnitReading> readings;
  UnitReading last = from.seen.empty() ? from.lives.before_rows() : from.seen.back();
  if (from.seen.empty()) {
    for (std::size_t u = 0; u < from.model->units.size(); ++u) {
      std::vector<UnitReading> rows = ReadingReader(from.model).of_study(u);
      if (rows.size() > readings.size()) readings = std::move(rows);
    }
    sort_along(readings);
  } else {
    for (int k = 1; k <= 3; ++k) {
      readings.push_back(last);
      UnitReading& ahead = readings.back();
      ahead.row.numbers[from.axis()] = ahead.place = last.place * (1 + 0.05 * k);
      for (auto& each : ahead.responses)
        if (each) each->at *= 1 + 0.05 * k;
    }
  }
  readings.resize(std::min<std::size_t>(readings.size(), 8));
  std::string expected, taken;
  const auto expect = [&] {
    std::vector<double> weight;
    normalize(from.log_weight, weight);
    const prognosis::Forecast now =
        from.lives.forecast(from.laid.nodes, weight, last, from.rows.paths());
    const double within = 0.7 * now.remaining.quantile(0.5);
    expected +=
        fmt::format("    {{{}}},\n",
                    row_of({effective_number(from.log_weight), now.level05, now.level50,
                            now.level95, now.remaining.quantile(0.05), now.remaining.quantile(0.5),
                            now.remaining.quantile(0.95), now.passed, within,
                            now.passed + (1 - now.passed) * now.remaining.cdf(within)}));
  };
  expect();
  for (UnitReading& each : readings) {
    for (std::size_t m = 0; m < from.model->measured.size(); ++m)
      each.row.numbers[measured_column(*from.model, m)] =
          each.responses[m] ? each.responses[m]->at : std::nan("");
    taken += fmt::format("    {{{}}},\n", reading_of(each));
    from.take(each);
    last = each;
    expect();
  }
  words["READINGS"] = taken;
  words["EXPECTED"] = expected;
}

std::string filled(std::string_view text, const Words& words, const std::string& name) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t from = text.find('@', at);
    out += text.substr(at, from - at);
    if (from == text.npos) break;
    const std::size_t to = text.find('@', from + 1);
    out += words.at(std::string(text.substr(from + 1, to - from - 1)));
    at = to + 1;
  }
  out = std::regex_replace(out, std::regex("\\bedge_"), name + "_");
  return std::regex_replace(out, std::regex("\\bEDGE_"), shouted(name) + "_");
}

}  // namespace

CExport c_export(const prognosis::CarriedState& state, const CExportChoice& choice,
                 const std::string& version) {
  if (!std::regex_match(choice.name, std::regex("[a-z][a-z0-9_]{0,30}")))
    throw InputError(
        fmt::format("--name: '{}' is not a valid C name: use small letters, digits and _, a letter "
                    "first, at most 31 characters",
                    printable(choice.name)));
  Exported from(state, choice);
  const FormulaModel& model = *from.model;
  const std::size_t nodes = from.laid.nodes.count(), effects = model.effects.size();
  const std::size_t columns = model.row_symbols.columns.size();
  const std::size_t labels = std::max<std::size_t>(model.row_symbols.labels.size(), 1);
  CExport result;
  result.nodes = nodes;
  result.lines = from.laid.nodes.lines();
  result.effective = effective_number(from.log_weight);
  const std::size_t reading_bytes = 8 * columns + (4 * labels + 7) / 8 * 8;
  result.unit_bytes = 8 * nodes + reading_bytes + 24;
  result.scratch_bytes = 16 * nodes;
  const std::size_t parameters = std::max<std::size_t>(model.shared.size(), 1);
  result.table_bytes =
      8 * (result.lines * parameters + nodes * std::max<std::size_t>(effects, 1) + nodes);
  Words words;
  words["VERSION"] = version;
  words["TITLE"] = commented(from.root.text("title").value_or("untitled"));
  words["LAW"] =
      commented(formula::compile(model.lines, from.lives.wanted(), model.row_symbols).text(0));
  words["LIMITED"] = commented(from.lives.name());
  words["LIMIT"] = c_number(from.lives.limit().si());
  words["NODES"] = fmt::format("{}", nodes);
  words["EFFECTIVE"] = c_number(result.effective);
  words["LEAST"] = c_number(0.5 * result.effective);
  words["STATE"] = fmt::format("{}", result.unit_bytes);
  words["SCRATCH"] = fmt::format("{}", result.scratch_bytes);
  words["ROM"] = fmt::format("{}", result.table_bytes);
  words["LINES"] = fmt::format("{}", result.lines);
  words["PER_LINE"] = fmt::format("{}", from.laid.nodes.per_line);
  words["PARAMETERS"] = fmt::format("{}", parameters);
  words["EFFECT_COUNT"] = fmt::format("{}", std::max<std::size_t>(effects, 1));
  words["DRAWN_LINE"] = fmt::format("{}", effects == 1 ? from.laid.nodes.per_line : 1);
  words["AXIS"] = fmt::format("{}", from.axis());
  words["RISING"] = from.lives.rising() ? "1" : "0";
  words["BEGIN"] = c_number(from.lives.begin());
  words["SCALE"] = c_number(from.lives.scale());
  const UnitReading first = from.seen.empty() ? from.lives.before_rows() : from.seen.back();
  words["FIRST"] = reading_of(first);
  words["PLACE"] = c_number(first.place);
  words["ANY"] = from.seen.empty() ? "0" : "1";
  add_likelihood(model, words["FUNCTIONS"], words["LIKELIHOOD"], words["MEASURED"]);
  add_symbols(from, words);
  words["HELPERS"] = formula::c_helpers(words["FUNCTIONS"]);
  add_tables(from, words);
  add_test(from, words);
  result.header = filled(resource::edge_header(), words, choice.name);
  result.source = filled(resource::edge_source(), words, choice.name);
  result.test = filled(resource::edge_test(), words, choice.name);
  return result;
}

}  // namespace wearwell::formula_model
