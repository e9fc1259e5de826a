#pragma once

#include <string>
#include <vector>

#include "wearwell/models/clutch/operating_point.h"

namespace wearwell::clutch {

/// One closing as logged by the rig.
struct Cycle {
  int plate = 0;
  long long number = 0;  ///< number within this plate, from 1, ascending
  OperatingPoint at;
  double energy = 0;  ///< J
};

/// The purpose of the cycles since the plate's previous weighing.
enum class Block { start, run_in, point, run_out, sequence };

/// A weighing of a plate.
struct Weighing {
  int plate = 0;
  long long cycle = 0;  ///< the last cycle before it; 0 for the new plate
  double mass = 0;      ///< kg
  Block block = Block::start;
  int point = 0;         ///< number of the design point, for Block::point
  std::string sequence;  ///< its name, for Block::sequence: "floating"
};

/// The campaign of one material on the rig.
struct Campaign {
  std::vector<DesignPoint> design;
  std::vector<Cycle> cycles;        ///< by plate, then by number
  std::vector<Weighing> weighings;  ///< by plate, then by cycle
  double density = 0;               ///< of the lining, kg/m^3
  double balance_sd = 0;            ///< standard deviation of one weighing, kg
  /// Sources of cycles and weighings, row by row, for messages.
  std::string cycles_source = "cycles", weighings_source = "weighings";
  std::vector<std::string> plate_names = {};  ///< of plate 1, 2, ...; empty if plates are numbers
  std::vector<std::string> filled = {};       ///< filled gaps, one sentence per plate

  std::string plate_name(int plate) const {
    return plate_names.empty() ? std::to_string(plate)
                               : plate_names.at(static_cast<std::size_t>(plate - 1));
  }
};

/// One sample of a raw trace.
struct Sample {
  int plate = 0;
  double time = 0;         ///< s
  double slip_speed = 0;   ///< rad/s
  double torque = 0;       ///< N m
  double temperature = 0;  ///< degrees Celsius
};

}  // namespace wearwell::clutch
