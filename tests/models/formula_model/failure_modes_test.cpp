// Competing failure modes (failure_modes.h): rows against integrals by R, published fits, identities, messages.
#include <gtest/gtest.h>

#include <boost/math/distributions/gamma.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <fstream>
#include <sstream>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/infer/exact.h"
#include "wearwell/infer/maximize.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/life_groups.h"
#include "wearwell/models/formula_model/mode_figures.h"
#include "wearwell/models/formula_model/mode_fit_data.h"

namespace wearwell::formula_model {
namespace {

std::string flat(const std::string& names) {
  std::istringstream all(names);
  std::string text = "[prior]\n", name;
  while (all >> name) text += name + " = { distribution = \"flat\" }\n";
  return text;
}

class FailureModesTest : public ScratchTest {
 protected:
  std::shared_ptr<const FormulaModel> model(const std::string& table, const std::string& text) {
    write("d.csv", table);
    const Source source =
        source_of(write("study.toml", "model = \"formula\"\n[data]\nfile = \"d.csv\"\n" + text));
    return read_formula_model(TomlReader::parse(source.study), source);
  }
  std::shared_ptr<const LogDensity> likelihood(const std::string& table, const std::string& text) {
    const auto own = model(table, text);
    return formula_likelihood(std::make_shared<const FormulaRows>(own, own->data.table.rows));
  }
  std::string refusal(const std::string& table, const std::string& text) {
    return message_of<InputError>([&] { model(table, text); });
  }
};

std::string content(const std::string& file) {
  std::ifstream in(PROJECT_SOURCE_DIR "/" + file);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

const std::string of_rows = R"toml(
[data.columns]
life = "life"
status = "status"
lower = "lower"
upper = "upper"
entry = "entry"
mode = "mode"
[failure_modes]
column = "mode"
[failure_modes.b]
family = "lognormal"
median = "m"
log_sd = "s"
[failure_modes.c]
family = "weibull"
scale = "eta_c"
shape = "beta_c"
[likelihood.life]
family = "weibull"
scale = "eta_a"
shape = "beta_a"
)toml";

// eta_a, eta_c, beta_a, beta_c, m, s.
std::vector<double> point(int which) {
  return which == 1 ? std::vector<double>{180, 160, 0.7, 8, 150, 0.4}
                    : std::vector<double>{400, 110, 1.6, 12, 90, 1.1};
}

std::string rows_study() {
  return of_rows + flat("eta_a eta_c beta_a beta_c m s");
}

// tests/golden/failure_modes.R: known and unknown modes, of exact lives, intervals, left-censored lives, late entries.
TEST_F(FailureModesTest, RowsAgreeWithIntegralsByBruteForce) {
  const auto density = likelihood(content("tests/golden/failure_modes_rows.csv"), rows_study());
  std::istringstream golden(content("tests/golden/failure_modes.csv"));
  std::string line;
  std::getline(golden, line);
  int compared = 0;
  while (std::getline(golden, line)) {
    int which = 0;
    std::size_t row = 0;
    double expected = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%d,%zu,%lf", &which, &row, &expected), 3);
    const std::vector<double> each = density->pointwise(point(which));
    ASSERT_EQ(each.size(), 15u);
    EXPECT_NEAR(each[row - 1], expected, 1e-9 * (1 + std::abs(expected))) << line;
    ++compared;
  }
  EXPECT_EQ(compared, 30);
}

TEST_F(FailureModesTest, TheSumOfRowsAndItsGradientAgree) {
  const auto density = likelihood(content("tests/golden/failure_modes_rows.csv"), rows_study());
  for (const int which : {1, 2}) {
    std::vector<double> x = point(which), gradient(6);
    const double value = density->value_and_gradient(x, gradient);
    double sum = 0;
    for (const double each : density->pointwise(x)) sum += each;
    EXPECT_NEAR(value, sum, 1e-9 * std::abs(sum));
    EXPECT_EQ(value, density->value(x));
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double step = 1e-5 * x[i], at = x[i];
      x[i] = at + step;
      const double above = density->value(x);
      x[i] = at - step;
      const double below = density->value(x);
      x[i] = at;
      EXPECT_NEAR(gradient[i] * x[i], (above - below) / (2e-5),
                  2e-5 * (1 + std::abs(gradient[i] * x[i])))
          << which << " " << i;
    }
  }
}

const std::string device_g = R"toml(
[data.columns]
life = { column = "kilocycles", unit = "1" }
mode = "cause"
[failure_modes]
column = "mode"
runout = "C"
[likelihood.life]
family = "weibull"
scale = "exp(mu[mode])"
shape = "1/sigma[mode]"
)toml";

