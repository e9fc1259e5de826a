#pragma once

#include <string>

#include "wearwell/fleet/engine.h"
#include "wearwell/models/clutch/clutch_sql.h"
#include "wearwell/models/clutch/energy_balance.h"
#include "wearwell/models/clutch/left_out.h"

namespace wearwell::clutch {

/// Results of a scan of all rows before they are summed.
struct FleetCheck {
  double rows = 0;
  std::string ranges;  ///< minimum and maximum of each input, as text
  FleetOutliers outliers;
};

/// Scans all rows. Throws InputError for rows that cannot be summed, unless `left_out` is asked for:
/// then they are described there, and only a table of nothing else is an error.
FleetCheck check_rows(fleet::Engine& engine, const ClutchSql& sql, const SqlSource& source,
                      LeftOut& left_out);

}  // namespace wearwell::clutch
