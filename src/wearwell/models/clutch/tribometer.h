#pragma once

#include <cstdint>
#include <vector>

#include "wearwell/models/clutch/campaign.h"
#include "wearwell/models/clutch/wear_law.h"

namespace wearwell::clutch {

/// The truth of a simulated campaign, and the operation of the rig.
struct Truth {
  /// w = sum of coefficient (ds/ds_1)^a (Td/Td_1)^b (Mz/Mz_1)^c with ds = omega0^r t2^q, where the
  /// denominators are the values of `reference`.
  struct Term {
    int ds, temperature, torque;  ///< a, b, c
    double coefficient;           ///< m^3/J
  };
  double r = 1, q = 1;
  OperatingPoint reference;
  std::vector<Term> terms;
  RunIn run_in;
  ScatterLaw scatter;
  double plate_sd = 0;  ///< standard deviation of the log of a plate's factor

  int plates = 13;  ///< that run the design; the sequences have one more each
  double density = 0, balance_sd = 0;
  OperatingPoint run_in_point;              ///< of run-in and run-out
  std::vector<long long> run_in_weighings;  ///< cycles, ascending
  long long run_out_cycles = 750;
  long long least_cycles = 750;  ///< of a design point
  double least_mass = 0.3e-3;    ///< worn at a design point, kg
  double worn_out = 0;           ///< worn-out volume of a plate, m^3: sequences end there
  int sequence_weighings = 12;

  double w(const OperatingPoint& at) const;
};

/// The true worn volume of a plate, which no rig can know.
struct Realized {
  int plate = 0;
  long long cycle = 0;
  double volume = 0;  ///< m^3
};

struct Simulation {
  Campaign campaign;
  std::vector<double> plate_factors;  ///< by plate, in order
  std::vector<Realized> realized;     ///< at each weighing
};

/// Runs a campaign: each plate is run in, runs its share of the design in random order, and is run
/// out; two more plates run a sequence of changing conditions from new to worn out, "floating" (the
/// temperature wanders too) and "constant". Cycle k wears
///
///   dV = (g(Ec) f w(x) + sigma_w(x) z) E,   z ~ N(0, 1),   f the plate's factor,
///
/// and balance readings have errors with `balance_sd`. Conditions vary about their set values and
/// are rounded to the resolution of the log. Plate p owns random stream p of the seed. Throws
/// InputError if the truth gives a wear rate or a scatter that is not positive.
Simulation simulate(const std::vector<DesignPoint>& design, const Truth& truth, std::uint64_t seed);

/// Raw traces of the first `closings` closings of plate 1 at 100 Hz, with pauses between them: slip
/// speed falls linearly after a rise of the torque in 0.05 s; sensors have noise.
std::vector<Sample> simulate_traces(const Campaign& campaign, int closings, std::uint64_t seed);

}  // namespace wearwell::clutch
