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

/// What all inspections have in common is what a prediction is for, unless it says otherwise.
struct BearingCommon {
  std::optional<bearing::Contact> contact;
  std::optional<Quantity> radius, clearance, pressure, speed;
};

/// The inspections of a study, and how to speak of them in the user's terms.
struct BearingData {
  std::string source;  ///< the file, for messages
  TableLayout layout;
  bearing::Inspections inspections;
  BearingCommon common;
  Unit depth_unit, pressure_unit;
  std::size_t bearings = 0;
  std::vector<std::string> names;   ///< of the bearings
  std::vector<double> speed;        ///< of each row, rev/s, where revolutions are speed x time
  std::vector<DataColumn> columns;  ///< as they were read
};

/// From [data] and [conditions]; `folder` is where relative paths start. Throws InputError.
BearingData read_bearing_data(const TomlReader& root, const Source& source,
                              ObservationFamily family);

/// A quantity that must be positive.
std::optional<Quantity> positive_quantity(const TomlReader& table, const std::string& name,
                                          const std::string& si);

/// The contact that a table names, if it does.
std::optional<bearing::Contact> contact_in(const std::optional<TomlReader>& table);

}  // namespace wearwell
