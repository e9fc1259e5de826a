#pragma once

#include <string>

#include "wearwell/prognosis/known_lives.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::prognosis {

/// Lives of new units of a study that measures lives, at a point of its [predict]: one distribution
/// for each of some hundred points of the posterior, since units share the population. Each is
/// represented by 250 points, closer in the tails. `point` is a name of [predict], "softer spring";
/// it may be empty if there is one. Throws InputError that lists the points.
KnownLives lives_of_study(const PosteriorStudy& study, const WeightedDraws& posterior,
                          const std::string& title, bool trusted, const std::string& point);

/// Adds units in service, from a table with columns `unit` and `age [h]` and optionally `in_study`
/// (yes or no; no where it is missing): whether a row of the study says that the unit has survived
/// to this age. If none does, its survival counts as evidence on the population. Throws InputError
/// naming row, column and value.
void add_units_in_service(KnownLives& lives, const Table& table);

}  // namespace wearwell::prognosis
