#pragma once

#include "wearwell/models/formula_model/formula_asked.h"
#include "wearwell/models/formula_model/formula_lives.h"

namespace wearwell::formula_model {

/// The path of a unit under future conditions, and under its own conditions until now if these
/// differ and the path does not depend on earlier rows: it then continues from the position where
/// the future path has the unit's present value.
LimitedPath::SeenUnit seen_unit(const Asked& asked, const TomlReader& table, const std::string& key,
                                const std::vector<formula::Wanted>& wanted, std::size_t unit);

/// Fills in the start of a new unit's path, the range of the data from there, and whether the path
/// rises.
void set_reach(const Asked& asked, LimitedPath& path);

/// Reads predict.limit: lives of a new unit and of each unit. Throws InputError.
void read_limit(const Asked& asked, PosteriorStudy& study);

}  // namespace wearwell::formula_model
