#include "wearwell/study/posterior_result.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>

namespace wearwell {
namespace {

using testing::HasSubstr;
using testing::Not;

// A small result of a study whose names are as bad as names can be.
PosteriorSummary result_of(Verdict verdict) {
  const std::string evil = "</script><img src=x onerror=alert(1)>";
  PosteriorSummary result;
  result.version = "0";
  result.title = evil;
  result.model = "archard-joint";
  result.equation = "V = k W";
  result.data_file = evil + ".csv";
  result.data_rows = 2;
  result.method = "nuts";
  result.chains = 1;
  result.warmup = 10;
  result.draws = 3;
  result.seed = 7;
  result.parameters = {{"k", "mm^3/(N m)", 7.5e-4, 1e-5, 1e-7, 7e-4, 7.5e-4, 8e-4, 900, 800, 1.001,
                        ExactSummary{7.6e-4, 1e-5, 7.1e-4, 7.6e-4, 8.1e-4}}};
  result.predictions = {
      {"cycles", 20585, "volume", "mm^3", {95, 90, 100, 85, 105}, {}, std::nullopt}};
  result.life = LifeSummary{
      "cycles", 100, "mm^3", 10000, 0.01, {16000, 19000, 21600, 18000, 26000, 6000}, {}};
  result.checks = {{"convergence", verdict, "R-hat at most 1.2", "Draw more."}};
  result.trusted = verdict != Verdict::fail;
  Chain chain;
  chain.values.resize(3, 1);
  chain.values << 7.4e-4, 7.5e-4, 7.6e-4;
  chain.log_density = {-1, 0, -1};
  result.posterior_draws = {chain};
  Plots plots;
  result.quantity = "worn volume";
  result.parameters[0].meaning = "wear coefficient";
  result.parameters[0].prior = "flat (no prior knowledge)";
  plots.unit = "mm^3";
  plots.at_name = "cycles";
  plots.parameters = {{{{7e-4, 7.5e-4, 8e-4}, {{1e4, 1e4}}}, {}, {{7e-4, 8e-4}, {1e4, 1e4}}}};
  plots.history = {{1, 20585}, {0.1, 95}, {0.1, 90}, {0.1, 100}, {-5, 85}, {5, 105}};
  plots.replicated = {{1, 100}, {0.1, 0.5}, {0.1, 0.4}, {0.1, 0.6}, {-5, -4}, {5, 6}};
  plots.measured = {4.44, 7.1};
  plots.study_text = "title = \"" + evil + "\"";
  plots.files = {{evil, "da39a3ee"}, {"b.csv", "da39a3ee"}};
  result.plots = plots;
  return result;
}

std::string html_report(const PosteriorSummary& summary) {
  const Result result = posterior_result(summary);
  return report_html(result.header, result.sections);
}

std::string without_scripts(const std::string& page) {
  std::string out;
  for (std::size_t at = 0; at < page.size();) {
    const std::size_t begin = page.find("<script", at);
    out += page.substr(at, begin - at);
    if (begin == std::string::npos) break;
    at = page.find("</script>", begin);
  }
  return out;
}

TEST(Report, SaysTheVerdictFirst) {
  const std::string page = html_report(result_of(Verdict::pass));
  std::size_t sentence = 0;
  for (const char* each :
       {"The worn volume reaches 100\u00a0mm³ after 21\u202f600\u00a0cycles (median); 18\u202f000 "
        "to "
        "26\u202f000\u00a0cycles (90\u00a0%), one in ten before 19\u202f000\u00a0cycles.",
        "Inspect again within 6\u202f000\u00a0cycles: 1\u00a0% risk of "
        "reaching the limit before.",
        "At 20\u202f585\u00a0cycles the worn volume is 95.0\u00a0mm³ (mean); 90.0 to 100\u00a0mm³ "
        "(90\u00a0%).",
        "The wear coefficient k is 7.60\u00a0×\u00a010⁻⁴\u00a0mm³/(N\u00a0m) (mean); 7.10 to "
        "8.10\u00a0×\u00a010⁻⁴\u00a0mm³/(N\u00a0m) (90\u00a0%)."}) {
    const std::size_t at = page.find("<p class=\"verdict\">" + std::string(each) + "</p>");
    ASSERT_NE(at, std::string::npos) << each;
    EXPECT_GT(at, sentence);
    sentence = at;
  }
  ASSERT_NE(sentence, std::string::npos);
  EXPECT_LT(sentence, page.find("id=\"predictions\""));
  std::size_t before = 0;
  for (const char* id : {"verdict", "predictions", "parameters", "fit", "checks", "method"}) {
    const std::size_t at = page.find(std::string("<section id=\"") + id);
    ASSERT_NE(at, std::string::npos) << id;
    EXPECT_GT(at, before);
    before = at;
  }
}

// The words above the design values are those of their columns.
TEST(Report, DesignValuesAreExplainedByTheirSides) {
  PosteriorSummary result = result_of(Verdict::pass);
  QuantitySummary life{"B10 life", "shaft", "at 400 MPa", "cycles", false, {}, {}};
  life.drawn.q05 = 282500, life.drawn.q50 = 381200, life.drawn.q95 = 480800;
  life.drawn.predictive = 368800;
  life.credible_level = 0.95;
  const auto page = [&](BoundSides sides) {
    life.sides = sides;
    life.drawn.bound = has_lower(sides) ? std::optional(304400.0) : std::nullopt;
    life.drawn.upper_bound = has_upper(sides) ? std::optional(470000.0) : std::nullopt;
    result.quantities = {life};
    return html_report(result);
  };
  const std::string lower = page(BoundSides::lower), upper = page(BoundSides::upper),
                    both = page(BoundSides::both);
  EXPECT_THAT(lower, HasSubstr("At least: the lower bound to design with. With 95 % confidence"));
  EXPECT_THAT(upper, HasSubstr("At most: the upper bound. With 95 % confidence"));
  EXPECT_THAT(both, HasSubstr("95 % from, to: the two-sided interval. With 95 % confidence"));
  EXPECT_THAT(upper, Not(HasSubstr("At least: the lower bound")));
  EXPECT_THAT(both, Not(HasSubstr("At least: the lower bound")));
}

TEST(Report, ASkewedParameterIsItsMedian) {
  PosteriorSummary result = result_of(Verdict::pass);
  EXPECT_THAT(html_report(result), Not(HasSubstr("median; ")));
  result.parameters[0].exact = ExactSummary{9e11, 1e13, 1.6e7, 1e8, 3.58e12};
  EXPECT_THAT(html_report(result),
              HasSubstr("median; 1.60\u00a0×\u00a010⁷ to 3.58\u00a0×\u00a010¹²"));
}

TEST(Report, TrustIsAWord) {
  EXPECT_THAT(html_report(result_of(Verdict::pass)), HasSubstr("<strong>Trusted.</strong>"));
  EXPECT_THAT(
      html_report(result_of(Verdict::warn)),
      HasSubstr("<strong>Trusted, with a warning.</strong> No check failed; see convergence."));
  EXPECT_THAT(html_report(result_of(Verdict::fail)),
              HasSubstr("<strong>Not trusted.</strong> Do not use these numbers: convergence "
                        "failed. Draw more."));
}

// What is asked stands in a picture before any table.
TEST(Report, ThePictureThatAnswersComesFirst) {
  const std::string page = html_report(result_of(Verdict::pass));
  const std::size_t picture = page.find("<figure id=\"history\"");
  ASSERT_NE(picture, std::string::npos);
  EXPECT_LT(picture, page.find("<table"));
  EXPECT_LT(picture, page.find("<section id=\"predictions\""));
}

TEST(Report, NamesAreTextAndNotMarkup) {
  const std::string page = html_report(result_of(Verdict::pass));
  EXPECT_EQ(page.find("<img src=x"), std::string::npos);
  EXPECT_THAT(page, HasSubstr("&lt;img src=x onerror=alert(1)&gt;"));
}

TEST(Report, FetchesNothing) {
  const std::string page = html_report(result_of(Verdict::pass));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  const std::string markup = without_scripts(page);
  EXPECT_FALSE(std::regex_search(markup, std::regex("(src|href)=\"(?!#)")));
  EXPECT_THAT(markup, Not(HasSubstr("url(")));
  EXPECT_THAT(markup, Not(HasSubstr("@import")));
  EXPECT_LT(page.size(), 2'000'000u);
}

TEST(Report, EveryScriptEndsWhereItShould) {
  const std::string page = html_report(result_of(Verdict::pass));
  int opened = 0, closed = 0;
  for (std::size_t at = 0; (at = page.find("<script", at)) != std::string::npos; ++at) ++opened;
  for (std::size_t at = 0; (at = page.find("</script", at)) != std::string::npos; ++at) ++closed;
  EXPECT_EQ(opened, closed);
  std::size_t at = 0;
  const std::string begin = "<script type=\"application/json\">";
  int specifications = 0;
  while ((at = page.find(begin, at)) != std::string::npos) {
    at += begin.size();
    const auto spec = nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at));
    EXPECT_FALSE(spec["layer"].empty());
    ++specifications;
  }
  // History; prior and posterior; the check; trace and histogram. No life curve, no stages.
  EXPECT_EQ(specifications, 5);
}

}  // namespace
}  // namespace wearwell
