#pragma once

#include <array>
#include <string>

#include "wearwell/fleet/engine.h"
#include "wearwell/models/clutch/clutch_sql.h"
#include "wearwell/models/clutch/energy_balance.h"
#include "wearwell/models/clutch/left_out.h"
#include "wearwell/models/clutch/wear_model.h"

namespace wearwell::clutch {

/// Results of a scan of all rows before they are summed.
struct FleetCheck {
  double rows = 0;
  std::string ranges;  ///< minimum and maximum of each input, as text
  std::array<double, inputs.size()> low = {}, high = {};  ///< the same, in the model's units
  FleetOutliers outliers;
};

/// Scans all rows. Throws InputError for rows that cannot be summed, unless `left_out` is asked for:
/// then they are described there, and only a table of nothing else is an error.
FleetCheck check_rows(fleet::Engine& engine, const ClutchSql& sql, const SqlSource& source,
                      LeftOut& left_out);

/// Throws InputError if temperatures in the unit that --columns states lie far outside the calibrated
/// range, all of them, and in the other unit of temperature within it: then the unit is wrong. A unit
/// in the heading of the column holds.
void refuse_other_temperature(fleet::Engine& engine, const ClutchSql& sql, const SqlSource& source,
                              const WearModel& model);

}  // namespace wearwell::clutch
