// Log-location-scale families by one name: the family that `standard` names, in every digit.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/prob/log_location_scale.h"
#include "wearwell/study/family_study.h"

namespace wearwell::formula_model {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string table_of_lives =
    "h,status,lower,upper\n31,failed,,\n58,failed,,\n9,left,,9\n80,runout,,\n40,interval,25,40\n";
const std::string columns_of_lives =
    "model = \"formula\"\n[data]\nfile = \"d.csv\"\n[data.columns]\nlife = { column = \"h\", unit "
    "= \"h\" }\nlower = { column = \"lower\", unit = \"h\" }\nupper = { column = \"upper\", unit = "
    "\"h\" }\nstatus = \"status\"\n";
const std::string priors_of_lives =
    "[prior]\neta = { distribution = \"lognormal\", median = \"900 h\", log_sd = 1 }\ns = { "
    "distribution = \"flat\" }\n";

class LogLocationScaleTest : public ScratchTest {
 protected:
  Source source(const std::string& likelihood) {
    write("d.csv", table_of_lives);
    return source_of(write(
        "study.toml", columns_of_lives + "[likelihood.life]\n" + likelihood + priors_of_lives));
  }
  std::shared_ptr<const FormulaModel> model(const Source& source) {
    return read_formula_model(TomlReader::parse(source.study), source);
  }
  double value(const Source& source, const std::vector<double>& x,
               std::vector<double>* gradient = nullptr) {
    const auto own = model(source);
    const auto all =
        formula_likelihood(std::make_shared<const FormulaRows>(own, own->data.table.rows));
    if (!gradient) return all->value(x);
    gradient->assign(x.size(), 0);
    return all->value_and_gradient(x, *gradient);
  }
  std::string refusal(const std::string& likelihood) {
    return message_of<InputError>([&] { model(source(likelihood)); });
  }
};

std::string by_name(std::string_view standard, const std::string& more = "") {
  return fmt::format(
      "family = \"log-location-scale\"\nstandard = \"{}\"\nscale = \"eta\"\nsigma = \"s\"\n{}",
      standard, more);
}

std::string by_family(const LogLocationScale& each, const std::string& more = "") {
  return fmt::format("family = \"{}\"\n{} = \"eta\"\n{} = \"{}\"\n{}", each.family, each.scale,
                     each.spread, each.inverse ? "1/s" : "s", more);
}

TEST_F(LogLocationScaleTest, IsTheFamilyInEveryDigit) {
  const std::vector<double> x = {3600 * 47.3, 0.61};
  for (const LogLocationScale& each : log_location_scale_families) {
    for (const std::string more : {"", "threshold = \"2 [h]\"\n"}) {
      std::vector<double> of_name, of_family;
      EXPECT_EQ(value(source(by_name(each.standard, more)), x, &of_name),
                value(source(by_family(each, more)), x, &of_family))
          << each.standard;
      EXPECT_EQ(of_name, of_family) << each.standard;
    }
    EXPECT_EQ(model(source(by_name(each.standard)))->measured.front().form->name, each.family);
  }
}

// A flat prior of sigma begins at 0, although sigma stands in 1/sigma.
TEST_F(LogLocationScaleTest, SigmaIsPositive) {
  for (const LogLocationScale& each : log_location_scale_families)
    EXPECT_EQ(model(source(by_name(each.standard)))->parameters[1].prior.lower, 0) << each.standard;
}

// Each ranks as its family does; as the written one its own lines stay.
TEST_F(LogLocationScaleTest, FamiliesAreExchanged) {
  const std::vector<double> x = {3600 * 47.3, 0.61};
  for (const LogLocationScale& each : log_location_scale_families) {
    const Source named = source(by_name(each.standard));
    EXPECT_EQ(written_family(named), each.family);
    EXPECT_EQ(value(study_with_family(named, each.family), x), value(named, x)) << each.standard;
    const Source direct = source(by_family(each));
    for (const LogLocationScale& other : log_location_scale_families) {
      if (other.family == each.family) continue;
      const double expected = value(study_with_family(direct, other.family), x);
      EXPECT_NEAR(value(study_with_family(named, other.family), x), expected,
                  1e-9 * std::abs(expected))
          << each.standard << " as " << other.standard;
    }
    // There and back: the moments of log life are kept.
    const std::string_view away = each.family == "weibull" ? "frechet" : "weibull";
    const Source back = study_with_family(study_with_family(direct, away), each.family);
    EXPECT_NEAR(value(back, x), value(direct, x), 1e-8 * std::abs(value(direct, x))) << each.family;
  }
}

TEST_F(LogLocationScaleTest, RefusesHalfAName) {
  EXPECT_THAT(refusal("family = \"log-location-scale\"\nscale = \"eta\"\nsigma = \"s\"\n"),
              AllOf(HasSubstr("standard"), HasSubstr("smallest extreme value, normal, logistic")));
  EXPECT_THAT(refusal(by_name("cauchy")), HasSubstr("standard"));
  EXPECT_THAT(refusal("family = \"log-location-scale\"\nstandard = \"normal\"\nscale = \"eta\"\n"
                      "log_sd = \"s\"\n"),
              HasSubstr("log-location-scale needs scale and sigma"));
}

}  // namespace
}  // namespace wearwell::formula_model
