// What each family of the list is, by identities: special cases of one another, what a threshold does, means as integrals.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "wearwell/math/constants.h"
#include "wearwell/prob/response.h"

namespace wearwell {
namespace {

// The form of so many parameters.
const ResponseForm& form(const std::string& name, std::size_t family_parameters) {
  for (const ResponseForm& each : response_forms()) {
    if (each.name == name && each.family_parameters.size() == family_parameters) return each;
  }
  throw std::logic_error("no family " + name);
}

using FamilyParameters = std::vector<double>;

struct Member {
  ResponseFamily family;
  FamilyParameters family_parameters;

  Member(const std::string& name, const FamilyParameters& values)
      : family(form(name, values.size()).family), family_parameters(values) {}
  double term(Censoring seen, double y, double until = 0) const {
    return log_response_value(family, {seen, y, until}, family_parameters.data());
  }
};

// Densities and probabilities of a and, at `other(y)` with the factor `rate` of densities, of b.
void expect_same(const Member& a, const Member& b, double tolerance = 1e-11) {
  for (const double y : {0.02, 0.3, 1.0, 1.7, 4.0, 9.0}) {
    for (const Censoring seen : {Censoring::none, Censoring::right, Censoring::left}) {
      const double of_a = a.term(seen, y), of_b = b.term(seen, y);
      EXPECT_NEAR(of_a, of_b, tolerance * (1 + std::abs(of_b)))
          << y << " seen " << static_cast<int>(seen);
    }
    EXPECT_NEAR(a.term(Censoring::interval, y, 1.4 * y), b.term(Censoring::interval, y, 1.4 * y),
                tolerance * (1 + std::abs(b.term(Censoring::interval, y, 1.4 * y))));
  }
  EXPECT_NEAR(
      center(a.family, a.family_parameters.data()) / center(b.family, b.family_parameters.data()),
      1, 1e-9);
  for (const double p : {1e-6, 0.1, 0.5, 0.99}) {
    EXPECT_NEAR(quantile(a.family, p, a.family_parameters.data()) /
                    quantile(b.family, p, b.family_parameters.data()),
                1, 1e-9);
  }
}

// Meeker and Escobar (1998), sec. 5.4.2.
TEST(Family, GeneralizedGammaHoldsTheOthers) {
  for (const double sigma : {0.4, 1.0, 1.6}) {
    expect_same({"generalized-gamma", {1.5, sigma, 1}}, {"weibull", {1.5, 1 / sigma}});
    expect_same({"generalized-gamma", {1.5, sigma, 0}}, {"lognormal", {1.5, sigma}});
    expect_same({"generalized-gamma", {1.5, sigma, sigma}},
                {"gamma", {1 / (sigma * sigma), 1.5 * sigma * sigma}});
    expect_same({"generalized-gamma", {1.5, sigma, -1}}, {"frechet", {1.5, 1 / sigma}});
  }
  expect_same({"generalized-gamma", {1.5, 1, 1}}, {"exponential", {1.5}});
}

// Where lambda goes through 0, and from the expansion to the series: no step.
TEST(Family, GeneralizedGammaIsSmoothInLambda) {
  constexpr double near = 1e-9;
  for (const double at : {-0.05, 0.0, 0.05}) {
    for (const double y : {0.2, 0.9, 1.6, 2.5, 7.0}) {
      for (const Censoring seen : {Censoring::none, Censoring::right, Censoring::left}) {
        const double family_parameters[][3] = {
            {1.5, 0.5, at - near}, {1.5, 0.5, at}, {1.5, 0.5, at + near}};
        const ResponseFamily family = form("generalized-gamma", 3).family;
        const ResponseTerm below = log_response(family, {seen, y}, family_parameters[0]),
                           here = log_response(family, {seen, y}, family_parameters[1]),
                           above = log_response(family, {seen, y}, family_parameters[2]);
        const double size = 1 + std::abs(here.value);
        EXPECT_NEAR(above.value - below.value, 2 * near * here.slope[2], 2e-12 * size) << at << y;
        for (int s = 0; s < 3; ++s)
          EXPECT_NEAR(above.slope[s], below.slope[s], 1e-7 * (size + std::abs(here.slope[s])));
      }
    }
  }
}

// 1/Y has the distribution of 1/scale and -lambda; of Birnbaum and Saunders that of 1/scale.
TEST(Family, ReciprocalsStayInTheFamily) {
  for (const double lambda : {0.3, 1.0, 2.2}) {
    const Member y("generalized-gamma", {1.5, 0.6, lambda}),
        reciprocal("generalized-gamma", {1 / 1.5, 0.6, -lambda});
    for (const double at : {0.2, 1.0, 4.0}) {
      const double below = y.term(Censoring::left, at);
      EXPECT_NEAR(below, reciprocal.term(Censoring::right, 1 / at), 1e-11 * (1 + std::abs(below)));
    }
  }
  const Member y("birnbaum-saunders", {3, 0.7}), reciprocal("birnbaum-saunders", {1. / 3, 0.7});
  for (const double at : {0.1, 1.0, 3.0, 20.0}) {
    EXPECT_NEAR(y.term(Censoring::left, at), reciprocal.term(Censoring::right, 1 / at), 1e-12);
    const double z = (std::sqrt(at / 3) - std::sqrt(3 / at)) / 0.7;
    EXPECT_NEAR(std::exp(y.term(Censoring::left, at)), 0.5 * std::erfc(-z / std::sqrt(2.0)), 1e-14);
  }
  EXPECT_DOUBLE_EQ(quantile(y.family, 0.5, y.family_parameters.data()), 3);
  EXPECT_DOUBLE_EQ(center(y.family, y.family_parameters.data()), 3 * (1 + 0.5 * 0.7 * 0.7));
}

// The quantile of p has the probability p below it, also far in the tails.
TEST(Family, QuantilesInvertTheDistribution) {
  std::vector<Member> members = {{"exponentiated-weibull", {1.5, 2.2, 0.4}}};
  for (const double shape : {0.08, 0.7, 3.0, 40.0, 1e4}) {
    members.push_back({"gamma", {shape, 2}});
    members.push_back({"inverse-gaussian", {1.5, shape}});
  }
  for (const double lambda : {-6.0, -1.4, -0.3, -0.04, -1e-9, 0.0, 1e-5, 0.05, 0.31, 0.9, 2.5, 7.0})
    for (const double sigma : {0.02, 0.6, 2.0})
      members.push_back({"generalized-gamma", {1.5, sigma, lambda}});
  for (const Member& each : members) {
    const double* s = each.family_parameters.data();
    for (const double p : {1e-9, 1e-4, 0.01, 0.1, 0.4999, 0.5, 0.8, 0.99, 1 - 1e-6}) {
      const double y = quantile(each.family, p, s);
      if (!(y > 1e-250 && y < 1e250)) continue;
      const bool below = p < 0.5;
      const double tail = each.term(below ? Censoring::left : Censoring::right, y),
                   wanted = below ? std::log(p) : std::log1p(-p);
      // The tail changes by this much with y, which is good to 1e-12.
      const double slope = std::exp(each.term(Censoring::none, y) + std::log(y) - tail);
      EXPECT_NEAR(tail, wanted, 4e-12 * (1 + slope)) << s[0] << " " << s[1] << " " << p;
    }
  }
}

// The last of so many Weibull lives; the first keeps the shape.
TEST(Family, ExponentiatedWeibullIsTheLastOfSeveral) {
  expect_same({"exponentiated-weibull", {1.5, 2.2, 1}}, {"weibull", {1.5, 2.2}});
  const Member last("exponentiated-weibull", {1.5, 2.2, 3}), one("weibull", {1.5, 2.2});
  for (const double y : {0.01, 0.4, 1.5, 3.0, 12.0}) {
    const double below = one.term(Censoring::left, y), above = one.term(Censoring::right, y);
    EXPECT_NEAR(last.term(Censoring::left, y), 3 * below, 1e-13 * (1 + std::abs(3 * below)));
    // 1 - (1 - S)^3 = S (3 - 3 S + S^2)
    const double s = std::exp(above), expected = above + std::log(3 - 3 * s + s * s);
    EXPECT_NEAR(last.term(Censoring::right, y), expected, 1e-12 * (1 + std::abs(expected)));
  }
}

// Parameters of each kind that suit every family.
FamilyParameters plausible(const ResponseForm& form) {
  FamilyParameters family_parameters;
  for (const ParameterForm& family_parameter : form.family_parameters) {
    if (family_parameter.name == "threshold") {
      family_parameters.push_back(0.3);
    } else {
      family_parameters.push_back(family_parameter.kind == ParameterKind::real    ? 0.4
                                  : family_parameter.kind == ParameterKind::scale ? 1.4
                                  : family_parameter.name == "log10_sd"
                                      ? 0.3
                                      : 2.6 - 0.7 * double(family_parameters.size()));
    }
  }
  return family_parameters;
}

TEST(Family, AThresholdMovesIt) {
  int tried = 0;
  for (const ResponseForm& each : response_forms()) {
    if (each.family_parameters.back().name != "threshold") continue;
    ++tried;
    SCOPED_TRACE(each.name);
    EXPECT_TRUE(each.family_parameters.back().optional);
    const FamilyParameters family_parameters = plausible(each);
    FamilyParameters without = family_parameters;
    without.pop_back();
    std::vector<ResponseFamily> plain;
    for (const ResponseForm& other : response_forms()) {
      if (other.name == each.name && other.family_parameters.size() == without.size() &&
          other.family_parameters.front().name == each.family_parameters.front().name)
        plain.push_back(other.family);
    }
    ASSERT_EQ(plain.size(), 1u);
    const double moved = family_parameters.back();
    for (const double y : {0.2, 1.0, 2.5}) {
      for (const Censoring seen :
           {Censoring::none, Censoring::right, Censoring::left, Censoring::interval}) {
        const Response at{seen, y + moved, 1.3 * y + moved}, less{seen, y, 1.3 * y};
        const ResponseTerm here = log_response(each.family, at, family_parameters.data()),
                           there = log_response(plain[0], less, without.data());
        EXPECT_NEAR(here.value, there.value, 1e-12 * (1 + std::abs(there.value)));
        for (std::size_t s = 0; s < without.size(); ++s)
          EXPECT_NEAR(here.slope[s], there.slope[s], 1e-9 * (1 + std::abs(there.slope[s])));
      }
    }
    EXPECT_EQ(
        log_response_value(each.family, {Censoring::none, 0.5 * moved}, family_parameters.data()),
        -infinity);
    EXPECT_EQ(
        log_response_value(each.family, {Censoring::right, 0.5 * moved}, family_parameters.data()),
        0);
    EXPECT_NEAR(quantile(each.family, 0.3, family_parameters.data()),
                moved + quantile(plain[0], 0.3, without.data()), 1e-11);
  }
  EXPECT_EQ(tried, 12);
}

// By the integral of y times its density; of the loglogistic law `center` is the median.
TEST(Family, CentersAreMeans) {
  using boost::math::quadrature::gauss_kronrod;
  const auto expect_mean = [](const ResponseForm& of, const FamilyParameters& family_parameters) {
    SCOPED_TRACE(testing::Message() << of.name << " " << family_parameters.size());
    const double from =
        of.family_parameters.back().name == "threshold" ? family_parameters.back() : 0;
    const double low = quantile(of.family, 1e-15, family_parameters.data()),
                 high = quantile(of.family, 1 - 1e-13, family_parameters.data());
    const auto moment = [&](double y) {
      return y * std::exp(
                     log_response_value(of.family, {Censoring::none, y}, family_parameters.data()));
    };
    const double mean =
        of.positive ? gauss_kronrod<double, 61>::integrate(
                          [&](double u) { return moment(from + std::exp(u)) * std::exp(u); },
                          std::log(low - from), std::log(high - from), 15, 1e-10)
                    : gauss_kronrod<double, 61>::integrate(moment, low, high, 15, 1e-10);
    // Beyond `high` a heavy tail has some of the mean.
    EXPECT_NEAR(center(of.family, family_parameters.data()), mean, 1e-7 * mean + 1e-12 * high);
  };
  for (const ResponseForm& each : response_forms()) {
    if (!each.counted && each.name != "loglogistic") expect_mean(each, plausible(each));
  }
  const ResponseForm& generalized = form("generalized-gamma", 3);
  for (const double lambda : {-1.2, -0.1, 1e-7, 3.0}) expect_mean(generalized, {1.4, 0.2, lambda});
  const double without_mean[] = {1.4, 0.8, -1.3};
  EXPECT_DOUBLE_EQ(center(generalized.family, without_mean),
                   quantile(generalized.family, 0.5, without_mean));
}

TEST(Family, TheListIsWhatCodeNames) {
  using enum ResponseFamily;
  const std::pair<ResponseFamily, const char*> named[] = {
      {normal, "normal"},
      {lognormal, "lognormal"},
      {lognormal_by_moments, "lognormal"},
      {log10_normal, "log10-normal"},
      {student_t, "student-t"},
      {weibull, "weibull"},
      {smallest_extreme_value, "smallest-extreme-value"},
      {largest_extreme_value, "largest-extreme-value"},
      {exponential, "exponential"},
      {gamma, "gamma"},
      {loglogistic, "loglogistic"},
      {inverse_gaussian, "inverse-gaussian"},
      {poisson, "poisson"},
      {binomial, "binomial"},
      {flat, "flat"},
      {uniform, "uniform"},
      {half_normal, "half-normal"},
      {half_cauchy, "half-cauchy"},
      {inverse_gamma, "inverse-gamma"},
      {beta, "beta"},
      {jeffreys, "jeffreys"}};
  for (const auto& [family, name] : named) {
    EXPECT_EQ(form_of(family).name, name);
    EXPECT_EQ(form_of(family).family, family);
  }
  EXPECT_EQ(form_of(lognormal).family_parameters[0].name, "median");
  EXPECT_EQ(form_of(lognormal_by_moments).family_parameters[0].name, "mean");
}

TEST(Family, TheFormIsThatWhoseParametersAreGiven) {
  const auto chosen = [](const std::string& name, const std::vector<std::string>& given) {
    const ResponseForm* found =
        given_form(response_forms(), name, [&](std::string_view family_parameter) {
          return std::find(given.begin(), given.end(), family_parameter) != given.end();
        });
    return found ? found->family_parameters.size() : 0;
  };
  EXPECT_EQ(chosen("weibull", {"scale", "shape"}), 2u);
  EXPECT_EQ(chosen("weibull", {"scale", "shape", "threshold"}), 3u);
  EXPECT_EQ(chosen("weibull", {"scale"}), 0u);
  EXPECT_EQ(chosen("generalized-gamma", {"scale", "sigma", "lambda", "threshold"}), 4u);
  EXPECT_EQ(chosen("normal", {"mean", "sd", "threshold"}), 2u);
}

}  // namespace
}  // namespace wearwell
