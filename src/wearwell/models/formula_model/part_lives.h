#pragma once

#include <string>

#include "wearwell/models/formula_model/life_answers.h"

namespace wearwell::formula_model {

/// Adds the lives of parts of one kind, `asked.life`: of the next one, B-lives, survival, and all from `survived` on. `noun` is the
/// kind, `at` its conditions, `unit` that of a life.
void add_lives_of(const AskedOfLife& asked, const std::string& noun, const std::string& at,
                  const Unit& unit, PosteriorStudy& study);

}  // namespace wearwell::formula_model
