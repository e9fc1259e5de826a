#pragma once

#include "wearwell/models/formula_model/formula_asked.h"
#include "wearwell/models/formula_model/formula_lives.h"

namespace wearwell::formula_model {

/// The path of a unit under future conditions, and under its own conditions until now if these
/// differ and the path does not depend on earlier rows: it then continues from the position where
/// the future path has the unit's present value.
LimitedPath::SeenUnit seen_unit(const Asked& asked, const TomlReader& table, const std::string& key,
                                const std::vector<formula::Wanted>& wanted, std::size_t unit);

/// Why what takes `size` of memory for each unit is not computed for all of them: they are more than
/// `most`, and no key `choice` under [predict] says which. None for fewer.
std::optional<InputError> too_many_units(const Asked& asked, const std::string& key,
                                         const std::string& choice, const std::string& what,
                                         const std::string& size, std::size_t most);

/// Fills in the start of a new unit's path, the range of the data from there, and whether the path
/// rises.
void set_reach(const Asked& asked, LimitedPath& path);

/// Reads predict.limit: lives of a new unit and of each unit. Throws InputError.
void read_limit(const Asked& asked, PosteriorStudy& study);

}  // namespace wearwell::formula_model
