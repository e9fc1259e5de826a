#include "wearwell/models/formula_model/use_rate_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/prob/use_rate.h"

namespace wearwell::formula_model {
namespace {

// "km/month"; in brackets where the text of a unit is a product.
formula::AnyUnit unit_of_rate(const Unit& use, const Unit& age) {
  const auto factor = [](const Unit& unit) {
    const bool one = unit.text.find_first_of(" */.^") == std::string::npos;
    return one ? unit.text : "(" + unit.text + ")";
  };
  return formula::read_any_unit(factor(use) + "/" + factor(age));
}

const NumberColumn& age_column(const TomlReader& root, const FormulaData& data) {
  const TomlReader section = root.required_table(UseRate::name);
  const NumberColumn* const age = data.number(section.required_text("age"));
  if (!age) section.fail("age", "must name the numeric column of ages under data.columns");
  return *age;
}

}  // namespace

void refuse_with_use_rate(const TomlReader& root, const std::vector<WrittenLikelihood>& written,
                          const WrittenLikelihood& rate) {
  const TomlReader section = root.required_table(UseRate::name);
  for (const char* other : {"failure_modes", "random_effects", "subpopulations"})
    if (root.has(other)) root.fail(other, "is not possible with [use_rate]");
  if (root.required_table("data").has("returns"))
    root.fail(UseRate::name, "is not possible with [data.returns], whose rows are months");
  if (written.size() != 1)
    section.fail("", "needs one measured column under [likelihood], the life in use");
  const WrittenLikelihood& life = written.front();
  const TomlReader table = root.required_table("likelihood").required_table(life.column);
  if (life.defective || life.dead)
    table.fail(life.defective ? "share_defective" : "share_dead_on_arrival",
               "is not possible with [use_rate]");
  if (table.has("steps")) table.fail("steps", "is not possible with [use_rate]");
  if (life.process || !can_be_life_at_rate(life.form->family))
    table.fail("family", fmt::format("{} is not possible with [use_rate]: weibull, exponential, "
                                     "lognormal, loglogistic or gamma, without a threshold",
                                     life.form->name));
  if (rate.process || !can_be_rate(rate.form->family))
    section.fail("family", fmt::format("{} is not possible for a rate of use: lognormal, weibull "
                                       "or gamma, without a threshold",
                                       rate.form->name));
  if (const auto predict = root.table("predict"); predict && predict->has("along"))
    predict->fail("along", "is for readings along an axis, not for lives with [use_rate]");
}

void add_use_rates(const TomlReader& root, const std::string& use_name, FormulaData& data) {
  const TomlReader section = root.required_table(UseRate::name);
  const TomlReader columns = root.required_table("data").required_table("columns");
  if (columns.has(UseRate::name))
    columns.fail(UseRate::name, "is the name of use over age with [use_rate]; choose another");
  const NumberColumn& age = age_column(root, data);
  const NumberColumn* const use = data.number(use_name);
  if (!use || use_name == age.name)
    section.fail("age", fmt::format("and the life '{}' must be two numeric columns", use_name));
  data.require_complete(age);
  data.require_values(*use);
  for (const char* key : {"lower", "upper", "entry"})
    if (data.number(key))
      columns.fail(key, "is not possible with [use_rate]: it could be a use or an age");
  NumberColumn rate{UseRate::name, UseRate::name, unit_of_rate(use->unit.unit, age.unit.unit), {}};
  bool any = false;
  for (std::size_t i = 0; i < data.table.rows; ++i) {
    if (!(age.values[i] > 0))
      throw InputError(fmt::format("{}: {:.10g} {} must be positive: the age of this unit",
                                   place(data.table, age.column, i),
                                   from_si(age.unit.unit, age.values[i]), age.unit.unit.text));
    rate.values.push_back(use->values[i] / age.values[i]);
    any |= std::isfinite(rate.values.back());
  }
  if (!any)
    throw InputError(fmt::format(
        "{}: '{}' is empty in all rows; the distribution of use rates needs units with a known use",
        data.table.source, use->column));
  data.numbers.push_back(std::move(rate));
}

Observed observed_rates(const FormulaData& data, const Observed& of_use) {
  const NumberColumn& rate = *data.number(UseRate::name);
  Observed all;
  all.rows = of_use.rows;
  all.counts = of_use.counts;
  for (const std::size_t row : of_use.rows)
    all.responses.push_back({Censoring::none, rate.values[row]});
  all.failures = all.rows.size();
  return all;
}

UseRate life_in_time(const TomlReader& root, const Measured& life, const Measured& rate,
                     const FormulaData& data) {
  const NumberColumn& age = age_column(root, data);
  UseRate found{age.name,
                {age.name,
                 "",
                 age.unit.unit,
                 age.unit.powers,
                 life.form,
                 nullptr,
                 {},
                 life.wanted,
                 life.family_parameter,
                 {},
                 {},
                 {.families = {life.form->family}, .rate = rate.form->family}}};
  Measured& in_time = found.in_time;
  for (std::size_t o = 0; o < rate.wanted.size(); ++o) {
    in_time.wanted.push_back(rate.wanted[o]);
    in_time.family_parameter.push_back(in_time.life.of_rate() + rate.family_parameter[o]);
  }
  SpecialColumns special = special_columns(data);
  const Observed all = read_observed(data, age.name, *life.form, special, {}, false);
  const NumberColumn& use = *data.number(life.column);
  for (std::size_t i = 0; i < all.rows.size(); ++i) {
    if (std::isfinite(use.values[all.rows[i]])) continue;
    in_time.observed.rows.push_back(all.rows[i]);
    in_time.observed.responses.push_back(all.responses[i]);
    in_time.observed.counts.push_back(all.counts[i]);
    in_time.observed.failures += all.responses[i].seen != Censoring::right;
  }
  return found;
}

std::size_t failures_of_use(const FormulaModel& model) {
  return model.measured.front().observed.failures + model.use_rate->in_time.observed.failures;
}

}  // namespace wearwell::formula_model
