// Lives of units that differ, to the digits that are printed, against sums over dense grids that share no code
// with them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "calibration/formula_design.h"
#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/prob/standard_distribution.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

const std::string folder_of_lasers = PROJECT_SOURCE_DIR "/examples/degradation/";

// Straight paths with normal errors: each laser is its best slope and how well that is known.
struct Laser {
  double slope = 0, information = 0;  // %/kh; sum of t^2, kh^2
};

struct Lasers {
  std::vector<Laser> all;
  double squares = 0;  // of what is left about their own lines
  int readings = 0;

  Lasers() {
    std::ifstream file(folder_of_lasers + "laser.csv");
    std::string line;
    std::getline(file, line);  // laser,hours,increase_percent
    std::map<int, std::vector<std::pair<double, double>>> rows;
    while (std::getline(file, line)) {
      std::replace(line.begin(), line.end(), ',', ' ');
      std::istringstream words(line);
      int laser = 0;
      double hours = 0, increase = 0;
      words >> laser >> hours >> increase;
      rows[laser].emplace_back(hours / 1000, increase);
    }
    for (const auto& [laser, points] : rows) {
      double tt = 0, ty = 0;
      for (const auto& [t, y] : points) tt += t * t, ty += t * y;
      all.push_back({ty / tt, tt});
      for (const auto& [t, y] : points) squares += std::pow(y - ty / tt * t, 2), ++readings;
    }
  }
};

// The posterior of examples/degradation/lines.toml by the trapezoidal rule: over the logarithms of rate, sigma and
// scatter, and over the rate of each laser.
class Dense {
 public:
  static constexpr int n = 20, m = 141;
  std::vector<std::array<double, m>> density;  // of each laser's rate, %/kh
  struct Point {
    double log_rate, scatter, weight;
  };
  std::vector<Point> points;

  explicit Dense(const Lasers& lasers)
      : density(lasers.all.size()), lasers_(lasers), own_(lasers.all.size()) {
    std::vector<double> log_f;
    visit([&](double f) { log_f.push_back(f); });
    const double top = *std::max_element(log_f.begin(), log_f.end());
    double sum = 0;
    visit([&](double f) {
      const double weight = std::exp(f - top);
      sum += weight;
      points.push_back({log_rate_, scatter_, weight});
      for (std::size_t u = 0; u < own_.size(); ++u) {
        for (int i = 0; i < m; ++i) density[u][i] += weight * own_[u][i] / whole_[u];
      }
    });
    for (Point& each : points) each.weight /= sum;
    for (auto& each : density) {
      for (double& f : each) f /= sum;
    }
  }

  double step(std::size_t u) const { return 2 * reach(u) / (m - 1); }
  double rate(std::size_t u, double i) const {
    return lasers_.all[u].slope - reach(u) + i * step(u);
  }

  // P(the rate of laser u is at most r), by the polynomial through eight nodes within each step.
  double below(std::size_t u, double r) const {
    double sum = 0;
    for (int i = 3; i + 5 < m; ++i) {
      constexpr int parts = 8;
      for (int k = 0; k < parts; ++k) {
        const double low = rate(u, i + static_cast<double>(k) / parts);
        const double share = std::clamp((r - low) / (step(u) / parts), 0.0, 1.0);
        const double t = (k + 0.5 * share) / parts;
        if (!(share > 0)) return sum;
        double value = 0;
        for (int p = -3; p <= 4; ++p) {
          double basis = 1;
          for (int q = -3; q <= 4; ++q) basis *= q == p ? 1 : (t - q) / (p - q);
          value += basis * density[u][i + p];
        }
        sum += value * share / parts;
      }
    }
    return sum;
  }

 private:
  double reach(std::size_t u) const { return 9 * 0.21 / std::sqrt(lasers_.all[u].information); }