// Meeker and Escobar (1998), sec. 15.4, device G: surge 6.11 and 1.49, wear 5.83 and 0.23 (location and scale of log life);
// all digits by tests/golden/failure_modes.R.
TEST_F(FailureModesTest, DeviceGHasThePublishedEstimates) {
  const auto density =
      likelihood(content("tests/golden/device_g.csv"), device_g + flat("mu sigma"));
  const Maximum found =
      maximize(*density, Eigen::Vector4d(5, 5, 1, 1), Eigen::Vector4d(1, 1, 0.5, 0.5),
               {Eigen::Vector4d(-INFINITY, -INFINITY, 0, 0), Eigen::Vector4d::Constant(INFINITY)});
  ASSERT_TRUE(found.converged);
  const double expected[] = {5.830075, 6.108067, 0.230559,
                             1.490330};  // W is the first in the table
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(found.x[i], expected[i], 2e-5);
  EXPECT_NEAR(found.value, -101.364206 - 47.162210, 2e-6);
}

const std::string shocks = R"toml(
[data.columns]
life = { column = "km", unit = "1" }
mode = "failure mode"
[failure_modes]
column = "mode"
[likelihood.life]
family = "weibull"
scale = "eta[mode]"
shape = "beta[mode]"
)toml";

// Meeker and Escobar (1998), table C.2: shock absorbers, each mode with the other as a run-out.
TEST_F(FailureModesTest, ShockAbsorbersByMode) {
  const auto density =
      likelihood(content("examples/life/shock_absorbers.csv"), shocks + flat("eta beta"));
  const Maximum found =
      maximize(*density, Eigen::Vector4d(3e4, 3e4, 2, 2), Eigen::Vector4d(1e4, 1e4, 1, 1),
               {Eigen::Vector4d::Zero(), Eigen::Vector4d::Constant(INFINITY)});
  ASSERT_TRUE(found.converged);
  EXPECT_NEAR(found.x[0] / 31205.830, 1, 1e-5);
  EXPECT_NEAR(found.x[1] / 40865.927, 1, 1e-5);
  EXPECT_NEAR(found.x[2], 3.383941, 2e-5);
  EXPECT_NEAR(found.x[3], 2.822206, 2e-5);
  EXPECT_NEAR(found.value, -81.497976 - 49.636145, 2e-6);
}

// Of separate parameters the likelihood is the product of those of studies of one mode.
TEST_F(FailureModesTest, SeparateModesAreStudiesOfTheirOwn) {
  const std::string table = content("examples/life/shock_absorbers.csv");
  const auto both = likelihood(table, shocks + flat("eta beta"));
  const auto alone = [&](const std::string& mode) {
    std::istringstream lines(table);
    std::string line, own = "km,status\n";
    std::getline(lines, line);
    while (std::getline(lines, line)) {
      const std::size_t comma = line.find(',');
      own += line.substr(0, comma) + (line.substr(comma + 1) == mode ? ",failure\n" : ",runout\n");
    }
    return likelihood(
        own,
        "[data.columns]\nlife = { column = \"km\", unit = \"1\" }\nstatus = \"status\"\n"
        "[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta\"\nshape = \"beta\"\n" +
            flat("eta beta"));
  };
  const auto first = alone("mode 1"), second = alone("mode 2");
  Rng rng(7, 0);
  for (int i = 0; i < 50; ++i) {
    const double eta_1 = 1e4 + 5e4 * rng.uniform(), eta_2 = 1e4 + 5e4 * rng.uniform();
    const double beta_1 = 0.5 + 4 * rng.uniform(), beta_2 = 0.5 + 4 * rng.uniform();
    const double sum =
        first->value(std::vector{eta_1, beta_1}) + second->value(std::vector{eta_2, beta_2});
    EXPECT_NEAR(both->value(std::vector{eta_1, eta_2, beta_1, beta_2}), sum, 1e-12 * std::abs(sum));
  }
}

