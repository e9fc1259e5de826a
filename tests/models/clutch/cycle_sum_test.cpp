#include "wearwell/models/clutch/cycle_sum.h"

#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "models/clutch/sample_campaign.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/models/clutch/cycle_table.h"

namespace wearwell::clutch {
namespace {

using testing::HasSubstr;

const RunIn run_in{0.4, 4, 78e6, 6e6};
const OperatingPoint middle{200, 50, 170, 2};

CycleColumns columns(const std::vector<Cycle>& cycles) {
  CycleColumns out;
  const auto n = std::ssize(cycles);
  for (auto* each :
       {&out.slip_speed, &out.torque, &out.temperature, &out.closing_time, &out.energy})
    each->resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Cycle& c = cycles[static_cast<std::size_t>(i)];
    out.plate.push_back(c.plate);
    out.number.push_back(static_cast<double>(c.number));
    out.slip_speed[i] = c.at.slip_speed;
    out.torque[i] = c.at.torque;
    out.temperature[i] = c.at.temperature;
    out.closing_time[i] = c.at.closing_time;
    out.energy[i] = c.energy;
  }
  return out;
}

void sum(CycleSum& to, const std::vector<Cycle>& cycles, CycleSum::Trace* trace = nullptr) {
  CycleSum::Rates rates;
  const CycleColumns c = columns(cycles);
  to.rates(c, rates);
  to.add(c, rates, 0, trace);
}

/// A model with all that a model can have.
WearModel full_model(ScatterKind kind) {
  WearModel model = constant_model(4 * mm3_per_MJ, 0, run_in);
  model.r = 1.2;
  model.q = 0.5;
  model.terms.push_back({"ds*Td", 1, 1, 0, 3e4, 2e5, 22 * mm3_per_MJ});
  model.terms.push_back({"Td*Td*Mz", 0, 2, 1, 3e5, 4e6, 18 * mm3_per_MJ});
  model.covariance = Eigen::MatrixXd::Zero(3, 3);
  const double u = mm3_per_MJ;
  const std::vector<std::vector<double>> p = {{50 * u, 0.02 / u},
                                              {65 * u, 2},
                                              {30 * u, 1, 0.01 / u},
                                              {10 * u, 0.1 * u, 0.2 * u, 0.3 * u, u}};
  model.scatter = {kind, p[static_cast<std::size_t>(kind)]};
  model.scatter_floor = 20 * u;
  model.plate_sd = 0.04;
  for (int b = 0; b < 3; ++b) {
    WearPolynomial w = model.polynomial();
    for (auto& m : w.monomials) m.coefficient *= 1 + 0.1 * b;
    w.q += 0.1 * b;
    model.replicates.push_back({w, {0.4 + 0.1 * b, 4, 78e6, 5e6 + 1e6 * b}});
  }
  return model;
}

/// Cycles of three plates, interleaved, some of them outside the range.
std::vector<Cycle> random_cycles(int count, std::uint64_t seed) {
  Rng rng(seed, 0);
  std::vector<Cycle> cycles;
  std::map<int, long long> number;
  for (int i = 0; i < count; ++i) {
    const int plate = 1 + static_cast<int>(3 * rng.uniform());
    const OperatingPoint at{rng.uniform(90, 310), rng.uniform(20, 80), rng.uniform(100, 250),
                            rng.uniform(0.5, 4)};
    cycles.push_back({plate, ++number[plate], at, closing_energy(at)});
  }
  return cycles;
}

// Haramina et al. (2025), section 3.5, by hand: two cycles of 1 MJ and 2 MJ at w = 20 mm^3/MJ.
TEST(CycleSum, ByHand) {
  const WearModel model = constant_model(20 * mm3_per_MJ, 100 * mm3_per_MJ, run_in);
  CycleSum s(model, false);
  CycleSum::Trace trace;
  sum(s, {{3, 1, middle, 1e6}, {3, 2, middle, 2e6}}, &trace);
  const double g0 = 1 + 0.4 + 4;
  const double g1 = 1 + 0.4 * std::exp(-1.0 / 78) + 4 * std::exp(-1.0 / 6);
  ASSERT_EQ(trace.volume.size(), 2u);
  EXPECT_NEAR(trace.volume[0], g0 * 20e-9, 1e-21);
  EXPECT_NEAR(trace.volume[1], g0 * 20e-9 + g1 * 40e-9, 1e-21);
  EXPECT_NEAR(trace.sd[0], 100e-9, 1e-21);
  EXPECT_NEAR(trace.sd[1], std::sqrt(1e4 + 4e4) * 1e-9, 1e-20);
  const PlateWear& p = s.plates().front();
  EXPECT_EQ(p.plate, 3);
  EXPECT_EQ(p.cycles, 2);
  EXPECT_EQ(p.last_number, 2);
  EXPECT_EQ(p.energy, 3e6);
}

// One cycle with an energy that no closing has is named, among a thousand, where the sum shows it, and among half a million, where
// it does not; also by a sum that goes on from a state.
TEST(CycleSum, ACycleWithAnEnergyThatNoClosingHasIsNamed) {
  const WearModel model = constant_model(20 * mm3_per_MJ, 100 * mm3_per_MJ, run_in);
  const double own = closing_energy(middle);
  for (const auto& [n, balanced] : {std::pair(1000, false), {500'000, true}}) {
    std::vector<Cycle> cycles;
    for (int i = 1; i <= n; ++i) cycles.push_back({7, i, middle, i == 500 ? 2.5e9 : own});
    CycleSum s(model, false);
    sum(s, cycles);
    const PlateWear& plate = s.plates().front();
    EXPECT_EQ(plate.balance().is_plausible(), balanced);
    EXPECT_EQ(plate.outliers.count, 1);
    EXPECT_EQ(plate.outliers.worst_cycle, 500);
    EXPECT_EQ(plate.outliers.worst_ratio, 2.5e9 / own);
    CycleSum later(model, false);
    later.restore(s.plates());
    sum(later, {{7, n + 1, middle, 9.9 * own}});  // a duty of its own
    const std::vector<std::string> problems = energy_problems(later);
    ASSERT_EQ(problems.size(), balanced ? 1u : 2u);
    EXPECT_THAT(problems.back(), testing::HasSubstr("plate 7: 1 cycle with more than 10 times"));
    EXPECT_THAT(problems.back(), testing::HasSubstr("cycle 500, 2.5e+09 J"));
  }
}

// n equal cycles: geometric series of the run-in, n times the variance of one.
TEST(CycleSum, ClosedFormOfConstantConditions) {
  const double w = 20 * mm3_per_MJ, sigma = 100 * mm3_per_MJ, e = 20e3;
  const WearModel model = constant_model(w, sigma, run_in);
  CycleSum s(model, false);
  constexpr int n = 30'000;
  std::vector<Cycle> cycles;
  for (int i = 1; i <= n; ++i) cycles.push_back({1, i, middle, e});
  sum(s, cycles);
  const auto series = [&](double scale) {
    return std::expm1(-n * e / scale) / std::expm1(-e / scale);
  };
  const double expected = w * e * (n + 0.4 * series(78e6) + 4 * series(6e6));
  EXPECT_NEAR(s.plates()[0].volume / expected, 1, 1e-11);
  EXPECT_NEAR(s.plates()[0].sd() / (std::sqrt(n) * sigma * e), 1, 1e-11);
  EXPECT_NEAR(s.plates()[0].energy / (n * e), 1, 1e-12);
}

// Rates by columns against the formulas one by one.
TEST(CycleSum, RatesAreThoseOfTheModel) {
  const auto cycles = random_cycles(1001, 1);
  for (const ScatterKind kind : scatter_kinds) {
    const WearModel model = full_model(kind);
    const WearPolynomial w = model.polynomial();
    CycleSum::Rates rates;
    CycleSum(model, true).rates(columns(cycles), rates);
    ASSERT_EQ(rates.w.size(), 1001);
    ASSERT_EQ(rates.sigma.size(), 1001);
    ASSERT_EQ(rates.replicates.rows(), 1001);
    for (Eigen::Index i = 0; i < 1001; ++i) {
      const OperatingPoint& at = cycles[static_cast<std::size_t>(i)].at;
      const double raw = w(at), rate = std::max(0.0, raw);
      EXPECT_NEAR(rates.w[i], rate, 1e-11 * 100 * mm3_per_MJ);
      EXPECT_NEAR(rates.sigma[i] / model.sigma(raw, at), 1, 1e-11);
      const unsigned bits = rates.outside[static_cast<std::size_t>(i)];
      EXPECT_EQ(bits & 15u, outside(model, at));
      EXPECT_EQ(bits >> 4, raw < 0 ? 1u : 0u);
      for (Eigen::Index b = 0; b < 3; ++b)
        EXPECT_NEAR(rates.replicates(i, b),
                    std::max(0.0, model.replicates[static_cast<std::size_t>(b)].w(at)),
                    1e-11 * 100 * mm3_per_MJ);
    }
  }
}

TEST(CycleSum, ConservesEnergyAndCounts) {
  const auto cycles = random_cycles(5000, 2);
  const WearModel model = full_model(ScatterKind::linear);
  CycleSum s(model, true);
  sum(s, cycles);
  ASSERT_EQ(s.plates().size(), 3u);
  double energy = 0, all = 0;
  long long count = 0, outside_any = 0, expected = 0;
  for (const Cycle& c : cycles) {
    all += c.energy;
    expected += outside(model, c.at) != 0;
  }
  for (const PlateWear& p : s.plates()) {
    energy += p.energy;
    count += p.cycles;
    outside_any += p.outside_any;
  }
  EXPECT_NEAR(energy / all, 1, 1e-12);
  EXPECT_EQ(count, 5000);
  EXPECT_EQ(outside_any, expected);
  EXPECT_GT(expected, 100);
}

// Cut anywhere, in one piece or in many, with a restart between: the same bits.
TEST(CycleSum, GoesOnToTheBit) {
  const auto cycles = random_cycles(3001, 3);
  for (const ScatterKind kind : scatter_kinds) {
    const WearModel model = full_model(kind);
    CycleSum whole(model, true);
    sum(whole, cycles);
    std::vector<PlateWear> state;
    std::size_t from = 0;
    for (const std::size_t until : {1, 2, 5, 136, 137, 1024, 2999, 3001}) {
      CycleSum part(model, true);
      part.restore(state);
      sum(part, {cycles.begin() + static_cast<std::ptrdiff_t>(from),
                 cycles.begin() + static_cast<std::ptrdiff_t>(until)});
      state = part.plates();
      from = until;
    }
    ASSERT_EQ(state.size(), whole.plates().size());
    for (std::size_t p = 0; p < state.size(); ++p) {
      const PlateWear &a = state[p], &b = whole.plates()[p];
      EXPECT_EQ(a.plate, b.plate);
      EXPECT_EQ(a.cycles, b.cycles);
      EXPECT_EQ(a.energy, b.energy);
      EXPECT_EQ(a.volume, b.volume);
      EXPECT_EQ(a.variance, b.variance);
      EXPECT_EQ(a.outside, b.outside);
      EXPECT_EQ(a.clamped, b.clamped);
      EXPECT_TRUE((a.replicates == b.replicates).all());
    }
  }
}

// Each replicate is the sum of a model of its own.
TEST(CycleSum, ReplicatesAreSumsOfTheirOwn) {
  const auto cycles = random_cycles(2000, 4);
  const WearModel model = full_model(ScatterKind::linear);
  CycleSum s(model, true);
  sum(s, cycles);
  for (const PlateWear& p : s.plates()) {
    double squares = 0;
    for (std::size_t b = 0; b < 3; ++b) {
      const Replicate& replicate = model.replicates[b];
      double volume = 0, energy = 0;
      for (const Cycle& c : cycles) {
        if (c.plate != p.plate) continue;
        volume += replicate.run_in.g(energy) * std::max(0.0, replicate.w(c.at)) * c.energy;
        energy += c.energy;
      }
      EXPECT_NEAR(p.replicates[static_cast<Eigen::Index>(b)] / volume, 1, 1e-10);
      squares += std::pow(volume - p.volume, 2) / 3;
    }
    const double full = std::sqrt(p.variance + squares + std::pow(0.04 * p.volume, 2));
    EXPECT_NEAR(p.full_sd(0.04) / full, 1, 1e-9);
    EXPECT_GT(p.full_sd(0.04), p.sd());
  }
}

// Where the map is negative nothing wears, and it is counted.
TEST(CycleSum, CountsWhereTheMapIsNegative) {
  WearModel model = constant_model(-1 * mm3_per_MJ, 10 * mm3_per_MJ, run_in);
  CycleSum s(model, false);
  sum(s, {{1, 1, middle, 1e4}});
  EXPECT_EQ(s.plates()[0].volume, 0);
  EXPECT_EQ(s.plates()[0].clamped, 1);
}

// A reading of 10000 degC: the scatter grows beyond all numbers, or the wear of one replicate does.
TEST(CycleSum, RefusesOrSkipsWhatIsNotFinite) {
  OperatingPoint hot = middle;
  hot.temperature = 10'000;
  WearModel model = constant_model(20 * mm3_per_MJ, 10 * mm3_per_MJ, run_in);
  model.scatter = {ScatterKind::exponential, {1e-14, 1e14}};
  model.terms.push_back({"Td", 0, 1, 0, 0, 1, 1e-15});
  WearModel of_replicate = constant_model(20 * mm3_per_MJ, 10 * mm3_per_MJ, run_in);
  of_replicate.replicates = {{{1, 1, {{0, 3, 0, 1e293}}}, run_in}};
  for (const WearModel* each : {&model, &of_replicate}) {
    CycleSum refusing(*each, true);
    EXPECT_THAT(message_of<InputError>([&] {
                  sum(refusing, {{1, 1, middle, 1e4}, {1, 2, hot, 1e4}, {1, 3, middle, 1e4}});
                }),
                HasSubstr("row 2: plate 1, cycle 2: the model has no finite wear"));
    CycleSum skipping(*each, true, NotFinite::skip), without(*each, true);
    sum(skipping, {{1, 1, middle, 1e4}, {1, 2, hot, 1e4}, {1, 3, middle, 1e4}});
    sum(without, {{1, 1, middle, 1e4}, {1, 3, middle, 1e4}});
    const PlateWear &a = skipping.plates()[0], &b = without.plates()[0];
    EXPECT_EQ(a.skipped, 1);
    EXPECT_EQ(a.cycles, 2);
    EXPECT_EQ(a.volume, b.volume);
    EXPECT_EQ(a.variance, b.variance);
    EXPECT_EQ(a.outside_any, 0);
    EXPECT_TRUE((a.replicates == b.replicates).all());
  }
}

TEST(CycleSum, RefusesASumBeyondAllNumbers) {
  const WearModel model = constant_model(20 * mm3_per_MJ, 0, run_in);
  CycleSum s(model, false);
  EXPECT_THAT(message_of<InputError>([&] {
                sum(s, {{1, 1, middle, 1.5e308}, {1, 2, middle, 1.5e308}});
              }),
              HasSubstr("row 2: plate 1, cycle 2"));
}

TEST(CycleSum, RefusesCyclesThatDoNotAscend) {
  const WearModel model = constant_model(20 * mm3_per_MJ, 0, run_in);
  CycleSum s(model, false);
  EXPECT_THAT(message_of<InputError>([&] {
                sum(s, {{1, 1, middle, 1}, {2, 1, middle, 1}, {1, 1, middle, 1}});
              }),
              HasSubstr("row 3: plate 1, cycle 1 follows cycle 1; cycles must ascend"));
}

}  // namespace
}  // namespace wearwell::clutch
