// Subpopulations of lives (subpopulations.h, prob/life_mixture.h): rows against integrals by R, published fits, gradients, the order of
// names, messages.
#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <fstream>
#include <sstream>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/maximize.h"
#include "wearwell/models/formula_model/formula_fit_data.h"
#include "wearwell/models/formula_model/formula_life.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/life_groups.h"
#include "wearwell/models/formula_model/subpopulation_order.h"

namespace wearwell::formula_model {
namespace {

std::string flat_priors(const std::string& names) {
  std::istringstream all(names);
  std::string text = "[prior]\n", name;
  while (all >> name) text += name + " = { distribution = \"flat\" }\n";
  return text;
}

std::string file_text(const std::string& file) {
  std::ifstream in(PROJECT_SOURCE_DIR "/" + file);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

// Of tests/golden/subpopulations_fit.csv.
double fitted(const std::string& fit, const std::string& name) {
  std::istringstream lines(file_text("tests/golden/subpopulations_fit.csv"));
  const std::string begin = fit + "," + name + ",";
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(begin)) return std::stod(line.substr(begin.size()));
  ADD_FAILURE() << begin;
  return NAN;
}

class SubpopulationsTest : public ScratchTest {
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

const std::string every_kind = R"toml(
[data.columns]
life = "life"
status = "status"
lower = "lower"
upper = "upper"
entry = "entry"
[subpopulations]
names = ["a", "b"]
share = { a = "w" }
[subpopulations.b]
family = "lognormal"
median = "m"
log_sd = "s"
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
share_defective = "p"
share_dead_on_arrival = "d"
)toml";

std::string every_kind_study() {
  return every_kind + flat_priors("eta beta m s w p d");
}

std::vector<double> point_of(int which) {
  return which == 1 ? std::vector<double>{40, 0.8, 300, 0.3, 0.3, 0.6, 0.1}
                    : std::vector<double>{150, 2.5, 90, 1.2, 0.8, 0.05, 0.02};
}

void expect_gradient(const LogDensity& density, std::vector<double> x) {
  std::vector<double> gradient(x.size());
  const double value = density.value_and_gradient(x, gradient);
  EXPECT_EQ(value, density.value(x));
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double step = 1e-5 * x[i], at = x[i];
    x[i] = at + step;
    const double above = density.value(x);
    x[i] = at - step;
    const double below = density.value(x);
    x[i] = at;
    EXPECT_NEAR(gradient[i] * x[i], (above - below) / 2e-5,
                2e-5 * (1 + std::abs(gradient[i] * x[i])))
        << i;
  }
}

// tests/golden/subpopulations.R: exact lives, dead on arrival, run-outs, left-censored lives, intervals, late entries.
TEST_F(SubpopulationsTest, RowsAgreeWithIntegralsByBruteForce) {
  const auto density =
      likelihood(file_text("tests/golden/subpopulations_rows.csv"), every_kind_study());
  std::istringstream golden(file_text("tests/golden/subpopulations.csv"));
  std::string line;
  std::getline(golden, line);
  int compared = 0;
  while (std::getline(golden, line)) {
    int which = 0;
    std::size_t row = 0;
    double expected = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%d,%zu,%lf", &which, &row, &expected), 3);
    const std::vector<double> each = density->pointwise(point_of(which));
    ASSERT_EQ(each.size(), 14u);
    EXPECT_NEAR(each[row - 1], expected, 2e-10 * (1 + std::abs(expected))) << line;
    ++compared;
  }
  EXPECT_EQ(compared, 28);
}

TEST_F(SubpopulationsTest, GradientsAgreeWithDifferences) {
  const auto density =
      likelihood(file_text("tests/golden/subpopulations_rows.csv"), every_kind_study());
  for (const int which : {1, 2}) expect_gradient(*density, point_of(which));
}

const std::string circuits = R"toml(
[data.columns]
life = { column = "hours", unit = "1" }
status = "status"
count = "count"
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
share_defective = "p"
)toml";