// Exponential modes under flat priors of their means: with r_k failures in a total of T the rates are gamma distributed (r_k - 1, 1/T),
// that of the part too, and the share of mode 1 in it is beta distributed, independent of it.
TEST_F(FailureModesTest, ExponentialModesHaveClosedForms) {
  std::string text = shocks.substr(0, shocks.find("[likelihood"));
  text += "[likelihood.life]\nfamily = \"exponential\"\nmean = \"m[mode]\"\n" + flat("m");
  const auto own = model(content("examples/life/shock_absorbers.csv"), text);
  const Posterior posterior(own->parameters, formula_likelihood(std::make_shared<const FormulaRows>(
                                                 own, own->data.table.rows)));
  const ExactPosterior exact =
      integrate(posterior, whitening_at(find_mode(posterior, posterior.start())));
  ASSERT_EQ(exact.failure, "");
  const WeightedDraws& nodes = exact.nodes;
  double total = 0;
  for (const Response& each : own->lives.responses) total += each.at;
  const TomlReader root = TomlReader::parse({"study.toml", "model = \"formula\"\n"});
  const auto part = life_distribution(root, "likelihood", own, {});
  const auto alone = life_distribution(root, "likelihood", own, {}, 1);
  const double one = 7 - 1, two = 4 - 1;  // failures by mode, less 1
  const double p = 0.1, life = total * (std::pow(1 - p, -1 / (one + two)) - 1);
  EXPECT_NEAR(part->next(nodes).quantile(p) / life, 1, 1e-4);
  EXPECT_NEAR(alone->next(nodes).quantile(p) / (total * (std::pow(1 - p, -1 / one) - 1)), 1, 1e-4);
  const auto share = [&](std::size_t k) {
    return part->incidence(nodes, k, life).distribution.mean();
  };
  EXPECT_NEAR(share(0) / (p * one / (one + two)), 1, 1e-4);
  EXPECT_NEAR(share(1) / (p * two / (one + two)), 1, 1e-4);
  const boost::math::gamma_distribution<> rate(one + two, 1 / total);
  const QuantityDistribution b10 = part->quantile(nodes, p).distribution;
  const QuantityDistribution lasts = part->survival(nodes, life).distribution;
  for (const double q : {0.05, 0.5, 0.95}) {
    EXPECT_NEAR(b10.quantile(q) * quantile(rate, 1 - q) / -std::log1p(-p), 1, 1e-4) << q;
    EXPECT_NEAR(lasts.quantile(q) / std::exp(-life * quantile(rate, 1 - q)), 1, 1e-4) << q;
  }
}

// Weibull lives of one shape have hazards in a fixed ratio: so have the shares failed by each mode.
TEST_F(FailureModesTest, ProportionalHazardsHaveSharesInTheirRatio) {
  const auto own = model(content("examples/life/shock_absorbers.csv"), shocks + flat("eta beta"));
  const TomlReader root = TomlReader::parse({"study.toml", "model = \"formula\"\n"});
  std::vector<Risk> risks;
  for (const Measured& each : own->measured)
    risks.push_back(risk_of(make_path(own, root, "likelihood", each.wanted, false, {}), each));
  LifeAtPoint at(risks);
  for (const double shape : {0.4, 1.0, 6.0}) {
    const std::vector<double> x = {20000, 30000, shape, shape};
    at.move_to(x.data());
    const double ratio = std::pow(30000. / 20000, shape);
    for (const double life : {300., 9000., 40000.}) {
      const double failed =
          1 - std::exp(-std::pow(life / 20000, shape) - std::pow(life / 30000, shape));
      EXPECT_NEAR(at.cdf(life), failed, 1e-12);
      EXPECT_NEAR(at.incidence(0, life), failed * ratio / (1 + ratio), 1e-7);
      EXPECT_NEAR(at.incidence(1, life), failed / (1 + ratio), 1e-7);
    }
    const double scale = std::pow(std::pow(20000, -shape) + std::pow(30000, -shape), -1 / shape);
    EXPECT_NEAR(at.quantile(0.1) / (scale * std::pow(-std::log(0.9), 1 / shape)), 1, 1e-9);
    EXPECT_NEAR(at.mean_beyond(0) / (scale * std::tgamma(1 + 1 / shape)), 1, 1e-6);
    EXPECT_NEAR(at.hazard(15000) / (shape / scale * std::pow(15000 / scale, shape - 1)), 1, 1e-10);
  }
}

