#include "wearwell/models/clutch/tribometer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"

namespace wearwell::clutch {
namespace {

// Standard deviations of one cycle's conditions about the set values, relative except for
// temperature.
constexpr double speed_jitter = 0.005, torque_jitter = 0.01, temperature_jitter = 1.5,
                 time_jitter = 0.01;
constexpr long long longest_life = 10'000'000;  // of one plate

/// Resolution of the rig's log, in steps per unit: the decimals of its files.
double rounded(double x, double per_unit) {
  return std::round(x * per_unit) / per_unit;
}

/// One plate on the rig.
class Plate {
 public:
  Plate(int number, const Truth& truth, std::uint64_t seed, Simulation& simulation)
      : number_(number),
        truth_(truth),
        simulation_(simulation),
        rng_(seed, static_cast<std::uint64_t>(number)),
        factor_(std::exp(truth.plate_sd * rng_.normal())) {
    simulation.plate_factors.push_back(factor_);
    weigh(Block::start);
  }

  Rng& rng() { return rng_; }
  double volume() const { return volume_; }
  long long cycles() const { return cycle_; }

  void close(const OperatingPoint& set) {
    if (cycle_ == longest_life)
      throw InputError(
          fmt::format("plate {} would need more than {} cycles: the true wear is too small",
                      number_, longest_life));
    OperatingPoint at;
    at.slip_speed = rpm * std::round(set.slip_speed * (1 + speed_jitter * rng_.normal()) / rpm);
    at.torque = rounded(set.torque * (1 + torque_jitter * rng_.normal()), 10);
    at.temperature = rounded(set.temperature + temperature_jitter * rng_.normal(), 10);
    at.closing_time = rounded(set.closing_time * (1 + time_jitter * rng_.normal()), 1000);
    const double energy = rounded(closing_energy(at), 1);
    const double w = truth_.w(at), sigma = truth_.scatter.formula(w, at);
    if (!(w > 0))
      throw InputError(fmt::format(
          "the true wear rate is {:.4g} mm^3/MJ at {:.0f} rpm, {:.1f} N m, "
          "{:.1f} degC, {:.2f} s; it must be positive",
          w / mm3_per_MJ, at.slip_speed / rpm, at.torque, at.temperature, at.closing_time));
    if (!(sigma > 0)) throw InputError("the true scatter must be positive at every cycle");
    volume_ += (truth_.run_in.g(energy_) * factor_ * w + sigma * rng_.normal()) * energy;
    energy_ += energy;
    simulation_.campaign.cycles.push_back({number_, ++cycle_, at, energy});
  }

  void weigh(Block block, int point = 0, const std::string& sequence = {}) {
    constexpr double new_mass = 0.25;  // kg
    const double mass = new_mass - truth_.density * volume_ + truth_.balance_sd * rng_.normal();
    simulation_.campaign.weighings.push_back(
        {number_, cycle_, rounded(mass, 1e7), block, point, sequence});
    simulation_.realized.push_back({number_, cycle_, volume_});
  }

  void run_in() {
    for (const long long until : truth_.run_in_weighings) {
      while (cycle_ < until) close(truth_.run_in_point);
      weigh(Block::run_in);
    }
  }

  void run_point(const DesignPoint& point) {
    const double before = volume_;
    const long long first = cycle_;
    while (cycle_ - first < truth_.least_cycles ||
           (volume_ - before) * truth_.density < truth_.least_mass)
      close(point.at);
    weigh(Block::point, point.number);
  }

  void run_out() {
    for (long long i = 0; i < truth_.run_out_cycles; ++i) close(truth_.run_in_point);
    weigh(Block::run_out);
  }

