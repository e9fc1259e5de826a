#include "wearwell/study/terminal.h"

#include <gmock/gmock.h>

#include <cmath>

#include <algorithm>
#include <sstream>

#include "study/sample.h"
#include "wearwell/study/posterior_tables.h"

namespace wearwell {
namespace {

using testing::AllOf;
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
  for (const char* part : {"Pin joint\n", "joint.csv: 2 rows; 1 hidden row left out (3)",
                           "k [mm^3/(N m)]", "7.500\u00a0×\u00a010^-4", "7.510\u00a0×\u00a010^-4",
                           "91.5", "88.50 to 94.50", "80.50 to 101.5", "-> reparametrize",
                           "Mode of the posterior", "on its upper bound", "AIC 45.00", "elpd -7.50",
                           "B10 22\u202f000", "21\u202f500 to never", "1 % risk", "NOT TRUSTED"}) {
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
    const std::string text = terminal_summary(result, {.histograms = histograms, .rows = true});
    for (const char* command : {"\x1b", "\x07", "\u009b", "\u202e"})
      EXPECT_THAT(text, Not(HasSubstr(command)));
    EXPECT_THAT(text, EndsWith("do not use these\n  numbers.\n"));
  }
  const std::string head = terminal_summary(result, {}).substr(0, 400);
  EXPECT_THAT(head, Not(HasSubstr("\nTrusted")));
}

TEST(TerminalSummary, LongTablesAreCut) {
  PosteriorSummary result = sample_result();
  result.pointwise->rows.assign(5000, result.pointwise->rows[0]);
  const std::string text = terminal_summary(result, {.rows = true});
  EXPECT_THAT(text, HasSubstr("  ... and 4800 more in pointwise.csv\n"));
  EXPECT_LT(text.size(), 40'000u);
}

// That the limit may be passed is said before when to inspect again.
TEST(TerminalSummary, SaysFirstThatTheLimitIsPassed) {
  PosteriorSummary result = sample_result();
  result.life->drawn.passed = 0.9;
  const std::string text = terminal_summary(result, {});
  EXPECT_THAT(text, HasSubstr("already passed with a probability of 90 %, which exceeds the"));
  EXPECT_LT(text.find("already passed"), text.find("inspect again"));
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
  result.checks = {{"convergence", Verdict::pass, "R-hat 1.002", ""}};
  result.trusted = true;
  const std::string text = terminal_summary(result, {});
  for (const char* part : {"Predictions", "Life", "Row by row", "Wear coefficient"})
    EXPECT_THAT(text, Not(HasSubstr(part)));
  EXPECT_THAT(text, EndsWith("\nTrusted: no check failed.\n"));
}

// What was asked stands before how it was found, and tables of rows only where they are asked for.
TEST(TerminalSummary, AnswersFirstAndRowsOnDemand) {
  PosteriorSummary result = sample_result();
  result.coverage = CoverageTable{"cycles",
                                  {{1, "A", "failure", 100, {}, 0.5, 50, 200, 60},
                                   {2, "B", "failure", 10, {}, 0.01, 50, 200, 60}},
                                  2};
  const std::string text = terminal_summary(result, {});
  EXPECT_LT(text.find("\nNOT TRUSTED: divergences failed"), text.find("\nAnswers\n"));
  for (const char* later :
       {"\nLife\n", "\nPredictions\n", "\nParameters\n", "\nDraws", "\nChecks\n"})
    EXPECT_LT(text.find("\nAnswers\n"), text.find(later)) << later;
  EXPECT_THAT(
      text,
      HasSubstr("1 of 2 failures lie inside their 90 % intervals; outside: row 2 B (shorter)"));
  EXPECT_THAT(text, HasSubstr("with --rows here, or in tables/pointwise.csv, tables/"));
  const char* of_rows[] = {"Wear coefficient of each measurement", "Row by row (mean, sd)",
                           "Tests and their predicted lives"};
  for (const char* title : of_rows) EXPECT_THAT(text, Not(HasSubstr(title)));
  const std::string all = terminal_summary(result, {.rows = true});
  for (const char* title : of_rows) EXPECT_THAT(all, HasSubstr(title));
}

TEST(TerminalSummary, OneObservationHasNoStandardError) {
  PosteriorSummary result = sample_result();
  EXPECT_THAT(terminal_summary(result, {}), HasSubstr("(standard error 1.50, data in mm^3)"));
  result.loo->loo.terms = {{-1.5, -1.25, 0.25}};
  const std::string text = terminal_summary(result, {});
  EXPECT_THAT(text, HasSubstr("elpd -1.50 (one observation, so no standard error, data in mm^3)"));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
}

TEST(TerminalSummary, AWarningIsAWordOfTheVerdict) {
  PosteriorSummary result = sample_result();
  result.checks.pop_back();
  result.trusted = true;
  EXPECT_THAT(terminal_summary(result, {}),
              EndsWith("\nTrusted, with a warning: no check failed; see energy.\n"));
}

// Long names of stresses, many parameters: no line is wider than a terminal.
TEST(TerminalSummary, FitsAHundredColumns) {
  PosteriorSummary result = sample_result();
  const std::string where = "for 90 % to outlast 1e+06 cycles, mean 342.222 MPa, stress ratio 0.1";
  for (const char* of : {"type of a very long name indeed", "other"}) {
    result.quantities.push_back({"allowed alternating stress",
                                 of,
                                 where,
                                 "MPa",
                                 false,
                                 {1, 2, 3, 0, 0, 0, 2.5, 1.5},
                                 {},
                                 0.9,
                                 0.05,
                                 true});
    result.quantities.push_back({"life",
                                 std::string("new ") + of,
                                 where,
                                 "cycles",
                                 true,
                                 {1e5, 2e5, 3e5, 1e4, 2e4, 3e4},
                                 {}});
  }
  for (int i = 0; i < 6; ++i) {
    result.parameters.push_back(result.parameters[0]);
    result.parameters.back().prior_is_default = true;
  }
  result.stages[0].parameters = result.parameters;
  for (Chain& chain : result.posterior_draws) chain.values.conservativeResize(Eigen::NoChange, 8);
  for (int i = 0; i < 20; ++i) result.equation += " + one more term";
  for (Check& check : result.checks) {
    for (int i = 0; i < 20; ++i) check.detail += " and more words", check.advice += " and do more";
  }
  std::istringstream text(terminal_summary(result, {.rows = true}));
  for (std::string line; std::getline(text, line);) {
    const auto characters = std::count_if(line.begin(), line.end(), [](char c) {
      return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    });
    EXPECT_LE(characters, 100) << line;
  }
}

// The number to design with is the lower bound, not what the next one has in the mean.
TEST(TerminalSummary, TheDesignNumberIsTheLowerBound) {
  PosteriorSummary result = sample_result();
  result.life.reset();
  result.quantities = {{"B10 life",
                        "shaft",
                        "at 400 MPa",
                        "cycles",
                        false,
                        {282500, 381200, 480800, 0, 0, 0, 368800, 304400},
                        {},
                        0.9,
                        0.05,
                        true}};
  const std::string text = terminal_summary(result, {});
  EXPECT_THAT(text, HasSubstr("Answers\n  The B10 life of the shaft at 400 MPa is at least "
                              "304\u202f000\u00a0cycles (90\u00a0% confidence).\n"));
  EXPECT_THAT(text, HasSubstr("at least, 90 %"));
  EXPECT_THAT(text, HasSubstr("confidence (Bayesian: credible)"));
}

// Numbers that are summed over few points of the posterior show no more digits than are known, and how far they are off.
TEST(TerminalSummary, SaysHowFarLivesAreOff) {
  PosteriorSummary result = sample_result();
  QuantityQuantiles life{1234.4, 2345.6, 3456.7, 1111.2, 1222.3, 2345.6};
  result.quantities = {{"life", "new machine", "to wear = 100 um", "h", true, life, {}}};
  const auto shown = [&](double error) {
    result.quantities.front().drawn.numerical_error = error;
    return terminal_summary(result, TerminalStyle());
  };
  EXPECT_THAT(shown(2e-5), AllOf(HasSubstr("2\u202f346"), Not(HasSubstr("Numerical error"))));
  const std::string rough = shown(0.0031);
  EXPECT_THAT(rough, HasSubstr("Numerical error of these numbers: up to 0.31 %"));
  EXPECT_THAT(rough, AllOf(HasSubstr("2\u202f350"), Not(HasSubstr("2\u202f346"))));
  // So do the table of the report and of its file.
  const present::Table table = quantity_table(result.quantities);
  EXPECT_EQ(table.columns.back().name, "Numerical error");
  EXPECT_EQ(present::description(table.rows[0][5], table.columns[5]), "2\u202f350");
}

TEST(TerminalSummary, DefaultPriorsAreNamed) {
  PosteriorSummary result = sample_result();
  EXPECT_THAT(terminal_summary(result, {}), Not(HasSubstr("default priors")));
  result.parameters[1].prior_is_default = true;
  EXPECT_THAT(terminal_summary(result, {}),
              HasSubstr("default priors: sigma; state what you know in [prior]"));
}

// The item that fails first is the answer, not the last of the table; those beyond the limit are named.
TEST(TerminalSummary, NamesTheItemThatFailsFirst) {
  PosteriorSummary result = sample_result();
  result.life.reset();
  const auto left = [](const char* of, double q50) {
    QuantitySummary each{"remaining useful life",
                         of,
                         "to wear = 100 um, force = 20 N from 30 km on",
                         "km",
                         true,
                         {0.9 * q50, q50, 1.1 * q50, 0.8 * q50, 0.9 * q50, q50},
                         {}};
    return each;
  };
  result.quantities = {left("machine 1", 60), left("machine 2", 39), left("machine 3", 0),
                       left("machine 4", 50)};
  const std::string text = terminal_summary(result, {});
  EXPECT_THAT(text,
              HasSubstr("Answers\n  Machine 3 has already passed wear = 100 um.\n"
                        "  Machine 2 reaches wear = 100 um first, in 39.0\u00a0km (median) at "
                        "force = 20 N; 35.1 to 42.9\u00a0km"));
  EXPECT_THAT(text, HasSubstr("counted from 30 km on"));
  EXPECT_THAT(text, HasSubstr("remaining useful life [km]"));
  EXPECT_THAT(text, Not(HasSubstr("a machine")));
}

// The mean of a lognormal with a log standard deviation of 3 is 90 medians: no headline.
TEST(TerminalSummary, OfASkewedParameterTheMedian) {
  const auto lognormal = [](double median, double s) {
    const auto at = [&](double z) { return median * std::exp(s * z); };
    return ExactSummary{median * std::exp(0.5 * s * s), 1, at(-1.6449), median, at(1.6449)};
  };
  PosteriorSummary result = sample_result();
  result.life.reset();
  result.quantities.clear();
  result.predictions.clear();
  ParameterSummary& scale = result.parameters.front();
  scale.name = "eta";
  scale.unit = "h";
  scale.exact = lognormal(7.5e9, 3);
  EXPECT_THAT(terminal_summary(result, {}),
              HasSubstr("eta is 7.50\u00a0×\u00a010^9\u00a0h (median); "
                        "5.39\u00a0×\u00a010^7 to 1.04\u00a0×\u00a010^12\u00a0h (90\u00a0%)"));
  scale.exact = lognormal(2.0, 0.5);
  EXPECT_THAT(terminal_summary(result, {}), HasSubstr("eta is 2.00\u00a0h (median)"));
  // Within 10 % either will do: the mean.
  scale.exact = lognormal(2.0, 0.3);
  EXPECT_THAT(terminal_summary(result, {}), HasSubstr("eta is 2.09\u00a0h (mean); 1.22 to 3.28"));
  // About zero 10 % of the median is nothing; the width of the interval counts.
  scale.exact = ExactSummary{0.01, 1, -1.6449, 0.005, 1.6449};
  EXPECT_THAT(terminal_summary(result, {}),
              HasSubstr("eta is 0.0100\u00a0h (mean); -1.64 to 1.64"));
}

// Of a logarithm the number itself.
TEST(TerminalSummary, GivesTheNumberNotItsLogarithm) {
  PosteriorSummary result = sample_result();
  ParameterSummary& limit = result.parameters.front();
  limit.name = "log10_limit";
  limit.unit = "log10(MPa)";
  limit.meaning = "logarithm of the median fatigue limit";
  limit.exact = ExactSummary{2.48, 0.01, 2.46, 2.48, 2.5};
  EXPECT_THAT(terminal_summary(result, {}),
              HasSubstr("The median fatigue limit is 302\u00a0MPa; 288 to 316\u00a0MPa"));
}

}  // namespace
}  // namespace wearwell
