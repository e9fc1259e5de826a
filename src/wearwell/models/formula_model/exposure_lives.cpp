#include "wearwell/models/formula_model/exposure_lives.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "wearwell/models/formula_model/life_groups.h"

namespace wearwell::formula_model {
namespace {

// Columns that measure the test itself, not the conditions under which a specimen fails.
bool is_of_test(const FormulaModel& model, const std::string& name) {
  if (model.steps) return name == model.steps->duration;
  return name == RampStress::duration || name == RampStress::begin || name == model.ramp->rate ||
         name == model.ramp->start;
}

UsedColumns columns_of_conditions(const FormulaModel& model) {
  UsedColumns used = used_columns(model);
  std::erase_if(used.numbers,
                [&](const NumberColumn* column) { return is_of_test(model, column->name); });
  return used;
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
  constexpr int digits = 4;  // of a stress that was read or computed at a failure
  const UsedColumns used = columns_of_conditions(model);
  std::vector<ExposureReference> failed;
  for (std::size_t i = 0; i < measured.observed.rows.size(); ++i) {
    if (measured.observed.responses[i].seen != Censoring::right)
      failed.push_back({i, conditions_of_row(used, measured.observed.rows[i], digits)});
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