  template <class F>
  void visit(const F& add) {
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b < n; ++b) {
        for (int c = 0; c < n; ++c) {
          const double h = 1.0 / (n - 1);
          log_rate_ = std::log(2.0) + 0.6 * (2 * a * h - 1);
          const double log_sigma = std::log(0.16) + b * h * std::log(0.28 / 0.16);
          const double log_scatter = std::log(0.09) + c * h * std::log(0.75 / 0.09);
          const double sigma = std::exp(log_sigma);
          scatter_ = std::exp(log_scatter);
          // Priors: lognormal(2 %/kh, 1), half-normal(0.5 %), half-normal(0.5); on the logarithms.
          double f = -0.5 * std::pow(log_rate_ - std::log(2.0), 2) - 2 * sigma * sigma + log_sigma -
                     2 * scatter_ * scatter_ + log_scatter;
          f -= lasers_.readings * log_sigma + 0.5 * lasers_.squares / (sigma * sigma);
          for (std::size_t u = 0; u < own_.size(); ++u) {
            whole_.resize(own_.size());
            whole_[u] = 0;
            for (int i = 0; i < m; ++i) {
              const double r = rate(u, i), off = (r - lasers_.all[u].slope) / sigma;
              const double z = (std::log(r) - log_rate_) / scatter_;
              own_[u][i] = std::exp(-0.5 * lasers_.all[u].information * off * off - 0.5 * z * z) /
                           (r * scatter_);
              whole_[u] += own_[u][i];
            }
            f += std::log(whole_[u] * step(u));
          }
          add(f);
        }
      }
    }
  }

  const Lasers& lasers_;
  std::vector<std::array<double, m>> own_;
  std::vector<double> whole_;
  double log_rate_ = 0, scatter_ = 0;
};

TEST(FormulaLives, OfLasersAreThoseOfADenseGrid) {
  const PosteriorStudy study = wearwell::read_posterior_study(folder_of_lasers + "lines.toml");
  const PosteriorSummary result = run_study(study, {Method::exact, 1, {}, 2000, {}}, {}, false);
  const Lasers lasers;
  const Dense dense(lasers);
  const auto found = [&](const std::string& name, const std::string& of) {
    for (const QuantitySummary& each : result.quantities) {
      if (each.name == name && each.of == of) return each.best();
    }
    ADD_FAILURE() << name << " of " << of;
    return QuantityQuantiles();
  };
  // P(so long or less | not failed at 4000 h): the limit, 10 %, is reached at 10/rate.
  for (const int laser : {2, 3, 5, 8, 13}) {
    const auto u = static_cast<std::size_t>(laser - 1);
    const QuantityQuantiles life = found("remaining useful life", "laser " + std::to_string(laser));
    const double left = dense.below(u, 2.5);
    const auto cdf = [&](double hours) {
      return 1 - dense.below(u, 10 / (4 + hours / 1000)) / left;
    };
    for (const auto& [hours, p] :
         {std::pair(life.b1, 0.01), std::pair(life.q05, 0.05), std::pair(life.b10, 0.1),
          std::pair(life.q50, 0.5), std::pair(life.q95, 0.95)}) {
      // What it would have to be off by in its fifth digit.
      const double digit = 5e-5 * hours;
      EXPECT_LT(cdf(hours - digit), p) << laser << ' ' << p << ' ' << hours;
      EXPECT_GT(cdf(hours + digit), p) << laser << ' ' << p << ' ' << hours;
    }
  }
  const QuantityQuantiles life = found("life", "new laser");
  const auto cdf = [&](double hours) {
    double sum = 0;
    for (const Dense::Point& each : dense.points) {
      const double z = (std::log(10 / (hours / 1000)) - each.log_rate) / each.scatter;
      sum += each.weight * 0.5 * std::erfc(z / std::sqrt(2.0));
    }
    return sum;
  };
  for (const auto& [hours, p] :
       {std::pair(life.b1, 0.01), std::pair(life.q05, 0.05), std::pair(life.b10, 0.1),
        std::pair(life.q50, 0.5), std::pair(life.q95, 0.95)}) {
    EXPECT_LT(cdf(hours * (1 - 1e-4)), p) << p << ' ' << hours;
    EXPECT_GT(cdf(hours * (1 + 1e-4)), p) << p << ' ' << hours;
  }
}

