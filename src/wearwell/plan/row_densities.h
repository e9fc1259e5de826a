#pragma once

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/plan/test_rows.h"

namespace wearwell::plan {

/// How effects of levels without data are integrated.
enum class EffectIntegral { rough, exact };

/// log densities of the outcomes in `rows` (`rows_with_outcomes`), nodes x rows. The rows are added
/// to the study's own and the study is read again, so this holds for every model whose rows, or
/// units, are independent given the parameters. A test of a unit that the study has is conditional
/// on that unit's rows (`Histories`). The effect of a level without data is integrated
/// (new_level_integral.h); for `exact` the number of its nodes is doubled until the densities are
/// steady to 0.1 % of the highest, which must be among the rows. `nodes` are natural parameters, SI.
/// Throws InputError where the model refuses a row (naming it), where rows are not independent, or
/// where that integral is not resolved.
Points row_densities(const TestStudy& study, const Table& rows, const Points& nodes,
                     EffectIntegral integral = EffectIntegral::exact);

/// A study whose likelihood has an integral over effects of levels without data is slower.
bool has_new_levels(const TestStudy& study, const Table& conditions);

[[noreturn]] void refuse_dependent_rows();

/// Whether two values of one log factor are the same but for rounding.
bool same_factor(double a, double b);

}  // namespace wearwell::plan
