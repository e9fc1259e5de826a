#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/bayes/observation.h"
#include "wearwell/input/source.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/bearing/contact.h"
#include "wearwell/models/bearing/wear_fit.h"
#include "wearwell/study/units_check.h"

namespace wearwell {

/// Values that all inspections share are the default of a prediction.
struct BearingCommon {
  std::optional<bearing::Contact> contact;
  std::optional<Quantity> radius, clearance, pressure, speed;
};

/// The inspections of a study, with their names and units for messages.
struct BearingData {
  std::string source;  ///< the file, for messages
  TableLayout layout;
  bearing::Inspections inspections;
  BearingCommon common;
  Unit depth_unit, pressure_unit;
  std::size_t bearings = 0;
  std::vector<std::string> names;   ///< of the bearings
  std::vector<double> speed;        ///< of each row, rev/s, where revolutions are speed x time
  std::vector<DataColumn> columns;  ///< as read
};

/// From [data] and [conditions]; relative paths start at `folder`. Throws InputError.
BearingData read_bearing_data(const TomlReader& root, const Source& source,
                              ObservationFamily family);

/// A quantity that must be positive.
std::optional<Quantity> positive_quantity(const TomlReader& table, const std::string& name,
                                          const std::string& si);

/// The contact of a table, if it has one.
std::optional<bearing::Contact> contact_in(const std::optional<TomlReader>& table);

}  // namespace wearwell
