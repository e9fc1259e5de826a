#pragma once

#include <filesystem>
#include <vector>

#include "wearwell/prognosis/new_data.h"

namespace wearwell::prognosis {

/// The data of a study whose [data] names several tables, with new rows in those whose columns each file has: of a clutch
/// campaign design, cycles, weighings and traces. Rows in canonical order, by plate and along its life; `joined.fresh` are rows of
/// each table in turn, `joined.roles` those of the last. `source` has all tables as they were read. Throws InputError: a file that is none of the tables, or could
/// be two; rows as `joined_data` refuses them.
JoinedData joined_campaign(const Source& source, const std::vector<std::filesystem::path>& files);

}  // namespace wearwell::prognosis
