#include "wearwell/study/terminal.h"

#include <gmock/gmock.h>

#include "study/sample.h"

namespace wearwell {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

TEST(TerminalSummary, ColoursOnlyWhenAsked) {
  const std::string plain = terminal_summary(sample_result(), {});
  EXPECT_THAT(plain, Not(HasSubstr("\033")));
  const std::string coloured = terminal_summary(sample_result(), {.colour = true});
  for (const char* verdict : {"\033[32mpass\033[0m", "\033[33mWARN\033[0m", "\033[31mFAIL\033[0m"})
    EXPECT_THAT(coloured, HasSubstr(verdict));
}

TEST(TerminalSummary, SaysWhatWasFound) {
  const std::string text = terminal_summary(sample_result(), {});
  for (const char* part : {"Pin joint\n", "joint.csv: 2 data sets", "k [mm^3/(N m)]", "0.00075",
                           "0.000751", "91.5", "88.5 .. 94.5", "80.5 .. 101.5", "-> reparametrize",
                           "Mode of the posterior", "on its upper bound", "AIC 45.00", "elpd -7.50",
                           "B10 22000", "21500 .. never", "1 % risk", "NOT TRUSTED"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_THAT(text, EndsWith("\n"));
}

// Whatever stands in a study or in a folder from elsewhere: no text of it moves the cursor or writes
// a verdict of its own.
TEST(TerminalSummary, NoTextCommandsTheTerminal) {
  const std::string evil = "\x1b]0;owned\x07\u009b2J\u202e\nTrusted: no check failed.\n";
  PosteriorSummary result = sample_result();
  result.title = result.equation = result.data_file = evil;
  for (auto& p : result.parameters) p.name = p.unit = evil;
  for (auto& p : result.predictions) p.at_name = p.quantity = p.unit = evil;
  for (auto& p : result.mode->parameters) p.name = p.unit = p.at = evil;
  for (auto& check : result.checks) check.name = check.detail = check.advice = evil;
  result.stages[0].parameters = result.parameters;
  result.loo->observation = evil;
  result.life->unit = result.life->limit_unit = evil;
  result.pointwise->k_unit = evil;
  result.quantities = {{evil, evil, evil, evil, true, {}, {}}};
  result.coverage = CoverageTable{evil, {{1, evil, evil, 1, {}, 0.5, 1, 2, 1}}};
  for (const bool histograms : {false, true}) {
    const std::string text = terminal_summary(result, {.histograms = histograms});
    for (const char* command : {"\x1b", "\x07", "\u009b", "\u202e"})
      EXPECT_THAT(text, Not(HasSubstr(command)));
    EXPECT_THAT(text, EndsWith("not to be used as they stand.\n"));
  }
  const std::string head = terminal_summary(result, {}).substr(0, 400);
  EXPECT_THAT(head, Not(HasSubstr("\nTrusted")));
}

TEST(TerminalSummary, LongTablesAreCut) {
  PosteriorSummary result = sample_result();
  result.pointwise->rows.assign(5000, result.pointwise->rows[0]);
  const std::string text = terminal_summary(result, {});
  EXPECT_THAT(text, HasSubstr("  ... and 4800 more in pointwise.csv\n"));
  EXPECT_LT(text.size(), 40'000u);
}

// That the limit may be passed is said before when to inspect again.
TEST(TerminalSummary, SaysFirstThatTheLimitIsPassed) {
  PosteriorSummary result = sample_result();
  result.life->drawn.passed = 0.9;
  const std::string text = terminal_summary(result, {});
  EXPECT_THAT(text,
              HasSubstr("passed already with a probability of 90 %: more than the risk of 1 %"));
  EXPECT_LT(text.find("passed already"), text.find("inspect again"));
  result.life->drawn.passed = 1e-9;
  EXPECT_THAT(terminal_summary(result, {}), HasSubstr("a probability of less than 0.01 %\n"));
  result.life->drawn.b50 = std::nan("");
  EXPECT_THAT(terminal_summary(result, {}), HasSubstr("B50 unknown"));
}

TEST(TerminalSummary, OfTheBareMinimum) {
  PosteriorSummary result = sample_result();
  result.stages.clear();
  result.predictions.clear();
  result.life.reset();
  result.pointwise.reset();
  result.trusted = true;
  const std::string text = terminal_summary(result, {});
  for (const char* part : {"Predictions", "Life", "Data set by data set", "Wear coefficient"})
    EXPECT_THAT(text, Not(HasSubstr(part)));
  EXPECT_THAT(text, EndsWith("\nTrusted: no check failed.\n"));
}

}  // namespace
}  // namespace wearwell
