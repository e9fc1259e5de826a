#pragma once

#include <vector>

#include "wearwell/prognosis/new_data.h"

namespace wearwell::prognosis {

/// The data of a study whose [data] names several tables, with new rows added to those whose
/// columns each of `rows` has: of a clutch campaign design, cycles, weighings and traces. Rows are in
/// canonical order, by plate and position on the axis; `joined.fresh` are rows of each table in
/// turn, `joined.roles` those of the last. `source` has all tables as read. Throws InputError for a
/// file or table that matches none or two, and for rows that `joined_data` refuses.
JoinedData joined_campaign(const Source& source, const std::vector<NewRows>& rows);

}  // namespace wearwell::prognosis