class FormulaLivesOfStudies : public ScratchTest {};

// Two effects, at one point of the parameters: y = a + b t reaches 10 where b t = 10 - a, so that
// P(life <= t) is the mean over a of P(b > (10 - a)/t).
TEST_F(FormulaLivesOfStudies, EffectsAreThoseOfTheIntegral) {
  write("d.csv", "m,t,y\na,1,1.1\na,2,2.3\nb,1,0.9\nb,2,1.7\nc,1,1.4\nc,2,2.2\n");
  const PosteriorStudy study = wearwell::read_posterior_study(write("study.toml", R"(
model = "formula"
[data]
file = "d.csv"
[data.columns]
y = "y"
t = "t"
m = "m"
[likelihood.y]
family = "normal"
mean = "a + b*t"
sd = "sigma"
[prior]
a = { distribution = "normal", mean = 0, sd = 1 }
b = { distribution = "lognormal", median = 1, log_sd = 1 }
sigma = { distribution = "half-normal", scale = 1 }
sa = { distribution = "half-normal", scale = 1 }
sb = { distribution = "half-normal", scale = 1 }
[random_effects.m]
a = { distribution = "normal", sd = "sa" }
b = { distribution = "lognormal", log_sd = "sb" }
[predict]
along = "t"
limit = { "y_path" = 10 }
[formula]
y_path = "a + b*t"
)"));
  for (const auto& [sa, sb] : {std::pair(0.8, 0.25), std::pair(0.05, 0.25), std::pair(0.8, 0.01)}) {
    WeightedDraws draws;
    draws.values.resize(1, 5);
    draws.values << 0.1, 1.1, 0.2, sa, sb;
    draws.weights.setOnes(1);
    const QuantityQuantiles life = study.quantity_groups.front().from_draws(draws).front();
    const auto cdf = [&, sa = sa, sb = sb](double t) {
      double sum = 0;
      for (int i = -400; i <= 400; ++i) {
        const double z = 0.02 * i, left = 10 - (0.1 + sa * z);
        const double above = std::log(left / t / 1.1) / sb;
        sum += 0.02 * std::exp(-0.5 * z * z) / std::sqrt(2 * M_PI) * 0.5 *
               std::erfc(above / std::sqrt(2.0));
      }
      return sum;
    };
    for (const auto& [t, p] : {std::pair(life.b1, 0.01), std::pair(life.q05, 0.05),
                               std::pair(life.q50, 0.5), std::pair(life.q95, 0.95)}) {
      EXPECT_LT(cdf(t * (1 - 2e-4)), p) << sa << ' ' << sb << ' ' << p;
      EXPECT_GT(cdf(t * (1 + 2e-4)), p) << sa << ' ' << sb << ' ' << p;
    }
  }
}

// B-lives over batches that differ are read off few points of the posterior, which weigh each its own: against all draws.
// Mean lives of lasers whose rates are lognormal, of straight paths and of a Wiener process, whose mean first passage is that of its
// mean path: 10 %/rate exp(scatter^2/2).
TEST_F(FormulaLivesOfStudies, MeansToAThresholdHaveTheClosedForm) {
  const auto mean_life = [&](const std::string& likelihood, const std::string& prior,
                             double scatter, const std::string& limited) {
    std::ifstream rows(folder_of_lasers + "laser.csv");
    write("laser.csv", std::string(std::istreambuf_iterator<char>(rows), {}));
    const PosteriorStudy study = read_posterior_study(write(
        "s.toml",
        "model = \"formula\"\n[data]\nfile = \"laser.csv\"\n[data.columns]\nincrease = { column = "
        "\"increase_percent\", unit = \"%\" }\ntime = { column = \"hours\", unit = \"h\" }\nlaser "
        "= "
        "\"laser\"\n[likelihood.increase]\n" +
            likelihood +
            "[prior]\nrate = { distribution = \"lognormal\", median = \"0.002 %/h\", log_sd = 1 }\n"
            "scatter = { distribution = \"half-normal\", scale = 0.5 }\n" +
            prior +
            "[random_effects.laser]\nrate = { distribution = \"lognormal\", log_sd = \"scatter\" "
            "}\n"
            "[formula]\npath = \"rate * time\"\n[predict]\nalong = \"time\"\nlimit = { " +
            limited +
            " = \"10 %\" }\nlives_of = []\n"
            "mean_life = true\n"));
    WeightedDraws one;
    one.values = Points::Zero(1, 3);
    one.weights = Eigen::VectorXd::Ones(1);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string& name = study.parameters[i].name;
      one.values(0, static_cast<Eigen::Index>(i)) = name == "rate"      ? 2e-5 / 3600
                                                    : name == "scatter" ? scatter
                                                                        : 1e-3;
    }
    const QuantityGroup& group = study.quantity_groups.front();
    const auto found = group.from_draws(one);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (group.requests[i].name != "mean life") continue;
      EXPECT_NEAR(*found[i].predictive / found[i].q50, 1, 1e-9);
      EXPECT_LE(*found[i].bound, found[i].q50 * (1 + 1e-9));
      return found[i].q50 / 3600;
    }
    ADD_FAILURE() << "no mean life";
    return 0.0;
  };
  for (const double scatter : {0.2, 0.6}) {
    const double mean = 0.1 / 2e-5 * std::exp(0.5 * scatter * scatter);
    EXPECT_NEAR(mean_life("family = \"normal\"\nmean = \"path\"\nsd = \"sigma\"\n",
                          "sigma = { distribution = \"half-normal\", scale = \"1 %\" }\n", scatter,
                          "path") /
                    mean,
                1, 2e-4)
        << scatter;
    EXPECT_NEAR(mean_life("family = \"wiener-process\"\nmean = \"path\"\nscale = \"u\"\n",
                          "u = { distribution = \"half-normal\", scale = \"1 %\" }\n", scatter,
                          "increase") /
                    mean,
                1, 2e-3)
        << scatter;
  }
}

