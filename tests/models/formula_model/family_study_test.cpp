// A study with another family (study/family_study.h): the same mean and standard deviation of log life.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/trigamma.hpp>
#include <cmath>

#include "support/messages.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/study/family_study.h"

namespace wearwell::formula_model {
namespace {

using testing::HasSubstr;

constexpr double scale = 80, shape = 1.7, euler = 0.57721566490153286;
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
  static double value(const Source& source) {
    const auto model = read_formula_model(TomlReader::parse(source.study), source);
    std::vector<double> x;
    for (const auto& each : model->parameters)
      x.push_back(each.name == "eta" ? scale * 3600 : each.name == "beta" ? shape : 1);
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
const double middle = scale * std::exp(-euler / shape), sd = pi / std::sqrt(6.0) / shape;

double lognormal(double t) {
  const double z = std::log(t / middle) / sd;
  return -0.5 * z * z - std::log(t * sd * std::sqrt(2 * pi));
}

TEST_F(FamilyStudyTest, KeepsTheMomentsOfLogLife) {
  const Source source = study(of_weibull);
  EXPECT_NEAR(value(source), sum_of([](double t) { return weibull(t, scale, shape); }), 1e-9);
  EXPECT_EQ(value(study_with_family(source, "weibull")), value(source));
  EXPECT_NEAR(value(study_with_family(source, "lognormal")), sum_of(lognormal), 1e-8);
  EXPECT_NEAR(value(study_with_family(source, "loglogistic")), sum_of([](double t) {
                const double b = pi / std::sqrt(3.0) / sd, u = std::pow(t / middle, b);
                return std::log(b / t) + std::log(u) - 2 * std::log1p(u);
              }),
              1e-8);
  // exponent = 1 is the Weibull distribution.
  EXPECT_NEAR(value(study_with_family(source, "exponentiated-weibull")), value(source), 1e-8);
  // Other families agree with it in the mean of log life, and in its standard deviation within 5 %.
  const double k = (1 + std::sqrt(1 + 2 * sd * sd)) / (2 * sd * sd);
  EXPECT_NEAR(std::sqrt(boost::math::trigamma(k)), sd, 0.05 * sd);
  const double theta = middle * std::exp(-boost::math::digamma(k));
  EXPECT_NEAR(value(study_with_family(source, "gamma")), sum_of([&](double t) {
                return (k - 1) * std::log(t) - t / theta - std::lgamma(k) - k * std::log(theta);
              }),
              1e-8);
  for (const std::string_view each : exchangeable_families())
    EXPECT_TRUE(std::isfinite(value(study_with_family(source, each)))) << each;
}

// There and back.
TEST_F(FamilyStudyTest, FromOtherFamilies) {
  for (const char* family : {"lognormal", "loglogistic"}) {
    const Source source = study_with_family(study(of_weibull), family);
    EXPECT_NEAR(value(study_with_family(source, "weibull")), value(study(of_weibull)), 1e-8)
        << family;
  }
  const Source listed = study(
      "[likelihood.life]\nfamily = [\"weibull\", \"lognormal\"]\nscale = \"eta\"\nshape = "
      "\"beta\"\n");
  EXPECT_EQ(value(study_with_family(listed, "weibull")), value(study(of_weibull)));
  EXPECT_NEAR(value(study_with_family(listed, "lognormal")), sum_of(lognormal), 1e-8);
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
}

}  // namespace
}  // namespace wearwell::formula_model
