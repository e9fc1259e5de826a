#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/columns.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/clutch/campaign.h"
#include "wearwell/models/clutch/closing.h"
#include "wearwell/models/clutch/tribometer.h"

/// Files of a campaign. Headings carry units, "torque [N m]" (docs/reference/tables.md), in any
/// unit of the right dimension. All readers throw InputError naming file, row, column and value.
namespace wearwell::clutch {

/// A table of a campaign. Its columns have the names below unless the study gives others.
struct CampaignTable {
  Table table;
  std::optional<TomlReader> columns = {};  ///< of the study

  /// The numeric column for `name`. Throws InputError.
  ColumnChoice numbers(const std::string& name, const std::string& si) const;
  /// The text column, or the column of plates.
  const Column& words(const std::string& name) const;
};

/// The names of the plates in all tables, in the order of their first occurrence; empty if every
/// plate is a number. Throws InputError if a plate has no name.
std::vector<std::string> plate_names(const std::vector<const CampaignTable*>& tables);

/// point, role, slip_speed, torque, temperature, closing_time.
std::vector<DesignPoint> read_design(const CampaignTable& table);
/// plate, cycle, slip_speed, torque, temperature, closing_time, energy. A plate is its place among
/// `names`, from 1.
std::vector<Cycle> read_cycles(const CampaignTable& table, const std::vector<std::string>& names);
/// plate, cycle, mass, block ("start", "run-in", "point 17", "run-out", "sequence NAME").
std::vector<Weighing> read_weighings(const CampaignTable& table,
                                     const std::vector<std::string>& names);
/// plate, time, slip_speed, torque, temperature.
std::vector<Sample> read_traces(const CampaignTable& table, const std::vector<std::string>& names);

/// For single files.
std::vector<DesignPoint> read_design(const std::filesystem::path& file);
std::vector<Cycle> read_cycles(const std::filesystem::path& file);
std::vector<Weighing> read_weighings(const std::filesystem::path& file);
std::vector<Sample> read_traces(const std::filesystem::path& file);

std::string design_csv(const std::vector<DesignPoint>& design);
std::string cycles_csv(const std::vector<Cycle>& cycles);
std::string weighings_csv(const std::vector<Weighing>& weighings);
std::string traces_csv(const std::vector<Sample>& samples);
std::string closings_csv(const std::vector<Closing>& closings);
std::string realized_csv(const std::vector<Realized>& realized);

/// 0 degC in K: tables are read in SI, OperatingPoint holds degrees Celsius.
inline constexpr double celsius_zero = 273.15;

/// One mm^3 in m^3.
inline constexpr double mm3 = 1e-9;

}  // namespace wearwell::clutch