// Meeker (1987): 28 of 4156 circuits failed within 1370 h; Meeker and Escobar (1998), sec. 11.5.2: p 0.00674, location 3.34
// and scale 2.02 of log life; all digits by tests/golden/subpopulations.R.
TEST_F(SubpopulationsTest, IntegratedCircuitsHaveThePublishedEstimates) {
  const auto density =
      likelihood(file_text("examples/life/circuits.csv"), circuits + flat_priors("eta beta p"));
  const Maximum found =
      maximize(*density, Eigen::Vector3d(20, 0.6, 0.01), Eigen::Vector3d(10, 0.2, 0.003),
               {Eigen::Vector3d::Zero(), Eigen::Vector3d(INFINITY, INFINITY, 1)});
  ASSERT_TRUE(found.converged);
  EXPECT_NEAR(std::log(found.x[0]), 3.34, 0.01);
  EXPECT_NEAR(1 / found.x[1], 2.02, 0.005);
  EXPECT_NEAR(found.x[2], 0.00674, 5e-6);
  EXPECT_NEAR(found.x[0] / fitted("limited", "eta"), 1, 2e-4);
  EXPECT_NEAR(found.x[1] / fitted("limited", "beta"), 1, 2e-5);
  EXPECT_NEAR(found.x[2] / fitted("limited", "p"), 1, 2e-5);
  EXPECT_NEAR(found.value, fitted("limited", "log_likelihood"), 2e-6);
}

// A share that can be 1 is the family itself.
TEST_F(SubpopulationsTest, AllDefectiveIsTheFamilyAlone) {
  const std::string table = file_text("examples/life/circuits.csv");
  const auto limited = likelihood(table, circuits + flat_priors("eta beta p"));
  std::string plain = circuits;
  plain.resize(plain.find("share_defective"));
  const auto family = likelihood(table, plain + flat_priors("eta beta"));
  for (const double beta : {0.3, 1.0, 4.0})
    EXPECT_NEAR(
        limited->value(std::vector{900., beta, 1.}) / family->value(std::vector{900., beta}), 1,
        1e-12);
}

const std::string controllers = R"toml(
[data.columns]
life = { column = "hours", unit = "1" }
status = "status"
[subpopulations]
names = ["early", "late"]
share = { early = "w" }
[likelihood.life]
family = "weibull"
scale = "eta[subpopulation]"
shape = "beta[subpopulation]"
)toml";

std::vector<double> fit_of_controllers() {
  return {fitted("mixture", "eta_1"), fitted("mixture", "eta_2"), fitted("mixture", "beta_1"),
          fitted("mixture", "beta_2"), fitted("mixture", "share")};
}

TEST_F(SubpopulationsTest, TheModeUnderFlatPriorsIsTheMaximumLikelihoodEstimate) {
  const auto density = likelihood(file_text("examples/life/controllers.csv"),
                                  controllers + flat_priors("eta beta w"));
  Eigen::VectorXd start(5), size(5), low = Eigen::VectorXd::Zero(5), high(5);
  start << 900, 24000, 1, 3, 0.2;
  size << 300, 3000, 0.3, 0.5, 0.05;
  high << INFINITY, INFINITY, INFINITY, INFINITY, 1;
  const Maximum found = maximize(*density, start, size, {low, high});
  ASSERT_TRUE(found.converged);
  const std::vector<double> expected = fit_of_controllers();
  for (int i = 0; i < 5; ++i)
    EXPECT_NEAR(found.x[i] / expected[static_cast<std::size_t>(i)], 1, 3e-4) << i;
  EXPECT_NEAR(found.value, fitted("mixture", "log_likelihood"), 2e-6);
}

// Two uniform shares leave a rest with probability 1/2, three with 1/6; orders multiply by 3! and 4!.
TEST_F(SubpopulationsTest, SharesOfThreeAndMoreAreNormalized) {
  const auto density_of = [&](const std::string& names, const std::string& shares,
                              const std::vector<std::string>& parameters) {
    std::string text = controllers;
    text.replace(text.find("[\"early\", \"late\"]"), 17, names);
    text.replace(text.find("early = \"w\""), 11, shares);
    text += flat_priors("eta beta");
    for (const std::string& each : parameters)
      text += each + " = { distribution = \"uniform\", lower = 0, upper = 1 }\n";
    return log_orders(*model(file_text("examples/life/controllers.csv"), text));
  };
  EXPECT_NEAR(density_of("[\"x\", \"y\", \"z\"]", "x = \"w\", z = \"v\"", {"w", "v"}),
              std::log(6.0) + std::log(2.0), 1e-4);
  EXPECT_NEAR(density_of("[\"x\", \"y\", \"z\", \"u\"]", "x = \"w\", z = \"v\", u = \"q\"",
                         {"w", "v", "q"}),
              std::log(24.0) + std::log(6.0), 1e-4);
}

