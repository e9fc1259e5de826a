#include "wearwell/models/clutch/cycle_sum.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/base/error.h"

namespace wearwell::clutch {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

/// exp(-x) beyond this is negligible beside 1.
constexpr double negligible = 40;

/// Logarithm, padded until the length is a multiple of the machine's vectors: otherwise another
/// routine computes the last numbers of an array, with other last bits.
ArrayXd padded_log(const ArrayXd& x) {
  constexpr Index vector = 8;
  ArrayXd padded = ArrayXd::Ones((x.size() + vector - 1) / vector * vector);
  padded.head(x.size()) = x;
  return padded.log();
}

/// One polynomial at many cycles, by powers of ds with coefficients in Td and Mz. Logarithms and
/// `out` are padded.
void evaluate(const WearPolynomial& polynomial, const ArrayXd& log_speed, const ArrayXd& log_time,
              const ArrayXd& temperature, const ArrayXd& torque, ArrayXd& distance, ArrayXd& out) {
  distance = (polynomial.r * log_speed + polynomial.q * log_time).exp();
  double c[4][4][4] = {};
  for (const auto& m : polynomial.monomials) c[m.ds][m.temperature][m.torque] += m.coefficient;
  out.setZero(distance.size());
  for (Index i = 0; i < temperature.size(); ++i) {
    const double s = distance[i], t = temperature[i], m = torque[i];
    // Computing all twenty terms of a cubic is cheaper than selecting among them.
    const double c0 = c[0][0][0] + m * (c[0][0][1] + m * (c[0][0][2] + m * c[0][0][3])) +
                      t * (c[0][1][0] + m * (c[0][1][1] + m * c[0][1][2]) +
                           t * (c[0][2][0] + m * c[0][2][1] + t * c[0][3][0]));
    const double c1 = c[1][0][0] + m * (c[1][0][1] + m * c[1][0][2]) +
                      t * (c[1][1][0] + m * c[1][1][1] + t * c[1][2][0]);
    const double c2 = c[2][0][0] + m * c[2][0][1] + t * c[2][1][0];
    out[i] = c0 + s * (c1 + s * (c2 + s * c[3][0][0]));
  }
}

}  // namespace

double PlateWear::full_sd(double plate_sd) const {
  const double by_plate = volume * plate_sd;
  const double model = replicates.size() > 0 ? (replicates - volume).square().mean() : 0;
  return std::sqrt(variance + model + by_plate * by_plate);
}

CycleSum::CycleSum(const WearModel& model, bool with_replicates, NotFinite not_finite)
    : model_(model),
      polynomial_(model.polynomial()),
      with_replicates_(with_replicates && !model.replicates.empty()),
      not_finite_(not_finite) {
  if (!with_replicates_) return;
  const Index count = std::ssize(model.replicates);
  for (ArrayXd* each : {&slow_, &fast_, &slow_energy_, &fast_energy_}) each->resize(count);
  for (Index b = 0; b < count; ++b) {
    const RunIn& run_in = model.replicates[static_cast<std::size_t>(b)].run_in;
    slow_[b] = run_in.slow;
    fast_[b] = run_in.fast;
    slow_energy_[b] = run_in.slow_energy;
    fast_energy_[b] = run_in.fast_energy;
  }
}

void CycleSum::rates(const CycleColumns& cycles, Rates& rates) const {
  const Index n = cycles.size();
  const ArrayXd log_speed = padded_log(cycles.slip_speed),
                log_time = padded_log(cycles.closing_time);
  ArrayXd distance;
  evaluate(polynomial_, log_speed, log_time, cycles.temperature, cycles.torque, distance, rates.w);

  const auto& law = model_.scatter;
  if (law.kind == ScatterKind::exponential) {
    rates.sigma = law.p[0] * (law.p[1] * rates.w).exp();
    rates.sigma.conservativeResize(n);
  } else if (law.kind == ScatterKind::conditions) {
    rates.sigma = law.p[0] + law.p[1] * cycles.temperature + law.p[2] * cycles.slip_speed +
                  law.p[3] * cycles.torque + law.p[4] * cycles.closing_time;
  } else {
    rates.sigma = law.p[0] + law.p[1] * rates.w.head(n);
    if (law.kind == ScatterKind::quadratic) rates.sigma += law.p[2] * rates.w.head(n).square();
  }
  // Not max(), which would hide NaN.
  const double floor = model_.scatter_floor;
  rates.sigma = (rates.sigma < floor).select(floor, rates.sigma);
  rates.w.conservativeResize(n);

  rates.outside.assign(static_cast<std::size_t>(n), 0);
  const ArrayXd* columns[] = {&cycles.slip_speed, &cycles.torque, &cycles.temperature,
                              &cycles.closing_time};
  for (std::size_t c = 0; c < inputs.size(); ++c) {
    const double low = model_.lowest.*inputs[c].value, high = model_.highest.*inputs[c].value;
    const double slack = validity_slack * (high - low);
    const double from = low - slack, to = high + slack;
    for (Index i = 0; i < n; ++i) {
      const double x = (*columns[c])[i];
      rates.outside[static_cast<std::size_t>(i)] |= static_cast<unsigned>((x < from) | (x > to))
                                                    << c;
    }
  }
  for (Index i = 0; i < n; ++i) {
    if (rates.w[i] < 0) {
      rates.w[i] = 0;
      rates.outside[static_cast<std::size_t>(i)] |= negative;
    }
    if (!std::isfinite(rates.w[i]) || !std::isfinite(rates.sigma[i]))
      rates.outside[static_cast<std::size_t>(i)] |= no_number;
  }
  if (!with_replicates_) return;
  rates.replicates.resize(n, std::ssize(model_.replicates));
  ArrayXd w;
  for (Index b = 0; b < rates.replicates.cols(); ++b) {
    evaluate(model_.replicates[static_cast<std::size_t>(b)].w, log_speed, log_time,
             cycles.temperature, cycles.torque, distance, w);
    rates.replicates.col(b) = (w.head(n) < 0).select(0, w.head(n));
    if (rates.replicates.col(b).isFinite().all()) continue;
    for (Index i = 0; i < n; ++i) {
      if (!std::isfinite(rates.replicates(i, b)))
        rates.outside[static_cast<std::size_t>(i)] |= no_number;
    }
  }
}

