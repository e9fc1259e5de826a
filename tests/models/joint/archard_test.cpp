#include "wearwell/models/joint/archard.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/between.h"

#include "wearwell/math/constants.h"

namespace wearwell::joint {
namespace {

// The joint of An et al. (2011) in SI: k about 5e-13 m^3/(N m), some 1e5 J of work.
struct Case {
  Archard law;
  double x[4];  // k, sigma, V0 or exponent, exponent
};

Case any_case() {
  Case c{{*rc::gen::arbitrary<bool>(), *rc::gen::arbitrary<bool>(), *between(1e3, 1e6)},
         {*between(1e-14, 1e-11), 1e-9, 0, 0}};
  if (c.law.has_constant) c.x[2] = *between(1e-11, 1e-8) * (*rc::gen::arbitrary<bool>() ? 1 : -1);
  if (c.law.has_exponent) c.x[c.law.dimension() - 1] = *between(0.3, 3);
  return c;
}

RC_GTEST_PROP(Archard, WorkAtInvertsMeanVolume, ()) {
  const Case c = any_case();
  const double work = *between(1, 1e7);
  const double volume = c.law.mean_volume(c.x, work);
  const double rise = volume - (c.law.has_constant ? c.x[2] : 0);
  RC_PRE(rise > 1e-4 * std::abs(volume));  // else V0 has swallowed the digits
  RC_ASSERT(std::abs(c.law.work_at(c.x, volume) / work - 1) < 1e-10);
}

RC_GTEST_PROP(Archard, WearRisesWithWorkAndCoefficient, ()) {
  const Case c = any_case();
  const double work = *between(1, 1e7), factor = *between(1.001, 10);
  const double volume = c.law.mean_volume(c.x, work);
  RC_ASSERT(c.law.mean_volume(c.x, work * factor) >= volume);
  Case faster = c;
  faster.x[0] *= factor;
  RC_ASSERT(faster.law.mean_volume(faster.x, work) >= volume);
  // And the faster it wears, the sooner a limit is reached.
  RC_ASSERT(faster.law.work_at(faster.x, 1e-7) <= c.law.work_at(c.x, 1e-7));
}

RC_GTEST_PROP(Archard, ExponentOneIsArchard, ()) {
  const double k = *between(1e-14, 1e-11), work = *between(1, 1e7);
  const double plain[] = {k, 1e-9}, general[] = {k, 1e-9, 2e-9, 1};
  const double volume = Archard{}.mean_volume(plain, work);
  RC_ASSERT(volume == k * work);
  RC_ASSERT(std::abs(Archard{true, true, 5e4}.mean_volume(general, work) - 2e-9 - volume) <=
            1e-14 * (volume + 2e-9));
}

// Whatever the exponent, at W_ref the volume is k W_ref.
TEST(Archard, ReferenceWorkFixesTheCoefficient) {
  for (const double exponent : {0.2, 1.0, 2.7}) {
    const double x[] = {4e-13, 1e-9, exponent};
    EXPECT_DOUBLE_EQ((Archard{false, true, 3e4}.mean_volume(x, 3e4)), 4e-13 * 3e4);
  }
}

TEST(Archard, NothingWornWithoutWork) {
  const double x[] = {4e-13, 1e-9, 2e-9, 0.5};
  EXPECT_EQ((Archard{true, true, 3e4}.mean_volume(x, 0)), 2e-9);
}

TEST(Archard, LimitsThatAreNeverOrAlreadyReached) {
  const Archard law{true, true, 1e4};
  const double still[] = {0, 1e-9, 1e-9, 1};
  EXPECT_EQ(law.work_at(still, 5e-9), infinity);
  EXPECT_EQ(law.work_at(still, 1e-9), 0);
  EXPECT_EQ(law.work_at(still, 0.5e-9), 0);
  const double constant[] = {1e-13, 1e-9, 0, 0};  // V = k W_ref from the first work on
  EXPECT_EQ(law.work_at(constant, 5e-9), infinity);
}

// The gradient of the likelihood, which the sampler follows.
RC_GTEST_PROP(ArchardLikelihood, GradientIsTheDifferenceQuotient, ()) {
  Case c = any_case();
  if (c.law.has_constant) c.x[2] = std::abs(c.x[2]);  // a lognormal mean stays positive
  const auto family = *rc::gen::element(ObservationFamily::normal, ObservationFamily::lognormal);
  const Inspections inspections{{3e2, 4e3, 6e4}, {2e-9, 5e-9, 30e-9}};
  const auto likelihood = archard_likelihood(c.law, family, inspections, 3);
  const auto n = static_cast<std::size_t>(c.law.dimension());
  RC_ASSERT(static_cast<std::size_t>(likelihood->dimension()) == n);
  c.x[1] = *between(1e-9, 1e-8);
  std::vector<double> gradient(n);
  const double value = likelihood->value_and_gradient(std::span(c.x, n), gradient);
  RC_ASSERT(std::abs(value - likelihood->value(std::span(c.x, n))) <= 1e-12 * std::abs(value));
  for (std::size_t i = 0; i < n; ++i) {
    const double at = c.x[i], h = 1e-4 * std::abs(at);
    c.x[i] = at + h;
    const double right = likelihood->value(std::span(c.x, n));
    c.x[i] = at - h;
    const double left = likelihood->value(std::span(c.x, n));
    c.x[i] = at;
    // In units of the parameter: what a change by itself would do.
    const double slope = gradient[i] * at, quotient = (right - left) / (2 * h) * at;
    RC_ASSERT(std::abs(slope - quotient) < 1e-5 * (1 + std::abs(value) + std::abs(slope)));
  }
}

TEST(ArchardLikelihood, OfTheFirstInspections) {
  const Inspections all{{3e2, 4e3, 6e4}, {2e-9, 5e-9, 30e-9}}, two{{3e2, 4e3}, {2e-9, 5e-9}};
  const double x[] = {5e-13, 2e-9};
  EXPECT_EQ(archard_likelihood({}, ObservationFamily::normal, all, 2)->value(x),
            archard_likelihood({}, ObservationFamily::normal, two, 2)->value(x));
}

// By hand: sum w v / sum w^2 = (2 + 12)/5, residuals -0.8 and 0.4.
TEST(LeastSquares, ThroughTheOrigin) {
  const LeastSquares fit = least_squares({{1, 2}, {2, 6}});
  EXPECT_DOUBLE_EQ(fit.k, 2.8);
  EXPECT_DOUBLE_EQ(fit.sigma, std::sqrt((0.64 + 0.16) / 2));
}

// Many inspections are summed beforehand: the same likelihood as row by row, that is the sum of its
// factors, wherever it is asked.
RC_GTEST_PROP(ArchardLikelihood, OfManyIsTheSumOfItsFactors, ()) {
  const bool constant = *rc::gen::arbitrary<bool>();
  const Archard law{constant, false, 1e5};
  const double k = *between(1e-13, 1e-11), sigma = *between(1e-11, 1e-8),
               v0 = constant ? 1e-6 * (*between(1, 3) - 2) : 0;
  Inspections inspections;
  for (int i = 1; i <= 700; ++i) {
    const double work = 1e5 * i / 700.0;
    inspections.work.push_back(work);
    inspections.volume.push_back(v0 + k * work + sigma * std::sin(12345.678 * i));
  }
  const auto likelihood =
      archard_likelihood(law, ObservationFamily::normal, inspections, inspections.work.size());
  const double x[] = {k * *between(0.5, 2), sigma * *between(0.1, 10),
                      v0 + sigma * (*between(1, 11) - 6)};
  const std::span<const double> at(x, static_cast<std::size_t>(law.dimension()));
  double sum = 0, scale = 0;
  for (const double each : likelihood->pointwise(at)) {
    sum += each;
    scale += std::abs(each);
  }
  double gradient[3];
  RC_ASSERT(std::abs(likelihood->value(at) - sum) <= 1e-11 * scale);
  const double value = likelihood->value(at);
  RC_ASSERT(std::abs(likelihood->value_and_gradient(at, {gradient, at.size()}) - value) <=
            1e-14 * scale);
  for (std::size_t j = 0; j < at.size(); ++j) {
    double low[3], high[3];
    std::copy(at.begin(), at.end(), low);
    std::copy(at.begin(), at.end(), high);
    const double step = 1e-5 * (j == 2 ? sigma : x[j]);
    low[j] -= step;
    high[j] += step;
    const double slope =
        (likelihood->value({high, at.size()}) - likelihood->value({low, at.size()})) / (2 * step);
    RC_ASSERT(std::abs(gradient[j] - slope) <= 1e-5 * (std::abs(slope) + 1e-6 * scale / step));
  }
}

}  // namespace
}  // namespace wearwell::joint
