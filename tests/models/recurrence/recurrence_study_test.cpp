#include <gmock/gmock.h>

#include <boost/math/distributions/gamma.hpp>
#include <cmath>

#include "support/messages.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/registry.h"
#include "wearwell/study/model.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell::recurrence {
namespace {

using testing::HasSubstr;

class RecurrenceStudyTest : public ScratchTest {
 protected:
  std::unique_ptr<const Study> read(const std::string& process, const std::string& more) {
    write("d.csv",
          "unit,age "
          "[h],event\na,4.3,failure\na,10.2,failure\na,23.5,failure\na,26.4,failure\na,74,"
          "failure\na,92.1,"
          "failure\na,197.2,failure\na,200,end\n");
    const std::string head =
        "model = \"repairable\"\nprocess = \"" + process + "\"\n[data]\nfile = \"d.csv\"\n";
    write("study.toml",
          head + "[data.columns]\nunit = \"unit\"\nage = \"age\"\nevent = \"event\"\n" + more);
    return read_study(source_of(folder() / "study.toml"), all_models());
  }
  Result run(const std::string& process, const std::string& more) {
    return read(process, more)->run({.sampler = {}, .report = false}, {});
  }
  std::string refusal(const std::string& process, const std::string& more) {
    return message_of<InputError>([&] { read(process, more); });
  }
};

// Flat priors of the logarithms and one system that was observed for a fixed time: beta and M_T are independent, gamma
// distributed with the shape n, the scale 1/sum ln(T/t) and 1.
TEST_F(RecurrenceStudyTest, QuadratureHasTheClosedForm) {
  const Result result =
      run("power_law",
          "[prior]\nbeta = { distribution = \"jeffreys\" }\nM_T = { distribution = \"jeffreys\" }\n"
          "[predict]\nage = [\"200 h\"]\nnext = [\"100 h\"]\n");
  const double ages[] = {4.3, 10.2, 23.5, 26.4, 74, 92.1, 197.2};
  double logs = 0;
  for (const double age : ages) logs += std::log(200 / age);
  const boost::math::gamma_distribution<> beta(7, 1 / logs), number(7, 1);
  const auto& parameters = result.posterior->parameters;
  ASSERT_TRUE(parameters[0].exact && parameters[1].exact);
  EXPECT_NEAR(parameters[0].exact->mean, 7 / logs, 1e-4 * 7 / logs);
  EXPECT_NEAR(parameters[1].exact->mean, 7, 1e-3);
  for (const auto& [of, with] :
       {std::pair{*parameters[0].exact, beta}, std::pair{*parameters[1].exact, number}}) {
    EXPECT_NEAR(of.q05 / quantile(with, 0.05), 1, 2e-3);
    EXPECT_NEAR(of.q95 / quantile(with, 0.95), 1, 2e-3);
  }
  const auto& json = result.body["repairable"];
  EXPECT_NEAR(json["probability_beta_above_1"].get<double>(), cdf(complement(beta, 1)), 1e-3);
  // E[M_T (1.5^beta - 1)] = 7 ((1 - ln 1.5/sum)^-7 - 1).
  EXPECT_NEAR(json["forecast"][0]["expected"].get<double>(),
              7 * (std::pow(1 - std::log(1.5) / logs, -7) - 1), 0.02);
}

// With the prior 1/MTBF the intensity of a phase is gamma distributed, with the number of its failures and its time.
TEST_F(RecurrenceStudyTest, PhasesHaveTheClosedForm) {
  const Result result = run("phases",
                            "[conditions]\nphase_ends = [\"50 h\"]\n[prior]\nMTBF_1 = { "
                            "distribution = \"jeffreys\", unit = "
                            "\"h\" }\nMTBF_2 = { distribution = \"jeffreys\", unit = \"h\" }\n");
  const boost::math::gamma_distribution<> first(4, 1 / 50.0), second(3, 1 / 150.0);
  const auto& parameters = result.posterior->parameters;
  ASSERT_EQ(parameters.size(), 2U);
  EXPECT_NEAR(parameters[0].exact->q95 * quantile(first, 0.05), 1, 2e-3);
  EXPECT_NEAR(parameters[0].exact->q05 * quantile(first, 0.95), 1, 2e-3);
  EXPECT_NEAR(parameters[1].exact->q50 * quantile(second, 0.5), 1, 2e-3);
  EXPECT_FALSE(result.body["repairable"].contains("probability_beta_above_1"));
}

// Both processes have the same data and comparable factors.
TEST_F(RecurrenceStudyTest, ProcessesAreComparable) {
  const Result power = run("power_law", ""),
               renewal = run("renewal", "[predict]\nnext = [\"100 h\"]\n");
  EXPECT_EQ(power.header.data.fingerprint, renewal.header.data.fingerprint);
  ASSERT_TRUE(power.posterior->loo && renewal.posterior->loo);
  EXPECT_EQ(power.posterior->loo->loo.terms.size(), renewal.posterior->loo->loo.terms.size());
  EXPECT_EQ(power.posterior->density_unit, "h");
  EXPECT_EQ(renewal.body["repairable"]["forecast"].size(), 2U);
}

TEST_F(RecurrenceStudyTest, Refusals) {
  EXPECT_THAT(refusal("repair", ""), HasSubstr("power_law"));
  EXPECT_THAT(refusal("renewal", "[predict]\nage = [\"100 h\"]\n"), HasSubstr("does not matter"));
  EXPECT_THAT(refusal("renewal", "[conditions]\nreference_age = \"100 h\"\n"),
              HasSubstr("renewal process has none"));
  EXPECT_THAT(refusal("power_law", "[conditions]\nphase_ends = [\"100 h\"]\n"),
              HasSubstr("belongs to process"));
  EXPECT_THAT(refusal("phases", "[conditions]\nphase_ends = [\"100 h\", \"90 h\"]\n"),
              HasSubstr("ascending"));
  EXPECT_THAT(refusal("phases", "[conditions]\nphase_ends = [\"200 h\"]\n"),
              HasSubstr("no unit was observed beyond 200 h"));
  EXPECT_THAT(refusal("power_law", "[predict]\nnext = [\"0 h\"]\n"), HasSubstr("must be positive"));
  EXPECT_THAT(refusal("power_law", "[predict]\nnext = [\"5 km\"]\n"), HasSubstr("next"));
  EXPECT_THAT(refusal("power_law", "[update]\nstages = \"row\"\n"), HasSubstr("not possible"));
}

}  // namespace
}  // namespace wearwell::recurrence