 private:
  int number_;
  const Truth& truth_;
  Simulation& simulation_;
  Rng rng_;
  double factor_;
  long long cycle_ = 0;
  double energy_ = 0, volume_ = 0;
};

struct Ranges {
  OperatingPoint low, high;
};

/// The ranges of the factorial.
Ranges ranges_of(const std::vector<DesignPoint>& design) {
  Ranges ranges;
  bool first = true;
  for (const DesignPoint& point : design) {
    if (point.role != Role::model) continue;
    for (const Input& input : inputs) {
      double &low = ranges.low.*input.value, &high = ranges.high.*input.value;
      const double x = point.at.*input.value;
      low = first ? x : std::min(low, x);
      high = first ? x : std::max(high, x);
    }
    first = false;
  }
  return ranges;
}

/// Changing conditions until the plate is worn out: slip speed, torque and closing time of each
/// cycle are drawn independently; the temperature wanders in the floating sequence and stays at its
/// middle in the other.
void run_sequence(Plate& plate, const std::string& name, const Ranges& ranges, const Truth& truth) {
  Rng& rng = plate.rng();
  const auto drawn = [&](double OperatingPoint::*value) {
    return rng.uniform(ranges.low.*value, ranges.high.*value);
  };
  const double middle = 0.5 * (ranges.low.temperature + ranges.high.temperature);
  const double half = 0.5 * (ranges.high.temperature - ranges.low.temperature);
  // An autoregression with a memory of 200 cycles, kept within the ranges.
  constexpr double memory = 0.995;
  double drift = 0;
  for (int weighing = 1; weighing <= truth.sequence_weighings; ++weighing) {
    const double until = truth.worn_out * weighing / truth.sequence_weighings;
    while (plate.volume() < until) {
      drift = memory * drift + std::sqrt(1 - memory * memory) * 0.5 * rng.normal();
      drift = std::clamp(drift, -0.95, 0.95);
      OperatingPoint at{drawn(&OperatingPoint::slip_speed), drawn(&OperatingPoint::torque), middle,
                        drawn(&OperatingPoint::closing_time)};
      if (name == "floating") at.temperature += half * drift;
      plate.close(at);
    }
    plate.weigh(Block::sequence, 0, name);
  }
}

}  // namespace

double Truth::w(const OperatingPoint& at) const {
  const double ds = std::pow(at.slip_speed / reference.slip_speed, r) *
                    std::pow(at.closing_time / reference.closing_time, q);
  double sum = 0;
  for (const Term& term : terms) {
    sum += term.coefficient * power(ds, term.ds) *
           power(at.temperature / reference.temperature, term.temperature) *
           power(at.torque / reference.torque, term.torque);
  }
  return sum;
}

Simulation simulate(const std::vector<DesignPoint>& design, const Truth& truth,
                    std::uint64_t seed) {
  if (std::none_of(design.begin(), design.end(),
                   [](const DesignPoint& point) { return point.role == Role::model; }))
    throw InputError("the design has no point of role 'model'");
  Simulation simulation;
  simulation.campaign.design = design;
  simulation.campaign.density = truth.density;
  simulation.campaign.balance_sd = truth.balance_sd;

  // Shuffled points, dealt to the plates.
  std::vector<const DesignPoint*> deck;
  for (const DesignPoint& point : design) deck.push_back(&point);
  Rng shuffler(seed, 0);
  for (std::size_t i = deck.size(); i > 1; --i)
    std::swap(deck[i - 1],
              deck[static_cast<std::size_t>(shuffler.uniform() * static_cast<double>(i))]);
  for (int p = 1; p <= truth.plates; ++p) {
    Plate plate(p, truth, seed, simulation);
    plate.run_in();
    for (std::size_t i = static_cast<std::size_t>(p - 1); i < deck.size();
         i += static_cast<std::size_t>(truth.plates))
      plate.run_point(*deck[i]);
    plate.run_out();
  }
  int number = truth.plates;
  for (const char* name : {"floating", "constant"}) {
    Plate plate(++number, truth, seed, simulation);
    run_sequence(plate, name, ranges_of(design), truth);
  }
  return simulation;
}

std::vector<Sample> simulate_traces(const Campaign& campaign, int closings, std::uint64_t seed) {
  constexpr double step = 0.01, pause = 0.5, rise = 0.05;  // s
  Rng rng(seed, 1'000'000);
  std::vector<Sample> samples;
  long long tick = 0;
  const auto add = [&](double speed, double torque, double temperature) {
    samples.push_back({1, static_cast<double>(tick++) * step,
                       rounded(std::max(0.0, speed + 0.1 * rng.normal()), 100),
                       rounded(torque + 0.05 * rng.normal(), 100),
                       rounded(temperature + 0.05 * rng.normal(), 100)});
  };
  for (int c = 0; c < closings && c < std::ssize(campaign.cycles); ++c) {
    const OperatingPoint& at = campaign.cycles[static_cast<std::size_t>(c)].at;
    for (double t = 0; t < pause; t += step) add(at.slip_speed, 0, at.temperature - 2);
    for (double t = 0; t < at.closing_time; t += step) {
      add(at.slip_speed * (1 - t / at.closing_time), at.torque * std::min(1.0, (t + step) / rise),
          at.temperature - 2 + 4 * t / at.closing_time);
    }
    for (double t = 0; t < pause; t += step) add(0, 0, at.temperature + 2);
  }
  return samples;
}

}  // namespace wearwell::clutch
