#include "wearwell/workbench/prior_handles.h"

#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "wearwell/base/error.h"
#include "wearwell/workbench/study_form.h"

namespace wearwell::workbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string study_of(const std::string& prior) {
  return "# as written\nmodel = \"formula\"\n[prior]\nk = { " + prior + " }  # of k\n";
}

std::map<std::string, double> handles_of(const std::string& text, const ParameterSpec& spec) {
  const TomlReader study = TomlReader::parse({"study.toml", text});
  std::map<std::string, double> found;
  for (const PriorHandle& each :
       prior_handles(study, read_prior(study.required_table("prior"), spec)))
    found[std::string(each.name)] = each.at;
  return found;
}

const ParameterSpec time{"k", "s"}, number{"k", "1"};

struct MovedCase {
  std::string prior;
  ParameterSpec spec;
  bool one_handle = false;
};

// The other handle stays: a location keeps the family's other parameters, so only "spread" keeps the median.
TEST(PriorHandles, AHandleStandsWhereItWasPut) {
  const MovedCase cases[] = {
      {"distribution = \"normal\", mean = \"500 h\", sd = \"20 h\"", time},
      {"distribution = \"normal\", mean = 0, sd = 1", number},
      {"distribution = \"normal\", mean = 3, sd = 1, lower = 0", number},
      {"distribution = \"lognormal\", median = \"500 h\", log_sd = 0.3", time},
      {"distribution = \"lognormal\", mean = \"500 h\", sd = \"100 h\"", time},
      {"distribution = \"weibull\", scale = \"500 h\", shape = 2", time},
      {"distribution = \"gamma\", shape = 3, scale = \"1e-9 h\"", time},
      {"distribution = \"inverse-gamma\", shape = 3, scale = \"500 h\"", time},
      {"distribution = \"student-t\", df = 4, location = 2, scale = 0.5", number},
      {"distribution = \"beta\", alpha = 2, beta = 5", number},
      {"distribution = \"half-normal\", scale = \"3 h\"", time, true},
      {"distribution = \"half-cauchy\", scale = 3", number, true},
      {"distribution = \"exponential\", mean = \"3 h\"", time, true},
  };
  for (const MovedCase& each : cases) {
    const std::string text = study_of(each.prior);
    const auto before = handles_of(text, each.spec);
    ASSERT_EQ(before.size(), each.one_handle ? 1u : 2u) << each.prior;
    const double median = before.at("location");
    const double width = each.one_handle ? median : before.at("spread") - median;
    const double wanted = median + 0.2 * width;
    const MovedPrior moved = moved_prior(text, each.spec, "location", wanted);
    EXPECT_NEAR(handles_of(moved.text, each.spec).at("location"), wanted, 0.02 * width)
        << moved.text;
    EXPECT_THAT(moved.text, HasSubstr("# as written"));
    EXPECT_THAT(moved.text, HasSubstr("}  # of k"));
    if (each.one_handle) continue;
    for (const double factor : {0.6, 1.3}) {
      const double far = median + factor * width;
      const MovedPrior spread = moved_prior(text, each.spec, "spread", far);
      const auto after = handles_of(spread.text, each.spec);
      EXPECT_NEAR(after.at("spread"), far, 0.02 * width) << spread.text;
      EXPECT_NEAR(after.at("location"), median, 0.02 * width) << spread.text;
    }
  }
}

// Exact values: only the keys that change are written, in the units that stand there.
TEST(PriorHandles, ValuesKeepTheirUnitsAndOthersStay) {
  const std::string text =
      study_of("distribution = \"lognormal\", median = \"100e6 cycles\", log_sd = 1");
  const ParameterSpec spec{"k", "cycle"};
  const MovedPrior located = moved_prior(text, spec, "location", 123456789);
  EXPECT_EQ(value_of(located.text, "prior.k.median"), "1.23e8 cycles");
  EXPECT_THAT(located.paths, ElementsAre("prior.k.median"));
  const MovedPrior spread = moved_prior(text, spec, "spread", 1e8 * std::exp(0.5 * 1.6448536));
  EXPECT_THAT(spread.paths, ElementsAre("prior.k.log_sd"));
  EXPECT_EQ(value_of(spread.text, "prior.k.log_sd"), "0.5");
  EXPECT_EQ(value_of(spread.text, "prior.k.median"), "100e6 cycles");
  // With a unit beside the number, and one written without a gap.
  const std::string joined = study_of("distribution = \"normal\", mean = \"3h\", sd = \"600s\"");
  const MovedPrior minutes = moved_prior(joined, time, "location", 4);
  EXPECT_EQ(value_of(minutes.text, "prior.k.mean"), "4h");
  EXPECT_EQ(value_of(minutes.text, "prior.k.sd"), "600s");
}

TEST(PriorHandles, BoundsOfAUniformPrior) {
  const std::string text =
      study_of("distribution = \"uniform\", lower = \"10 h\", upper = \"30 h\"");
  const auto handles = handles_of(text, time);
  EXPECT_NEAR(handles.at("lower"), 10, 1e-9);
  EXPECT_NEAR(handles.at("upper"), 30, 1e-9);
  const MovedPrior moved = moved_prior(text, time, "upper", 41.26);
  EXPECT_EQ(value_of(moved.text, "prior.k.upper"), "41.3 h");
  EXPECT_EQ(value_of(moved.text, "prior.k.lower"), "10 h");
  EXPECT_THROW(moved_prior(text, time, "upper", 9), InputError);
  EXPECT_THROW(moved_prior(text, time, "location", 20), InputError);
}

TEST(PriorHandles, ImpossiblePlacesAreRefused) {
  // A truncated normal prior has its 95 % quantile at most 4.32 medians from its bound.
  const std::string normal = study_of("distribution = \"normal\", mean = 3, sd = 1, lower = 0");
  EXPECT_THROW(moved_prior(normal, number, "spread", 60), InputError);
  EXPECT_THROW(moved_prior(normal, number, "spread", 1), InputError);
  EXPECT_THROW(moved_prior(normal, number, "location", -1), InputError);
  const std::string beta = study_of("distribution = \"beta\", alpha = 2, beta = 5");
  EXPECT_THROW(moved_prior(beta, number, "spread", 1.5), InputError);
  EXPECT_THROW(moved_prior(beta, number, "width", 0.5), InputError);
  EXPECT_THROW(moved_prior("model = 1\n", number, "location", 1), InputError);
  EXPECT_THAT(handles_of(study_of("distribution = \"flat\""), number), IsEmpty());
}

}  // namespace
}  // namespace wearwell::workbench