// With exchanged names the rows have the same likelihood; the order of the medians tells them apart, and both orders add up to 1.
TEST_F(SubpopulationsTest, TheOrderIsAPartitionOfTheExchangeablePosterior) {
  const auto own =
      model(file_text("examples/life/controllers.csv"), controllers + flat_priors("eta beta w"));
  ASSERT_TRUE(own->subpopulations->exchangeable);
  EXPECT_NEAR(log_orders(*own), std::log(2.0), 1e-12);
  const auto density =
      formula_likelihood(std::make_shared<const FormulaRows>(own, own->data.table.rows));
  SubpopulationOrder order(*own);
  for (const double ratio : {0.5, 0.97, 1.0, 1.02, 3.0}) {
    const std::vector<double> x = {9000, 9000 * ratio, 1.4, 1.4, 0.3},
                              exchanged = {9000 * ratio, 9000, 1.4, 1.4, 0.7};
    EXPECT_NEAR(std::exp(order.value(x)) + std::exp(order.value(exchanged)), 1, 1e-12);
    EXPECT_NEAR(order.value(x), -std::log1p(std::pow(ratio, -SubpopulationOrder::sharpness)), 1e-9);
    const std::vector<double> rows = density->pointwise(x), other = density->pointwise(exchanged);
    double sum = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_NEAR(rows[i], other[i], 1e-12 * (1 + std::abs(rows[i])));
      sum += rows[i];
    }
    EXPECT_NEAR(density->value(x), sum + order.value(x), 1e-9 * std::abs(sum));
    expect_gradient(*density, x);
  }
}

TEST_F(SubpopulationsTest, ThreeSubpopulationsAreOrdered) {
  std::string three = controllers;
  three.replace(three.find("[\"early\", \"late\"]"), 17, "[\"x\", \"y\", \"z\"]");
  three.replace(three.find("early = \"w\""), 11, "x = \"w\", z = \"(1 - w) * v\"");
  const auto own = model(file_text("examples/life/controllers.csv"),
                         three + flat_priors("eta beta") +
                             "w = { distribution = \"uniform\", lower = 0, upper = 1 }\n"
                             "v = { distribution = \"uniform\", lower = 0, upper = 1 }\n");
  SubpopulationOrder order(*own);
  double sum = 0;
  std::vector<double> eta = {5000, 5300, 5900};
  do {
    const std::vector<double> x = {eta[0], eta[1], eta[2], 2, 2, 2, 0.2, 0.5};
    sum += std::exp(order.value(x));
  } while (std::next_permutation(eta.begin(), eta.end()));
  EXPECT_NEAR(sum, 1, 1e-12);
  const auto density =
      formula_likelihood(std::make_shared<const FormulaRows>(own, own->data.table.rows));
  expect_gradient(*density, {4000, 4300, 20000, 1.2, 2.1, 3.3, 0.2, 0.5});
}