// The mean remaining life of one unit is one number: no interval, no bound, no design value.
TEST_F(FormulaLivesOfStudies, TheMeanOfOneUnitIsOneNumber) {
  std::ifstream rows(folder_of_lasers + "laser.csv");
  write("laser.csv", std::string(std::istreambuf_iterator<char>(rows), {}));
  const PosteriorStudy study = wearwell::read_posterior_study(write("s.toml", R"(
model = "formula"
[data]
file = "laser.csv"
[data.columns]
increase = { column = "increase_percent", unit = "%" }
time = { column = "hours", unit = "h" }
laser = "laser"
[likelihood.increase]
family = "normal"
mean = "rate * time"
sd = "sigma"
[prior]
rate = { distribution = "lognormal", median = "0.002 %/h", log_sd = 1 }
scatter = { distribution = "half-normal", scale = 0.5 }
sigma = { distribution = "half-normal", scale = "1 %" }
[random_effects.laser]
rate = { distribution = "lognormal", log_sd = "scatter" }
[formula]
path = "rate * time"
[predict]
along = "time"
limit = { path = "10 %" }
lives_of = ["3"]
mean_life = true
)"));
  const QuantityGroup& group = study.quantity_groups.front();
  WeightedDraws one;
  one.values = Points(1, 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string& name = study.parameters[i].name;
    one.values(0, static_cast<Eigen::Index>(i)) = name == "rate"      ? 2e-5 / 3600
                                                  : name == "scatter" ? 0.2
                                                                      : 5e-3;
  }
  one.weights = Eigen::VectorXd::Ones(1);
  const auto found = group.from_draws(one);
  std::size_t means = 0;
  double median = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (group.requests[i].name == "remaining useful life") median = found[i].q50;
    if (group.requests[i].name != "mean remaining useful life") continue;
    ++means;
    EXPECT_TRUE(std::isnan(found[i].q05) && std::isnan(found[i].q50) && std::isnan(found[i].q95));
    EXPECT_FALSE(found[i].bound || found[i].upper_bound || found[i].predictive);
    EXPECT_FALSE(group.requests[i].safe_end || group.requests[i].credible_level);
    ASSERT_TRUE(found[i].mean);
    EXPECT_NEAR(*found[i].mean / median, 1, 0.1);
  }
  EXPECT_EQ(means, 1u);
}

