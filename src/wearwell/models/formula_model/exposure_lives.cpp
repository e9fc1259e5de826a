#include "wearwell/models/formula_model/exposure_lives.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace wearwell::formula_model {
namespace {

// Columns that measure the test itself, not the conditions under which a specimen fails.
bool is_of_test(const FormulaModel& model, const std::string& name) {
  if (model.steps) return name == model.steps->duration;
  return name == RampStress::duration || name == RampStress::begin || name == model.ramp->rate ||
         name == model.ramp->start;
}

Conditions last_conditions(const FormulaModel& model, std::size_t row) {
  const formula::Program& program = model.measured.front().program;
  Conditions found;
  std::vector<std::string> words;
  for (std::size_t c = 0; c < model.row_symbols.columns.size(); ++c) {
    const std::string& name = model.row_symbols.columns[c].name;
    if (!program.uses_column(c) || is_of_test(model, name)) continue;
    const NumberColumn& column = *model.data.number(name);
    found.numbers[name] = column.values[row];
    const Unit& unit = column.unit.unit;
    words.push_back(fmt::format("{} = {:.4g}{}", name, from_si(unit, column.values[row]),
                                unit.text == "1" ? "" : " " + unit.text));
  }
  for (std::size_t c = 0; c < model.row_symbols.labels.size(); ++c) {
    if (!program.uses_label(c)) continue;
    const LabelColumn& column = *model.data.label(model.row_symbols.labels[c].name);
    found.labels[column.name] = column.at[row];
    words.push_back(fmt::format("{} = {}", column.name,
                                column.levels[static_cast<std::size_t>(column.at[row])]));
  }
  found.words = fmt::format("{}", fmt::join(words, ", "));
  return found;
}

std::size_t parameter_named(const ResponseForm& form, const std::string& name) {
  std::size_t at = 0;
  while (at < form.family_parameters.size() && form.family_parameters[at].name != name) ++at;
  return at;
}

}  // namespace

std::optional<ExposureReference> exposure_reference(const FormulaModel& model) {
  const Measured& measured = model.measured.front();
  if (model.measured.size() != 1 || !measured.life.plain() || model.by_unit()) return {};
  std::vector<ExposureReference> failed;
  for (std::size_t i = 0; i < measured.observed.rows.size(); ++i) {
    if (measured.observed.responses[i].seen != Censoring::right)
      failed.push_back({i, last_conditions(model, measured.observed.rows[i])});
  }
  if (failed.empty()) return {};
  const auto middle = failed.begin() + static_cast<std::ptrdiff_t>(failed.size() / 2);
  const auto key = [](const ExposureReference& each) {
    return std::pair(each.conditions.numbers, each.specimen);
  };
  std::nth_element(failed.begin(), middle, failed.end(),
                   [&](const auto& a, const auto& b) { return key(a) < key(b); });
  return *middle;
}

std::vector<Response> exposure_lives(const FormulaRows& rows, const ExposureReference& reference,
                                     const double* x) {
  const FormulaModel& model = rows.model();
  const Measured& measured = model.measured.front();
  UnitRows& units = rows.mine().rows;
  units.move_to(x);
  const std::vector<double> all = units.each_family_parameter(std::vector<double>()).front();
  const std::size_t count = measured.life.parameters(),
                    scale = parameter_named(*measured.form,
                                            scale_parameter(std::string(measured.form->name))),
                    threshold = measured.family_parameter.back();
  if (scale >= count) return {};
  const double* const at_reference = &all[reference.specimen * count];
  std::vector<Response> lives = measured.observed.responses;
  for (std::size_t i = 0; i < lives.size(); ++i) {
    const double* const own = &all[i * count];
    for (std::size_t p = 0; p < count; ++p) {
      if (p != scale && p != threshold &&
          !(std::abs(own[p] - at_reference[p]) <= 1e-9 * std::abs(at_reference[p])))
        return {};
    }
    const auto equivalent = [&](double age) {
      return (age - own[threshold]) / own[scale] * at_reference[scale];
    };
    lives[i].at = equivalent(lives[i].at);
    lives[i].until = equivalent(lives[i].until);
  }
  return lives;
}

}  // namespace wearwell::formula_model
