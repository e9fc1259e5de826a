#pragma once

#include "wearwell/models/formula_model/formula_asked.h"
#include "wearwell/models/formula_model/formula_lives.h"

namespace wearwell::formula_model {

/// What is expected of a unit under the conditions to come, and under its own until now where these
/// differ and the path does not know of rows before: there it goes on from the place where the path ahead
/// has the value at which it stands.
LimitedPath::SeenUnit seen_unit(const Asked& asked, const TomlReader& table, const std::string& key,
                                const std::vector<formula::Wanted>& wanted, std::size_t unit);

/// Fills in where the path of a new unit begins, how far from there the data go, and whether it rises.
void set_reach(const Asked& asked, LimitedPath& path);

/// Reads predict.limit: lives of a new unit and of each one seen. Throws InputError.
void read_limit(const Asked& asked, PosteriorStudy& study);

}  // namespace wearwell::formula_model