// Of more units than are computed unasked a study is read, for questions on one of them; lives of all are refused.
TEST_F(FormulaLivesOfStudies, ManyUnitsNeedAChoice) {
  std::string rows = "depth,time,unit\n";
  for (int u = 0; u < 501; ++u)
    rows += fmt::format("{:.1f},1,u{}\n", 1 + 0.2 * (u % 5) + 0.1 * (u % 3), u);
  write("d.csv", rows);
  const std::string text =
      "model = \"formula\"\n[data]\nfile = \"d.csv\"\n" + formula_model::straight;
  const auto read = [&](const std::string& more) {
    return wearwell::read_posterior_study(write("s.toml", text + more));
  };
  const auto refusal = [](const auto& ask) {
    try {
      ask();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const PosteriorStudy all = read(""), some = read("lives_of = [\"u7\"]\n");
  const QuantityGroup& group = all.quantity_groups.front();
  EXPECT_EQ(group.requests.size(), 502u);  // --unit finds its name among them
  for (const std::string& why :
       {refusal([&] { group.from_draws({}); }), refusal([&] { group.lives({}); })}) {
    EXPECT_NE(why.find("predict.limit"), std::string::npos) << why;
    EXPECT_NE(why.find("lives_of = [\"u0\"] chooses some"), std::string::npos) << why;
  }
  EXPECT_EQ(refusal([&] { all.likelihood(all.data_rows); }), "accepted");
  EXPECT_EQ(some.quantity_groups.front().requests.size(), 1u);
}

TEST_F(FormulaLivesOfStudies, BLivesCountPointsByTheirWeight) {
  write("d.csv", "life,batch\n900,A\n1100,A\n1000,B\n1300,B\n");
  const PosteriorStudy study = wearwell::read_posterior_study(write("study.toml", R"(
model = "formula"
[data]
file = "d.csv"
[data.columns]
life = { column = "life", unit = "h" }
batch = "batch"
[likelihood.life]
family = "lognormal"
median = "m"
log_sd = "s"
[random_effects.batch]
m = { distribution = "lognormal", log_sd = "m_scatter" }
[prior]
m = { distribution = "lognormal", median = "1000 h", log_sd = 1 }
s = { distribution = "half-normal", scale = 1 }
m_scatter = { distribution = "half-normal", scale = 1 }
[predict]
b_lives = [1, 10]
credible_level = 0.9
)"));
  WeightedDraws draws;
  constexpr Eigen::Index n = 40'000;
  draws.values.resize(n, 3);
  draws.weights.setConstant(n, 1.0 / n);
  Rng rng(3, 0);
  for (Eigen::Index i = 0; i < n; ++i) {
    draws.values.row(i) << 3.6e6 * std::exp(0.15 * rng.normal()),
        0.3 * std::exp(0.2 * rng.normal()), 0.4 * std::exp(0.3 * rng.normal());
  }
  const std::vector<QuantityQuantiles> reported = study.quantity_groups.front().from_draws(draws);
  for (const std::size_t k : {1, 2}) {
    const double z = quantile(StandardDistribution::normal, k == 1 ? 0.01 : 0.1);
    std::vector<double> lives;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto x = draws.values.row(i);
      lives.push_back(x[0] * std::exp(z * std::hypot(x[1], x[2])));
    }
    std::sort(lives.begin(), lives.end());
    for (const auto& [life, p] :
         {std::pair(reported[k].q05, 0.05), std::pair(reported[k].q50, 0.5),
          std::pair(reported[k].q95, 0.95), std::pair(*reported[k].bound, 0.1)}) {
      const auto below = std::lower_bound(lives.begin(), lives.end(), life) - lives.begin();
      EXPECT_NEAR(double(below) / n, p, 0.01) << k << ' ' << p;
    }
  }
}

}  // namespace
}  // namespace wearwell
