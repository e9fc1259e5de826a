#include "wearwell/models/formula_model/response_scaffold.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "wearwell/base/unit_system.h"
#include "wearwell/models/formula_model/scaffold_parts.h"
#include "wearwell/study/column_values.h"
#include "wearwell/study/heading_words.h"

namespace wearwell::formula_model {
namespace {

using Found = ColumnRoles::Found;

// More than these are left for the user to add: each costs a parameter.
constexpr std::size_t most_conditions = 6;

double two_digits(double value) {
  if (value == 0) return 0;
  const double scale = std::pow(10, 1 - std::floor(std::log10(std::abs(value))));
  return std::round(value * scale) / scale;
}

struct Range {
  double least = 0, largest = 0;
  bool is_positive() const { return least > 0; }
  double middle() const {
    return two_digits(is_positive() ? std::sqrt(least * largest) : (least + largest) / 2);
  }
  double size() const { return two_digits(std::max(std::abs(least), std::abs(largest))); }
};

Range range_of(const Table& table, const Column& column) {
  const std::vector<double> values = values_of(table, column);
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  return {*least, *largest};
}

std::string toml_quantity(double value, const std::string& unit) {
  // A factor, as of "N (1000)", is no unit of a text.
  if (const auto factor = parse_unit(unit); factor && factor->dimension.empty() && unit[0] <= '9')
    return quantity_text(value * factor->scale, "1");
  const std::string text = quantity_text(value, unit);
  return unit.empty() || unit == "1" ? text : toml_text(text);
}

// The part of the formula that one condition has, and what this part needs.
struct Term {
  std::string name, factor, constants, prior;
  Found column;
  Range range;
};

// `name_of` keeps these for what other studies call so; here they are free.
std::string condition_name(const Column& column, std::size_t number, std::set<std::string>& names) {
  std::string otherwise = fmt::format("condition_{}", number);
  const std::string heading = name_and_unit(column, "").name;
  for (const char* word :
       {"temperature", "force", "pressure", "speed", "time", "cycles", "distance", "depth"}) {
    if (is_exactly(heading, word)) otherwise = word;
  }
  const std::string name = name_of(column, otherwise);
  if (names.insert(name).second) return name;
  return *names.insert(fmt::format("condition_{}", number)).first;
}

// A condition of a positive response multiplies it: by Arrhenius' law, a power, or exponentially.
Term factor_of(Term term, bool is_warm) {
  const std::string& name = term.name;
  const std::string middle = toml_quantity(term.range.middle(), term.column.unit);
  if (is_warm) {
    term.factor = fmt::format(" * arrhenius({0}, {0}_reference, {0}_energy)", name);
    term.constants = fmt::format("{}_reference = {}\n", name, middle);
    term.prior = fmt::format(
        "{}_energy = {{ distribution = \"normal\", mean = \"0 eV\", sd = \"1 eV\" }}    # below 0: "
        "rises with temperature\n",
        name);
  } else if (term.range.is_positive()) {
    term.factor = fmt::format(" * ({0}/{0}_reference)^{0}_exponent", name);
    term.constants = fmt::format("{}_reference = {}\n", name, middle);
    term.prior = fmt::format(
        "{}_exponent = {{ distribution = \"normal\", mean = 0, sd = 2 }}    # 1: in proportion\n",
        name);
  } else {
    term.factor = fmt::format(" * exp({0}_effect * {0}/{0}_reference)", name);
    term.constants = fmt::format("{}_reference = {}\n", name,
                                 toml_quantity(term.range.size(), term.column.unit));
    term.prior =
        fmt::format("{}_effect = {{ distribution = \"normal\", mean = 0, sd = 2 }}\n", name);
  }
  return term;
}

// Of a response that can be 0 or negative it adds.
Term summand_of(Term term, const std::string& size) {
  const std::string& name = term.name;
  term.factor = fmt::format(" + {0}_effect * {0}/{0}_reference", name);
  term.constants =
      fmt::format("{}_reference = {}\n", name, toml_quantity(term.range.size(), term.column.unit));
  term.prior = fmt::format(
      "{}_effect = {{ distribution = \"normal\", mean = 0, sd = {} }}    # to the reference\n",
      name, size);
  return term;
}

std::vector<Term> take_terms(ColumnRoles& roles, std::set<std::string> names, bool multiplies,
                             const std::string& size) {
  const auto warm = roles.find({"temperature"});
  std::vector<Term> terms;
  for (const Column* each : roles.other_numbers()) {
    if (terms.size() == most_conditions) break;
    Term term;
    const bool is_warm = warm && warm->column == each;
    term.name = condition_name(*each, terms.size() + 1, names);
    term.column =
        roles.take_column(term.name, *each, role_form(is_warm ? "temperature" : "response"));
    term.range = range_of(roles.table(), *each);
    terms.push_back(multiplies ? factor_of(std::move(term), is_warm)
                               : summand_of(std::move(term), size));
  }
  return terms;
}

// What the formula could also have, for who goes on writing it.
std::string offered(const ColumnRoles& roles) {
  std::string text;
  for (const Column* each : roles.other_numbers())
    text += fmt::format("# {}    # a further condition\n", toml_text(each->name));
  for (const Column* each : roles.other_labels())
    text += fmt::format("# {} = {}    # a label: level[{}] has a level for each\n",
                        name_of(*each, "group"), toml_text(each->name), name_of(*each, "group"));
  return text;
}

std::string predict_section(const std::vector<Term>& terms) {
  const Term& along = terms.back();
  std::vector<std::string> given;
  for (const Term& each : terms) {
    if (&each != &along)
      given.push_back(
          fmt::format("{} = {}", each.name, toml_quantity(each.range.middle(), each.column.unit)));
  }
  return fmt::format(
      "[predict]\n"
      "along = \"{}\"\n"
      "at = [{}]    # GUESS: the largest tested; state the conditions in use\n{}",
      along.name, toml_quantity(along.range.largest, along.column.unit),
      given.empty() ? "" : fmt::format("given = {{ {} }}\n", fmt::join(given, ", ")));
}

}  // namespace

std::optional<Scaffold> response_scaffold(ColumnRoles& roles) {
  if (!roles.has({"response"}) || roles.has({"life", "status"})) return {};
  const Found response = *roles.take("response", {"response"});
  if (values_of(roles.table(), *response.column).empty()) return {};
  if (const auto unit = roles.find({"unit"}); unit && !repeats(roles.table(), *unit->column))
    roles.pass_over("unit");
  const Range range = range_of(roles.table(), *response.column);
  const bool multiplies = range.is_positive();
  const std::string size = toml_quantity(range.size() > 0 ? range.size() : 1, response.unit);
  std::string measured = name_of(*response.column, "measured");
  if (measured == "response" || measured == "level") measured = "measured";
  const std::vector<Term> terms =
      take_terms(roles, {measured, "response", "level"}, multiplies, size);
  // Level and scatter are parameters, too.
  if (terms.empty() || roles.table().rows < terms.size() + 2) return {};
  std::string columns = ColumnRoles::line(measured, response), formula = "level", constants, priors;
  std::vector<std::string> names;
  for (const Term& each : terms) {
    columns += ColumnRoles::line(each.name, each.column);
    formula += each.factor;
    constants += each.constants;
    priors += each.prior;
    names.push_back(each.name);
  }
  columns += offered(roles);
  roles.guesses.push_back(fmt::format(
      "the formula is a first one, in which each condition {}: change it to what you know of {}",
      multiplies ? "multiplies the response" : "adds to the response", measured));
  std::string text = fmt::format(
      "title = {}\n"
      "model = \"formula\"\n\n"
      "{}[data.columns]\n{}\n"
      "[constants]    # of the size of the data\n{}\n"
      "[formula]    # {}; docs/reference/formula-language.md has what else can stand here\n"
      "response = \"{}\"\n\n",
      toml_text("Response, from " + roles.file()), roles.data_section(), columns, constants,
      multiplies ? "the simplest formula: a product of powers" : "the simplest formula: a sum",
      formula);
  text += multiplies ? fmt::format(
                           "[likelihood.{}]\n"
                           "family = \"lognormal\"    # scatter in proportion\n"
                           "median = \"response\"\n"
                           "log_sd = \"sigma\"\n\n",
                           measured)
                     : fmt::format(
                           "[likelihood.{}]\n"
                           "family = \"normal\"\n"
                           "mean = \"response\"\n"
                           "sd = \"sigma\"\n\n",
                           measured);
  text +=
      "# Prior knowledge: PROPOSED as weak priors from the size of the data. Replace them with "
      "what you know.\n[prior]\n";
  text += multiplies
              ? fmt::format(
                    "level = {{ distribution = \"lognormal\", median = {}, log_sd = 2 }}    # "
                    "under the reference conditions\n{}"
                    "sigma = {{ distribution = \"half-normal\", scale = 1 }}    # of the "
                    "logarithm\n\n",
                    toml_quantity(range.middle(), response.unit), priors)
              : fmt::format(
                    "level = {{ distribution = \"normal\", mean = 0, sd = {} }}\n{}"
                    "sigma = {{ distribution = \"half-normal\", scale = {} }}\n\n",
                    size, priors, size);
  text += predict_section(terms);
  return roles.study(
      fmt::format("a response under its conditions: {} under {}", measured, fmt::join(names, ", ")),
      ReadingFit::general, std::move(text));
}

}  // namespace wearwell::formula_model