// Five parts: 1 fails by a, 2 by b, 3 leaves, 4 by a, 5 leaves; by hand.
TEST_F(FailureModesTest, AalenJohansenByHand) {
  const auto own =
      model("life,mode\n1,a\n2,b\n3,runout\n4,a\n5,runout\n",
            "[data.columns]\nlife = { column = \"life\", unit = \"1\" }\nmode = \"mode\"\n"
            "[failure_modes]\ncolumn = \"mode\"\n[likelihood.life]\nfamily = \"weibull\"\n"
            "scale = \"eta[mode]\"\nshape = \"beta[mode]\"\n" +
                flat("eta beta"));
  const auto steps = incidence_steps(*own->modes, own->lives);
  ASSERT_EQ(steps.size(), 2u);
  ASSERT_EQ(steps[0].size(), 2u);
  EXPECT_NEAR(steps[0][0].share, 0.2, 1e-15);
  EXPECT_NEAR(steps[0][1].share, 0.2 + 0.6 * 0.5, 1e-15);
  ASSERT_EQ(steps[1].size(), 1u);
  EXPECT_NEAR(steps[1][0].share, 0.2, 1e-15);
}

// Under the true parameters residuals are standard normal, those of drawn modes and lives too.
TEST_F(FailureModesTest, ResidualsOfMaskedAndIntervalLivesAreStandardNormal) {
  Rng rng(11, 0);
  std::string table = "life,status,lower,upper,mode\n";
  for (int i = 0; i < 3000; ++i) {
    const double a = 20000 * std::pow(-std::log(rng.uniform()), 1 / 1.5);
    const double b = 30000 * std::pow(-std::log(rng.uniform()), 1 / 4.0);
    const double life = std::min(a, b);
    const std::string mode = i % 3 == 0 ? "a|b" : a < b ? "a" : "b";
    const double before = 5000 * std::floor(life / 5000);
    char line[200];
    if (i % 2 == 0)
      std::snprintf(line, sizeof line, "%.9g,failure,,,%s\n", life, mode.c_str());
    else
      std::snprintf(line, sizeof line, ",interval,%.9g,%.9g,%s\n", before, before + 5000,
                    mode.c_str());
    table += line;
  }
  const auto own = model(
      table,
      "[data.columns]\nlife = { column = \"life\", unit = \"1\" }\nstatus = \"status\"\nlower = { "
      "column = \"lower\", unit = \"1\" }\n"
      "upper = { column = \"upper\", unit = \"1\" }\nmode = \"mode\"\n[failure_modes]\ncolumn = "
      "\"mode\"\n"
      "[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta[mode]\"\nshape = \"beta[mode]\"\n" +
          flat("eta beta"));
  const bool a_first = own->modes->modes.front() == "a";
  const std::vector<double> x = a_first ? std::vector<double>{20000, 30000, 1.5, 4}
                                        : std::vector<double>{30000, 20000, 4, 1.5};
  const FitData data =
      mode_fit_data(std::make_shared<const FormulaRows>(own, own->data.table.rows));
  const std::vector<NormalScore> scores = data.scores(x.data());
  ASSERT_EQ(scores.size(), 6000u);
  const boost::math::normal standard;
  double sum = 0, squares = 0;
  for (const NormalScore& each : scores) {
    const double low = cdf(standard, each.low),
                 high = std::isinf(each.high) ? 1 : cdf(standard, each.high);
    const double place = low + (high - low) * rng.uniform();
    sum += place;
    squares += place * place;
  }
  const double n = 6000;
  EXPECT_NEAR(sum / n, 0.5, 4 * std::sqrt(1 / 12. / n));
  EXPECT_NEAR(squares / n, 1 / 3., 4 * std::sqrt(4 / 45. / n));
}

