#pragma once

#include <span>
#include <string>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/in_service/rows_read.h"
#include "wearwell/prognosis/failure_totals.h"
#include "wearwell/study/result.h"

/// What reports on fleets have in common. Horizons are SI; `axis` is the unit in which they are shown.
namespace wearwell::in_service {

/// "10000 h"; "5 x 1e6 cycles".
std::string horizon_text(const Unit& axis, double horizon);

/// The first sentence: the failures within the first horizon.
present::Prose failures_lead(const Unit& axis, std::span<const double> horizons,
                             std::span<const prognosis::FleetFailures> failures, std::size_t units);
present::Table failures_table(const Unit& axis, std::span<const double> horizons,
                              std::span<const prognosis::FleetFailures> failures,
                              std::size_t units);
nlohmann::ordered_json failures_json(const Unit& axis, std::span<const double> horizons,
                                     std::span<const prognosis::FleetFailures> failures);

/// None if no row was left out. `place`: the heading of LeftOutRow::age.
std::vector<present::Table> left_out_tables(const RowsRead& rows, const Unit& axis,
                                            const std::string& place);
nlohmann::ordered_json left_out_json(const RowsRead& rows);

/// How far the data reach and the last horizon, SI.
struct Reach {
  const Unit& axis;
  double data, horizon;
};
/// Of units beyond the data now, and then of those within the horizon if there are more. `beyond`: "older than the longest
/// life in the study".
void add_units_beyond(Findings& findings, std::size_t now, std::size_t later,
                      const std::string& beyond, const Reach& reach, const std::string& advice);

Check fit_check(bool trusted);
/// Fails where much was left out (--skip-bad).
Check left_out_check(const RowsRead& rows);

}  // namespace wearwell::in_service