TEST_F(SubpopulationsTest, DifferentPriorsOrFamiliesTellThemApartThemselves) {
  const std::string table = file_text("examples/life/controllers.csv");
  const auto exchangeable = [&](const std::string& text) {
    return model(table, text)->subpopulations->exchangeable;
  };
  const std::string priors =
      "[prior]\nbeta = { distribution = \"lognormal\", median = 1, log_sd = 1 }\n"
      "w = { distribution = \"beta\", alpha = 1, beta = 5 }\n";
  EXPECT_TRUE(exchangeable(controllers + priors +
                           "eta = { distribution = \"lognormal\", median = 9000, log_sd = 1 }\n"));
  EXPECT_FALSE(exchangeable(
      controllers + priors +
      "\"eta[early]\" = { distribution = \"lognormal\", median = 900, log_sd = 1 }\n"
      "\"eta[late]\" = { distribution = \"lognormal\", median = 9000, log_sd = 1 }\n"));
  const std::string own =
      controllers.substr(0, controllers.find("family")) +
      "[subpopulations.early]\nfamily = \"weibull\"\nscale = \"eta_1\"\nshape = \"beta_1\"\n"
      "[subpopulations.late]\nfamily = \"weibull\"\nscale = \"eta_2\"\nshape = \"beta_2\"\n";
  EXPECT_TRUE(exchangeable(own + flat_priors("eta_1 beta_1 eta_2 beta_2 w")));
  std::string other = own;
  other.replace(other.rfind("shape = \"beta_2\""), 16, "shape = \"2 * beta_2\"");
  EXPECT_FALSE(exchangeable(other + flat_priors("eta_1 beta_1 eta_2 beta_2 w")));
}

// P(T > t) = (1 - d)(1 - p F(t)).
TEST_F(SubpopulationsTest, LivesThatAreNeverReached) {
  const std::string text =
      "[data.columns]\nlife = { column = \"life\", unit = \"1\" }\n[likelihood.life]\nfamily = "
      "\"weibull\"\nscale = \"eta\"\nshape = \"beta\"\nshare_defective = "
      "\"p\"\nshare_dead_on_arrival = \"d\"\n" +
      flat_priors("eta beta p d");
  const auto own = model("life\n3\n0\n5\n9\n", text);
  const TomlReader root = TomlReader::parse({"study.toml", "model = \"formula\"\n"});
  const Measured& measured = own->measured.front();
  const std::vector<Risk> risks = {
      risk_of(make_path(own, root, "likelihood", measured.wanted, false, {}), measured)};
  LifeAtPoint at(risks);
  const std::vector<double> x = {100, 2, 0.3, 0.04};
  at.move_to(x.data());
  const double failing = 0.04 + 0.96 * 0.3;
  EXPECT_NEAR(at.failing(), failing, 1e-15);
  EXPECT_EQ(at.quantile(0.03), 0);
  EXPECT_EQ(at.quantile(failing), INFINITY);
  EXPECT_EQ(at.mean_beyond(0), INFINITY);
  for (const double p : {0.05, 0.2, 0.32}) {
    const double life = at.quantile(p);
    EXPECT_NEAR(life, 100 * std::sqrt(-std::log1p(-(p - 0.04) / (0.96 * 0.3))), 1e-9 * life);
    EXPECT_NEAR(at.cdf(life), p, 1e-12);
    EXPECT_NEAR(std::exp(at.log_survival(life)), 1 - p, 1e-12);
    const double step = 1e-5 * life;
    EXPECT_NEAR(at.hazard(life) * (1 - p), (at.cdf(life + step) - at.cdf(life - step)) / (2 * step),
                1e-7);
  }
  // Of two parts of one kind that cannot end together except at 0 or never, each outlives the other in half of the rest.
  const double ties = 0.04 * 0.04 + (1 - failing) * (1 - failing);
  EXPECT_NEAR(at.outlives(at), (1 - ties) / 2, 1e-7);
}

// Dead on arrival without a limit: the mean is that of the family times the share that works.
TEST_F(SubpopulationsTest, MeansAndSharesOfMixtures) {
  const auto own =
      model(file_text("examples/life/controllers.csv"),
            controllers + "share_dead_on_arrival = \"d\"\n" + flat_priors("eta beta w d"));
  const TomlReader root = TomlReader::parse({"study.toml", "model = \"formula\"\n"});
  const Measured& measured = own->measured.front();
  const std::vector<Risk> risks = {
      risk_of(make_path(own, root, "likelihood", measured.wanted, false, {}), measured)};
  LifeAtPoint at(risks);
  for (const double dead : {0.02, 0.9}) {
    const std::vector<double> x = {600, 20000, 0.8, 3, 0.2, dead};
    at.move_to(x.data());
    const double mean =
        0.2 * 600 * std::tgamma(1 + 1 / 0.8) + 0.8 * 20000 * std::tgamma(1 + 1 / 3.0);
    EXPECT_NEAR(at.mean_beyond(0) / ((1 - dead) * mean), 1, 1e-7);
    const double weak = 0.2 * std::exp(-std::pow(1000 / 600., 0.8)),
                 strong = 0.8 * std::exp(-std::pow(0.05, 3));
    EXPECT_NEAR(at.share_among_survivors(0, 1000), weak / (weak + strong), 1e-12);
    EXPECT_NEAR(at.share_among_survivors(0, 0), 0.2, 1e-12);
    for (const double p : {1e-6, 0.03, 0.5, 0.999}) {
      const double share = dead + p * (1 - dead), life = at.quantile(share);
      EXPECT_NEAR((at.cdf(life) - dead) / (1 - dead) / p, 1, 1e-8) << p;
    }
  }
}