TEST_F(FailureModesTest, CellsWithTwoReadingsAreRefused) {
  const std::string columns =
      "[data.columns]\nlife = { column = \"life\", unit = \"1\" }\nmode = \"mode\"\n";
  const std::string rest =
      "[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta[mode]\"\nshape = \"beta[mode]\"\n" +
      flat("eta beta");
  const std::string modes = "[failure_modes]\ncolumn = \"mode\"\n";
  const auto says = [&](const std::string& table, const std::string& text,
                        const std::string& part) {
    const std::string message = refusal(table, text);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  says("life,mode\n1,a\n2,\n3,b\n", columns + modes + rest, "row 2");
  says("life,mode\n1,a\n2,\n3,b\n", columns + modes + rest,
       "a run-out, or a failure of unknown mode");
  says("life,mode\n1,S\n2,W\n3,C\n", columns + modes + rest,
       "'S' can mean a run-out, or a failure mode");
  says("life,mode\n1,1\n2,2\n3,0\n", columns + modes + rest, "'0' can mean a run-out");
  for (const char* others : {"3,b", "3,running"})
    says(std::string("life,mode\n1,a\n2,still runing\n") + others + "\n", columns + modes + rest,
         "row 2, column 'mode': 'still runing' can mean a run-out ('stillrunning', misspelt)");
  says("life,mode\n1,seal\n2,failed\n3,running\n", columns + modes + rest,
       "row 2, column 'mode': 'failed' can mean a failure of unknown mode, or a failure mode of "
       "this "
       "name (beside seal)");
  says("life,mode\n1,a\n2,a|\n3,b\n", columns + modes + rest, "empty failure mode");
  says("life,mode,status\n1,a,failure\n2,b,runout\n3,b,failure\n",
       columns + "status = \"status\"\n" + modes + rest, "a run-out has no mode");
  says("life,mode,status\n1,a,failure\n2,censored,failure\n3,b,failure\n",
       columns + "status = \"status\"\n" + modes + rest,
       "'censored' is a run-out, but column 'status' has 'failure'");
  says("life,mode\n1,a\n2,b\n",
       columns + modes + "[failure_modes.c]\nfamily = \"exponential\"\nmean = \"m\"\n" + rest,
       "no row of column 'mode' has this failure mode, but a, b");
  says("life,mode\n1,a\n2,b\n",
       columns + modes +
           "[failure_modes.a]\nfamily = \"exponential\"\nmean = \"m\"\n[likelihood.life]\n" +
           flat("m"),
       "mode 'b' has no distribution");
  says("life,mode\n1,a\n2,b\n", columns + modes + "[random_effects.mode]\n" + rest,
       "random_effects");
  says("life,mode\n1,a\n2,b\n", columns + modes + rest + "[predict]\nalong = \"life\"\n", "along");
  says("life,mode\n1,a\n2,b\n", columns + "[failure_modes]\ncolumn = \"cause\"\n" + rest,
       "'cause' is not a column");
  says("life,mode\n1,a\n2,b\n",
       columns + modes +
           "[likelihood.life]\nfamily = \"normal\"\nmean = \"eta[mode]\"\nsd = \"beta[mode]\"\n" +
           flat("eta beta"),
       "positive lives");
}

// The study states what its words mean.
TEST_F(FailureModesTest, ModesThatMayBeOthersAreRefused) {
  const auto said = [&](const std::string& word, const std::string& more = "") -> std::string {
    try {
      model("life,mode\n10,seal\n20,gear\n25,runout\n30,\"" + word + "\"\n40,gear\n",
            "[data.columns]\nlife = { column = \"life\", unit = \"1\" }\nmode = \"mode\"\n"
            "[failure_modes]\ncolumn = \"mode\"\n" +
                more +
                "[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta\"\nshape = \"beta\"\n" +
                flat(more.empty() ? "eta beta" : "eta beta a b"));
    } catch (const InputError& error) {
      return error.what();
    }
    return "read";
  };
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != text.npos;
  };
  for (const char* const word : {"Seal", "SEAL", "se-al", "seal.", "seal?"}) {
    const std::string why = said(word);
    EXPECT_TRUE(has(why, "row 4") && has(why, "beside 'seal' can be one failure mode or two"))
        << why;
  }
  for (const char* const word :
       {"seal or gear", "seal/gear", "gear, seal", "Seal oder Gear", "seal + gear"}) {
    const std::string why = said(word);
    EXPECT_TRUE(has(why, "row 4") && has(why, "is not known, or a mode of its own")) << why;
    EXPECT_TRUE(has(why, "'seal|gear'") || has(why, "'gear|seal'")) << why;
  }
  // A mode that names others and is one of its own, by its table; words that only contain others.
  EXPECT_EQ(said("seal or gear",
                 "[failure_modes.\"seal or gear\"]\nfamily = \"weibull\"\n"
                 "scale = \"a\"\nshape = \"b\"\n"),
            "read");
  for (const char* const word : {"seal|gear", "seal housing", "1.1|11", "seal or motor", "orgear"})
    EXPECT_EQ(said(word), "read");
}

