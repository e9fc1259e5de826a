#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace wearwell::formula_model {

/// A machine with known truth.
struct SimulatedMachine {
  std::string name;  ///< "M017"
  double rate = 0;   ///< of wear, um/h
  double life = 0;   ///< use at failure, h
};

/// One reading, as a message.
struct SimulatedReading {
  std::size_t machine = 0;
  std::int64_t time = 0;  ///< Unix time, s
  double use = 0;         ///< h
  double wear = 0;        ///< as read, um
};

/// Machines of one kind whose wear is proportional to use, each at its own rate: `wearwell new
/// fleet`.
struct SimulatedFleet {
  std::vector<SimulatedMachine> learned, machines;
  std::vector<SimulatedReading> learned_readings;  ///< by machine, then use
  /// in the order of arrival: some twice, some days late
  std::vector<SimulatedReading> readings;
};

inline constexpr double median_rate = 0.02, rate_scatter = 0.35, reading_error = 2,
                        wear_limit = 100;

/// Five machines to learn from, and `count` machines that report weekly until failure or for a
/// year.
SimulatedFleet simulate_fleet(std::uint64_t seed, std::size_t count);

/// The files of the example, with seed 1 and 200 machines.
std::string learned_csv(const SimulatedFleet& fleet);  ///< machine,use_h,wear_um
std::string readings_jsonl(const SimulatedFleet& fleet);
std::string truth_csv(const SimulatedFleet& fleet);  ///< machine,rate [um/h],life [h]

}  // namespace wearwell::formula_model