PlateWear& CycleSum::plate(int number) {
  if (current_ < plates_.size() && plates_[current_].plate == number) return plates_[current_];
  const auto [at, is_new] = place_.try_emplace(number, plates_.size());
  current_ = at->second;
  if (!is_new) return plates_[current_];
  plates_.push_back({});
  plates_.back().plate = number;
  if (!names_.empty()) plates_.back().name = names_.at(static_cast<std::size_t>(number - 1));
  if (with_replicates_) plates_.back().replicates = ArrayXd::Zero(slow_.size());
  return plates_.back();
}

// False, with nothing changed, if a number would not be finite.
bool CycleSum::step(PlateWear& p, const CycleColumns& cycles, const Rates& rates, Index i) {
  const RunIn& run_in = model_.run_in;
  const double energy = cycles.energy[i];
  const double now = p.energy < negligible * run_in.slow_energy ? run_in.g(p.energy) : 1.0;
  const double volume = p.volume + now * rates.w[i] * energy;
  const double scatter = rates.sigma[i] * energy;
  const double variance = p.variance + scatter * scatter;
  if (rates.outside[static_cast<std::size_t>(i)] & no_number || !std::isfinite(volume) ||
      !std::isfinite(variance) || !std::isfinite(p.energy + energy))
    return false;
  if (with_replicates_) {
    if (p.energy < negligible * slow_energy_.maxCoeff()) {
      g_ = 1 + slow_ * (-p.energy / slow_energy_).exp() + fast_ * (-p.energy / fast_energy_).exp();
      worn_ = p.replicates + g_ * rates.replicates.row(i).transpose() * energy;
    } else {
      worn_ = p.replicates + rates.replicates.row(i).transpose() * energy;
    }
    if (!std::isfinite(worn_.sum())) return false;
    p.replicates.swap(worn_);
  }
  p.volume = volume;
  p.variance = variance;
  p.energy += energy;
  const double closing =
      closing_energy({cycles.slip_speed[i], cycles.torque[i], 0, cycles.closing_time[i]});
  p.closings += closing;
  p.outliers.look_at(static_cast<long long>(cycles.number[static_cast<std::size_t>(i)]), energy,
                     closing);
  return true;
}

void CycleSum::add(const CycleColumns& cycles, const Rates& rates, std::size_t first_row,
                   Trace* trace) {
  for (Index i = 0; i < cycles.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    PlateWear& p = plate(static_cast<int>(cycles.plate[at]));
    const auto number = static_cast<long long>(cycles.number[at]);
    if (number <= p.last_number)
      throw InputError(
          fmt::format("row {}: plate {}, cycle {} follows cycle {}; cycles must ascend",
                      first_row + at + 1, p.description(), number, p.last_number));
    const bool done = step(p, cycles, rates, i);
    if (!done && not_finite_ == NotFinite::refuse)
      throw InputError(fmt::format(
          "row {}: plate {}, cycle {}: the model has no finite wear at slip speed {:.6g} rad/s, "
          "torque {:.6g} N m, temperature {:.6g} degC, closing time {:.6g} s, energy {:.6g} J",
          first_row + at + 1, p.description(), number, cycles.slip_speed[i], cycles.torque[i],
          cycles.temperature[i], cycles.closing_time[i], cycles.energy[i]));
    p.last_number = number;
    if (done) {
      ++p.cycles;
    } else {
      ++p.skipped;
    }
    if (const unsigned bits = done ? rates.outside[at] : 0) {
      for (std::size_t c = 0; c < inputs.size(); ++c) p.outside[c] += bits >> c & 1;
      p.outside_any += (bits & (negative - 1)) != 0;
      p.clamped += (bits & negative) != 0;
    }
    if (trace) {
      trace->volume.push_back(p.volume);
      trace->sd.push_back(p.sd());
      if (with_replicates_) trace->full_sd.push_back(p.full_sd(model_.plate_sd));
      trace->skipped.push_back(!done);
    }
  }
}

void CycleSum::restore(std::vector<PlateWear> plates) {
  plates_ = std::move(plates);
  place_.clear();
  for (std::size_t i = 0; i < plates_.size(); ++i) place_[plates_[i].plate] = i;
  current_ = 0;
}

}  // namespace wearwell::clutch