TEST_F(FailureModesTest, WordsOfTwoReadingsAreReadAsTheStudyStates) {
  const auto modes_of = [&](const std::string& words) {
    return model("life,mode\n1,seal\n2,failed\n3,still runing\n4,sensor\n5,suspended\n",
                 "[data.columns]\nlife = { column = \"life\", unit = \"1\" }\nmode = \"mode\"\n"
                 "[failure_modes]\ncolumn = \"mode\"\n" +
                     words +
                     "[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta[mode]\"\n"
                     "shape = \"beta\"\n" +
                     flat("eta beta"))
        ->modes->modes;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(modes_of("runout = [\"still runing\", \"suspended\"]\nunknown = \"failed\"\n"),
            (Names{"seal", "sensor"}));
  EXPECT_EQ(modes_of("runout = \"suspended\"\nunknown = \"unknown\"\n"),
            (Names{"seal", "failed", "still runing", "sensor"}));
}

// Words and sets: run-outs, unknown modes, possible modes.
TEST_F(FailureModesTest, CellsAreReadAsModes) {
  const auto own =
      model("life,mode\n1,a\n2,suspended\n3,unknown\n4,b | a\n5,\n",
            "[data.columns]\nlife = { column = \"life\", unit = \"1\" }\nmode = \"mode\"\n"
            "[failure_modes]\ncolumn = \"mode\"\n[likelihood.life]\nfamily = \"weibull\"\n"
            "scale = \"eta[mode]\"\nshape = \"beta\"\n" +
                flat("eta beta"));
  EXPECT_EQ(own->modes->modes, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(own->modes->possible, (std::vector<std::uint32_t>{1, 0, 3, 3, 3}));
  EXPECT_EQ(own->parameters.size(), 3u);
  EXPECT_EQ(own->joint.size(), 3u);
}

// Without a status column the study states what an empty cell is.
TEST_F(FailureModesTest, EmptyCellsAsTheStudyStates) {
  const auto possible = [&](const std::string& words) {
    return model("life,mode\n1,a\n2,\n3,b\n",
                 "[data.columns]\nlife = { column = \"life\", unit = \"1\" }\nmode = \"mode\"\n"
                 "[failure_modes]\ncolumn = \"mode\"\n" +
                     words +
                     "[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta[mode]\"\n"
                     "shape = \"beta\"\n" +
                     flat("eta beta"))
        ->modes->possible;
  };
  EXPECT_EQ(possible("runout = \"\"\n"), (std::vector<std::uint32_t>{1, 0, 2}));
  EXPECT_EQ(possible("unknown = \"\"\n"), (std::vector<std::uint32_t>{1, 3, 2}));
  EXPECT_THROW(possible("runout = \"\"\nunknown = \"\"\n"), InputError);
}

// A line of [formula] that depends on the mode has a copy for each.
TEST_F(FailureModesTest, DriversAreSharedOrSeparate) {
  const std::string table = "life,stress,mode\n100,2,a\n50,4,b\n70,3,a\n200,1,runout\n";
  const std::string head =
      "[data.columns]\nlife = { column = \"life\", unit = \"1\" }\nstress = { column = \"stress\", "
      "unit = \"1\" }\n"
      "mode = \"mode\"\n[failure_modes]\ncolumn = \"mode\"\n";
  const auto shared = likelihood(table, head +
                                            "[formula]\nload = \"stress^-p\"\nscale = \"eta[mode] "
                                            "* load\"\n[likelihood.life]\nfamily = \"weibull\"\n"
                                            "scale = \"scale\"\nshape = \"beta\"\n" +
                                            flat("eta p beta"));
  ASSERT_EQ(shared->dimension(), 4);
  const double ea = 200, eb = 300, p = 0.8, beta = 1.7;
  const auto log_s = [&](double eta, double s, double t) {
    return -std::pow(t / (eta * std::pow(s, -p)), beta);
  };
  const auto log_h = [&](double eta, double s, double t) {
    const double scale = eta * std::pow(s, -p);
    return std::log(beta / scale) + (beta - 1) * std::log(t / scale);
  };
  double expected = log_h(ea, 2, 100) + log_h(eb, 4, 50) + log_h(ea, 3, 70);
  const double lives[][2] = {{2, 100}, {4, 50}, {3, 70}, {1, 200}};
  for (const auto& each : lives)
    expected += log_s(ea, each[0], each[1]) + log_s(eb, each[0], each[1]);
  EXPECT_NEAR(shared->value(std::vector{ea, eb, p, beta}), expected, 1e-11);
}

}  // namespace
}  // namespace wearwell::formula_model
