#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/columns.h"
#include "wearwell/input/source.h"
#include "wearwell/models/fatigue/life_test.h"
#include "wearwell/models/fatigue/spring.h"
#include "wearwell/study/units_check.h"

namespace wearwell {

/// " MPa" after a number; empty if the unit is 1.
inline std::string after_number(const Unit& unit) {
  return unit.text == "1" ? "" : " " + unit.text;
}

/// Life tests as a study file names them, with their names and units for messages.
struct SnData {
  fatigue::LifeTests tests;         ///< one per row
  std::vector<std::string> labels;  ///< one per row: the type of specimen; empty if there is none
  std::vector<std::string> parts;  ///< one per row: its name; empty if the study has no such column
  std::string stress_si = "Pa";    ///< the stress quantity: a stress, or a force, a strain, ...
  Unit stress_unit;
  Unit life_unit;      ///< "cycles", "1e5 cycles"
  std::string source;  ///< the file, for messages
  TableLayout layout;
  std::string mean_stress_column;
  bool has_mean_stress = false;  ///< the study has the mean stress or stress ratio of its tests
  std::optional<fatigue::HelicalSpring> spring;  ///< if the study gives displacements
  std::vector<DataColumn> columns;               ///< as read
};

/// The SI unit of the stress quantity of an S-N curve: of a stress, a force, a moment, a
/// displacement, a voltage, a current, or a plain number (strain, a share of the strength). Empty
/// for any other.
std::string driver_si(const std::string& unit);

/// The SI unit of the stress quantity, by the first unit that the study or its table has for
/// alternating_stress or max_stress; "Pa" if neither has one, or has an unsuitable one.
std::string stated_driver_si(const TomlReader& root, const Table& table);

/// Reads [data] and the common values of [conditions]. The stress has one of four forms:
/// alternating_stress with mean_stress (0 if it does not matter), max_stress with min_stress,
/// alternating_stress with stress_ratio, or displacement_mean with displacement_amplitude of a
/// spring in [conditions]. Throws InputError naming file, row and column.
SnData read_sn_data(const TomlReader& root, const Source& source, fatigue::MeanStress correction);

/// The unit of lives for output: "1e5 cycles" for "1e5".
Unit life_unit(Unit unit);

/// A life in [predict] or elsewhere: positive; a plain number counts cycles.
std::vector<Quantity> read_lives(const TomlReader& table, const std::string& key);

/// The mean stress: from mean_stress or stress_ratio.
fatigue::StressLine read_line(const TomlReader& table, const std::string& stress_si = "Pa");

/// One stress, in the keys of the columns: alternating_stress with mean_stress or stress_ratio,
/// max_stress with min_stress, or displacement_amplitude with displacement_mean.
fatigue::Stress read_stress(const TomlReader& table, fatigue::MeanStress correction,
                            const std::optional<fatigue::HelicalSpring>& spring,
                            const std::string& stress_si = "Pa");

}  // namespace wearwell
