#pragma once

#include <map>
#include <string>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/input/source.h"
#include "wearwell/study/posterior_study.h"

/// Units in service: rows of a table, each with its age, and the lives of a fitted study.
namespace wearwell::in_service {

/// A condition of a study's lives, which a table of units may have as a column.
struct Condition {
  std::string name;          ///< as in the study: "temperature"
  std::string si;            ///< its dimension; empty: a label, whose levels are texts
  Unit unit = {};            ///< in the study
  double low = 0, high = 0;  ///< in the study, SI; of numbers
};

/// The columns of a study that are conditions of a life: none that are measured, say how a row
/// ended, or name the axis.
std::vector<Condition> conditions_of(const Source& source, const PosteriorStudy& study);

/// The largest life or position on the axis of the study's rows, SI; NaN if it is not known.
double longest_seen(const Source& source, const PosteriorStudy& study);

/// The study with these values (TOML text, by name) in [predict.given], in which its other
/// conditions stay. Throws InputError if one that stays differs between units.
TextFile with_conditions(const TextFile& study, const std::map<std::string, std::string>& values);

}  // namespace wearwell::in_service
