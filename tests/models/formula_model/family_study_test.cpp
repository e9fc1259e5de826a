// A study with another family (study/family_study.h): the same mean and standard deviation of log life.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/trigamma.hpp>
#include <cmath>
#include <utility>

#include "support/messages.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/study/family_study.h"

namespace wearwell::formula_model {
namespace {

using testing::HasSubstr;

constexpr double scale = 80, euler = 0.57721566490153286;
const double pi = std::acos(-1.0);

class FamilyStudyTest : public ScratchTest {
 protected:
  Source study(const std::string& likelihood) {
    write("d.csv", "life [h]\n40\n95\n120\n");
    return source_of(write("study.toml",
                           "model = \"formula\"\n[data]\nfile = \"d.csv\"\n"
                           "[data.columns]\nlife = \"life [h]\"\n" +
                               likelihood +
                               "[prior]\n"
                               "eta = { distribution = \"lognormal\", median = "
                               "\"100 h\", log_sd = 1 }\n"
                               "beta = { distribution = \"lognormal\", median = 1.5, "
                               "log_sd = 0.5 }\n"));
  }
  // log likelihood of the three lives, in hours, at eta and beta.
  static double value(const Source& source, double shape = 1.7, double third = 1) {
    const auto model = read_formula_model(TomlReader::parse(source.study), source);
    std::vector<double> x;
    for (const auto& each : model->parameters)
      x.push_back(each.name == "eta" ? scale * 3600 : each.name == "beta" ? shape : third);
    const auto density =
        formula_likelihood(std::make_shared<const FormulaRows>(model, model->data.table.rows));
    return density->value(x) + 3 * std::log(3600.0);
  }
};

template <class F>
double sum_of(const F& log_density) {
  return log_density(40.0) + log_density(95.0) + log_density(120.0);
}

double weibull(double t, double eta, double beta) {
  return std::log(beta / eta) + (beta - 1) * std::log(t / eta) - std::pow(t / eta, beta);
}

const std::string of_weibull =
    "[likelihood.life]   # lives\nfamily = \"weibull\"   # a comment\nscale  = \"eta\"\nshape = "
    "\"beta\"\n";
// Of log life, of Weibull lives with scale 80 h.
struct Moments {
  double middle, sd;  // middle is exp of the mean
  explicit Moments(double shape)
      : middle(scale * std::exp(-euler / shape)), sd(pi / std::sqrt(6.0) / shape) {}
};

double lognormal(double t, double middle, double sd) {
  const double z = std::log(t / middle) / sd;
  return -0.5 * z * z - std::log(t * sd * std::sqrt(2 * pi));
}

// Mean and standard deviation of the logarithm of a life with this log density, by the trapezoidal rule over log life.
template <class F>
std::pair<double, double> log_moments(const F& log_density) {
  double sum = 0, first = 0, second = 0;
  for (double u = std::log(scale) - 60; u < std::log(scale) + 20; u += 0.005) {
    const double p = std::exp(log_density(std::exp(u)) + u);
    sum += p;
    first += p * u;
    second += p * u * u;
  }
  const double mean = first / sum;
  return {mean, std::sqrt(second / sum - mean * mean)};
}

TEST_F(FamilyStudyTest, KeepsTheMomentsOfLogLife) {
  const Source source = study(of_weibull);
  for (const double shape : {1.7, 0.8}) {
    const auto [middle, sd] = Moments(shape);
    const auto in = [&](const char* family) {
      return value(study_with_family(source, family), shape);
    };
    EXPECT_NEAR(value(source, shape), sum_of([&](double t) { return weibull(t, scale, shape); }),
                1e-9);
    EXPECT_EQ(in("weibull"), value(source, shape));
    const auto normal = [&](double t) { return lognormal(t, middle, sd); };
    EXPECT_NEAR(in("lognormal"), sum_of(normal), 1e-8);
    const auto logistic = [&](double t) {
      const double b = pi / std::sqrt(3.0) / sd, u = std::pow(t / middle, b);
      return std::log(b / t) + std::log(u) - 2 * std::log1p(u);
    };
    EXPECT_NEAR(in("loglogistic"), sum_of(logistic), 1e-8);
    // exponent = 1 is the Weibull distribution, lambda = 0 the lognormal.
    EXPECT_NEAR(in("exponentiated-weibull"), value(source, shape), 1e-8);
    EXPECT_NEAR(value(study_with_family(source, "generalized-gamma"), shape, 0), sum_of(normal),
                1e-6);
  }
}

// Parameters by the formulas, and the moments that they have.
TEST_F(FamilyStudyTest, NearlyKeepsTheMomentsOfLogLife) {
  const Source source = study(of_weibull);
  for (const double shape : {1.7, 0.8, 0.5}) {
    const auto [middle, sd] = Moments(shape);
    const auto in = [&](const char* family) {
      return value(study_with_family(source, family), shape);
    };
    const double k = std::sqrt(1 + sd * sd) / (sd * sd);
    const double theta = middle * std::exp(-boost::math::digamma(k));
    EXPECT_NEAR(in("gamma"), sum_of([&](double t) {
                  return (k - 1) * std::log(t) - t / theta - std::lgamma(k) - k * std::log(theta);
                }),
                1e-8);
    EXPECT_NEAR(std::sqrt(boost::math::trigamma(k)), sd, 0.012 * sd);

    const double a = 2 * std::sinh(sd / 2) * (1 + 0.258 * sd * sd) / (1 + 0.1747 * sd * sd);
    const auto fatigue = [&](double t) {
      const double r = std::sqrt(t / middle), z = (r - 1 / r) / a;
      return -0.5 * z * z + std::log((r + 1 / r) / (2 * a * t * std::sqrt(2 * pi)));
    };
    EXPECT_NEAR(in("birnbaum-saunders"), sum_of(fatigue), 1e-8);
    EXPECT_NEAR(log_moments(fatigue).first, std::log(middle), 1e-6);
    EXPECT_NEAR(log_moments(fatigue).second, sd, 0.012 * sd);

    const double e = std::expm1(sd * sd);
    const double mean = middle * (1 + e * (1 + 0.3201 * e) / (2 + 1.1402 * e)), lambda = mean / e;
    const auto gaussian = [&](double t) {
      return 0.5 * std::log(lambda / (2 * pi * t * t * t)) -
             lambda * (t - mean) * (t - mean) / (2 * mean * mean * t);
    };
    EXPECT_NEAR(in("inverse-gaussian"), sum_of(gaussian), 1e-8);
    EXPECT_NEAR(log_moments(gaussian).first, std::log(middle), 0.08);
    EXPECT_NEAR(log_moments(gaussian).second, sd, (shape < 0.8 ? 0.16 : 0.03) * sd);
  }
}

// There and back.
TEST_F(FamilyStudyTest, FromOtherFamilies) {
  for (const char* family : {"lognormal", "loglogistic", "gamma", "inverse-gaussian"}) {
    const Source source = study_with_family(study(of_weibull), family);
    EXPECT_NEAR(value(study_with_family(source, "weibull")), value(study(of_weibull)), 1e-8)
        << family;
  }
  const Source listed = study(
      "[likelihood.life]\nfamily = [\"weibull\", \"lognormal\"]\nscale = \"eta\"\nshape = "
      "\"beta\"\n");
  EXPECT_EQ(value(study_with_family(listed, "weibull")), value(study(of_weibull)));
  EXPECT_EQ(value(study_with_family(listed, "gamma")),
            value(study_with_family(study(of_weibull), "gamma")));
  // The first of a list has the parameters.
  const Source gamma_first = study(
      "[likelihood.life]\nfamily = [\"gamma\", \"weibull\"]\nscale = \"eta\"\nshape = \"beta\"\n");
  const Source gamma =
      study("[likelihood.life]\nfamily = \"gamma\"\nscale = \"eta\"\nshape = \"beta\"\n");
  EXPECT_EQ(written_family(gamma_first), "gamma");
  EXPECT_EQ(value(study_with_family(gamma_first, "gamma")), value(gamma));
  EXPECT_EQ(value(study_with_family(gamma_first, "weibull")),
            value(study_with_family(gamma, "weibull")));
  EXPECT_THAT(message_of<InputError>([&] { value(listed); }),
              HasSubstr("study.toml --families weibull,lognormal"));
}

TEST_F(FamilyStudyTest, Refusals) {
  const auto refusal = [&](const std::string& likelihood, const char* family) {
    return message_of<InputError>([&] { study_with_family(study(likelihood), family); });
  };
  EXPECT_THAT(refusal(of_weibull, "normal"),
              HasSubstr("'normal' cannot be ranked; possible are weibull, lognormal"));
  EXPECT_THAT(refusal("[likelihood]\nlife = { family = \"weibull\", scale = \"eta\", shape = "
                      "\"beta\" }\n",
                      "lognormal"),
              HasSubstr("must be a table [likelihood.life] with a line for each key"));
  EXPECT_THAT(
      refusal("[likelihood.life]\nfamily = \"normal\"\nmean = \"eta\"\nsd = \"eta\"\n", "weibull"),
      HasSubstr("is not one of the families that can be ranked"));
  for (const char* word : {"best", "auto", "all"})
    EXPECT_THAT(refusal(fmt::format("[likelihood.life]\nfamily = \"{}\"\nscale = \"eta\"\nshape = "
                                    "\"beta\"\n",
                                    word),
                        "weibull"),
                HasSubstr("does not say which family the parameters belong to"));
  EXPECT_THAT(refusal("[likelihood.life]\nfamily = \"weibull\"\nscale = \"\"\"\neta\"\"\"\nshape = "
                      "\"beta\"\n",
                      "gamma"),
              HasSubstr("likelihood.life.scale: goes over several lines"));
  const Source preset =
      source_of(write("sn.toml", "model = \"sn\"\n[likelihood]\nfamily = \"weibull\"\n"));
  EXPECT_THAT(message_of<InputError>([&] { study_with_family(preset, "gamma"); }),
              HasSubstr("--families ranks distributions of lives under model \"formula\""));
}

TEST_F(FamilyStudyTest, FamiliesBesideTheOneAreRefused) {
  const auto refusal = [&](const std::string& sections) {
    return message_of<InputError>(
        [&] { study_with_family(study(of_weibull + sections), "gamma"); });
  };
  EXPECT_THAT(refusal("[failure_modes]\ncolumn = \"mode\"\n[failure_modes.bearing]\nfamily = "
                      "\"weibull\"\nscale = \"eta\"\nshape = \"beta\"\n"),
              HasSubstr("[failure_modes.bearing]"));
  EXPECT_THAT(refusal("[subpopulations]\nnames = [\"early\", \"late\"]\nshare = { early = 0.1 }\n"
                      "[subpopulations.early]\nfamily = \"weibull\"\nscale = \"eta\"\nshape = 1\n"),
              HasSubstr("[subpopulations.early]"));
  EXPECT_NO_THROW(study_with_family(
      study(of_weibull + "[failure_modes]\ncolumn = \"mode\"\nrunout = \"none\"\n"), "gamma"));
}

TEST_F(FamilyStudyTest, LinesKeepTheirNumbers) {
  const Source source = study(of_weibull);
  const auto line_of_prior = [](const Source& of) {
    const std::string& text = of.study.text;
    return std::count(text.begin(), text.begin() + static_cast<long>(text.find("[prior]")), '\n');
  };
  for (const char* family : {"lognormal", "gamma", "inverse-gaussian", "birnbaum-saunders"})
    EXPECT_EQ(line_of_prior(study_with_family(source, family)), line_of_prior(source)) << family;
}

TEST_F(FamilyStudyTest, SaysWhatThePriorsAre) {
  const std::vector<std::string> all = {"weibull", "lognormal", "gamma", "generalized-gamma"};
  EXPECT_EQ(family_priors("weibull", all),
            "Parameters are those of weibull lives, the family of the study; lognormal lives have "
            "the same mean and sd of log life; gamma lives roughly the same mean and sd of log "
            "life; a further parameter makes the prior of lives wider: generalized-gamma with "
            "family_lambda ~ normal(0.5, 1), 0 is lognormal.");
  // From gamma lives no family has exactly these moments.
  EXPECT_THAT(family_priors("gamma", all), HasSubstr("weibull, lognormal lives roughly"));
}

}  // namespace
}  // namespace wearwell::formula_model
