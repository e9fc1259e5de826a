#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace wearwell::formula_model {

/// A machine of which all is known.
struct SimulatedMachine {
  std::string name;  ///< "M017"
  double rate = 0;   ///< of wear, um/h
  double life = 0;   ///< use at which it is worn out, h
};

/// One reading, as a message.
struct SimulatedReading {
  std::size_t machine = 0;
  std::int64_t time = 0;  ///< Unix time, s
  double use = 0;         ///< h
  double wear = 0;        ///< um, as read
};

/// Machines of one kind that wear in proportion to use, each at a rate of its own: `wearwell new fleet`.
struct SimulatedFleet {
  std::vector<SimulatedMachine> learned, machines;
  std::vector<SimulatedReading> learned_readings;  ///< by machine, then use
  std::vector<SimulatedReading> readings;          ///< as they arrive: some twice, some days late
};

inline constexpr double median_rate = 0.02, rate_scatter = 0.35, reading_error = 2,
                        wear_limit = 100;

/// Five machines to learn from, and `count` that report once a week until they are worn out or a year is over.
SimulatedFleet simulate_fleet(std::uint64_t seed, std::size_t count);

/// The files of the example, of seed 1 and 200 machines.
std::string learned_csv(const SimulatedFleet& fleet);  ///< machine,use_h,wear_um
std::string readings_jsonl(const SimulatedFleet& fleet);
std::string truth_csv(const SimulatedFleet& fleet);  ///< machine,rate [um/h],life [h]

}  // namespace wearwell::formula_model