// Under the true parameters residuals are standard normal, of run-outs and of parts dead on arrival too.
TEST_F(SubpopulationsTest, ResidualsAreStandardNormal) {
  Rng rng(5, 0);
  std::string table = "life,status,lower,upper,entry\n";
  for (int i = 0; i < 4000; ++i) {
    char line[100] = "0,failure,,,\n";
    if (rng.uniform() >= 0.1) {
      const bool defective = rng.uniform() < 0.6, weak = rng.uniform() < 0.3;
      const double u = rng.uniform();
      const double life = !defective ? INFINITY
                          : weak     ? 40 * std::pow(-std::log(u), 1 / 0.8)
                                     : 300 * std::exp(0.3 * quantile(boost::math::normal(), u));
      std::snprintf(line, sizeof line, "%.9g,%s,,,\n", std::min(life, 400.0),
                    life > 400 ? "runout" : "failure");
    }
    table += line;
  }
  const auto own = model(table, every_kind_study());
  const auto rows = std::make_shared<const FormulaRows>(own, own->data.table.rows);
  const std::vector<NormalScore> scores = fit_data(rows)->scores(point_of(1).data());
  // The mean probability of an interval of scores is 1/2, and its second moment that of its ends.
  double sum = 0;
  const boost::math::normal standard;
  for (const NormalScore& each : scores)
    sum += 0.5 * (cdf(standard, each.low) + (each.high < 10 ? cdf(standard, each.high) : 1));
  EXPECT_NEAR(sum / 4000, 0.5, 4 * std::sqrt(1.0 / 12 / 4000));
}

TEST_F(SubpopulationsTest, MessagesNameTheKey) {
  const std::string table = "life,status\n3,failure\n0,failure\n9,runout\n";
  const std::string columns =
      "[data.columns]\nlife = { column = \"life\", unit = \"1\" }\nstatus = \"status\"\n";
  const std::string family =
      "[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta\"\nshape = "
      "\"beta\"\n";
  const auto said = [&](const std::string& text) { return refusal(table, columns + text); };
  EXPECT_NE(said(family + flat_priors("eta beta")).find("share_dead_on_arrival"),
            std::string::npos);
  const std::string dead = family + "share_dead_on_arrival = \"d\"\n";
  EXPECT_NE(said(family + "share_defective = \"p\"\n" + flat_priors("eta beta p") +
                 "[predict]\nmean_life = true\n")
                .find("mean_life"),
            std::string::npos);
  const auto mixture = [&](const std::string& section) {
    return said("[subpopulations]\n" + section + family + flat_priors("eta beta w"));
  };
  EXPECT_NE(mixture("names = [\"a\"]\nshare = {}\n").find("two names"), std::string::npos);
  EXPECT_NE(
      mixture("names = [\"a\", \"b\"]\nshare = { a = \"w\", b = \"1 - w\" }\n").find("add up to 1"),
      std::string::npos);
  EXPECT_NE(mixture("names = [\"a\", \"b\"]\nshare = { c = \"w\" }\n").find("no subpopulation"),
            std::string::npos);
  EXPECT_NE(refusal("lower,upper,life,status\n0,4,,interval\n,,3,failure\n",
                    columns +
                        "lower = { column = \"lower\", unit = \"1\" }\nupper = { column = "
                        "\"upper\", unit = \"1\" }\n" +
                        dead + flat_priors("eta beta d"))
                .find("dead on arrival"),
            std::string::npos);
}

}  // namespace
}  // namespace wearwell::formula_model
