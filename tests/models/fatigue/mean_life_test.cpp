// Means of S-N lives and of lives of bearings, and how much of a mean comes from lives beyond those seen.
#include "wearwell/models/fatigue/mean_life.h"

#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/bearing/bearing_study.h"
#include "wearwell/models/fatigue/sn_study.h"
#include "wearwell/prob/standard_distribution.h"

namespace wearwell {
namespace {

using fatigue::LifeFamily;

// Integrals of the life over its distribution.
TEST(MeanLife, IsTheIntegralOfLives) {
  using Rule = boost::math::quadrature::gauss_kronrod<double, 61>;
  for (const LifeFamily family :
       {LifeFamily::log10_normal, LifeFamily::weibull, LifeFamily::normal}) {
    const bool logarithmic = family != LifeFamily::normal;
    const double center = logarithmic ? 5.2 : 2e5, sigma = logarithmic ? 0.25 : 3e4;
    const StandardDistribution standard = family == LifeFamily::weibull
                                              ? StandardDistribution::smallest_extreme_value
                                              : StandardDistribution::normal;
    const auto life = [&](double z) {
      return logarithmic ? std::pow(10, center + sigma * z) : center + sigma * z;
    };
    const auto integral = [&](double from) {
      return Rule::integrate([&](double z) { return life(z) * std::exp(log_density(standard, z)); },
                             from, 12.0, 15, 1e-12);
    };
    const double low = logarithmic ? -40 : -12, mean = integral(low);
    EXPECT_NEAR(fatigue::mean_life(family, center, sigma), mean, 1e-9 * mean);
    for (const double z : {-1.5, 0.0, 0.8, 2.0})
      EXPECT_NEAR(fatigue::share_of_mean_beyond(family, center, sigma, life(z)), integral(z) / mean,
                  1e-9);
  }
  EXPECT_EQ(fatigue::mean_life(LifeFamily::weibull, INFINITY, 0.1), INFINITY);
}

class MeanLifeTest : public ScratchTest {
 protected:
  static WeightedDraws draws(const std::vector<std::vector<double>>& points) {
    const auto count = static_cast<Eigen::Index>(points.size());
    WeightedDraws all{Points(count, static_cast<Eigen::Index>(points.front().size())),
                      Eigen::VectorXd::Constant(count, 1.0 / static_cast<double>(count)),
                      {},
                      {}};
    for (Eigen::Index i = 0; i < count; ++i) {
      for (Eigen::Index p = 0; p < all.values.cols(); ++p)
        all.values(i, p) = points[static_cast<std::size_t>(i)][static_cast<std::size_t>(p)];
    }
    return all;
  }
  // The quantity of this name at these draws.
  static double median(const PosteriorStudy& study, const std::string& name,
                       const WeightedDraws& draws) {
    for (const QuantityGroup& group : study.quantity_groups) {
      for (std::size_t i = 0; i < group.requests.size(); ++i) {
        if (group.requests[i].name == name) return group.from_draws(draws)[i].q50;
      }
    }
    ADD_FAILURE() << name;
    return NAN;
  }
  void sn(const std::string& law, const std::string& predict, PosteriorStudy& study) {
    write("d.csv", "stress,life,status\n300,1e5,failed\n250,4e5,failed\n250,9e5,runout\n");
    const Source source = source_of(write(
        "study.toml",
        "model = \"sn\"\n[data]\nfile = \"d.csv\"\n[data.columns]\nalternating_stress = { column "
        "= \"stress\", unit = \"MPa\" }\nlife = { column = \"life\", unit = \"cycles\" }\nstatus = "
        "\"status\"\n[law]\nmean_stress = \"none\"\n" +
            law +
            "[likelihood]\nfamily = \"log10-normal\"\n[prior]\nlog10_a = { distribution = "
            "\"normal\", mean = \"3.5 log10(MPa)\", sd = 0.5 }\nb = { distribution = \"normal\", "
            "mean = -0.2, sd = 0.1 }\nsigma = { distribution = \"half-normal\", scale = 0.3 }\n"
            "[predict]\n" +
            predict));
    read_sn_study(TomlReader::parse(source.study), source, study);
  }
};

TEST_F(MeanLifeTest, OfSpecimens) {
  PosteriorStudy study;
  sn("",
     "mean_life = true\nstress = { bar = { alternating_stress = \"280 MPa\" } "
     "}\n",
     study);
  // log10 N = (log10 S/Pa - log10 a)/b.
  const double log10_a = 9.5, b = -0.2, sigma = 0.3, s = sigma * std::log(10.0),
               center = (std::log10(280e6) - log10_a) / b,
               expected = std::pow(10, center) * std::exp(0.5 * s * s);
  EXPECT_NEAR(median(study, "mean life", draws(std::vector(9, std::vector{log10_a, b, sigma}))),
              expected, 1e-9 * expected);
}

TEST_F(MeanLifeTest, OfBearings) {
  write("d.csv",
        "bearing,clearance,revolutions,depth\nA,25,50000,16\nA,25,100000,31\nB,30,50000,13\n"
        "B,30,100000,24\n");
  const Source source = source_of(write("study.toml", R"toml(
model = "bearing-wear"
[data]
file = "d.csv"
[data.columns]
bearing = "bearing"
clearance = { column = "clearance", unit = "um" }
revolutions = "revolutions"
depth = { column = "depth", unit = "um" }
[conditions]
contact = "stationary"
radius = "10 mm"
length = "20 mm"
force = "400 N"
[likelihood]
family = "normal"
depth_error = "2 um"
[prior]
k = { distribution = "lognormal", median = "1e-6 mm^3/(N m)", log_sd = 2.5 }
k_scatter = { distribution = "half-normal", scale = 1 }
[predict]
clearance = "30 um"
pressure = "1.5 MPa"
limit = "80 um"
mean_life = true
b_lives = [50]
)toml"));
  PosteriorStudy study;
  read_bearing_study(TomlReader::parse(source.study), source, study);
  const WeightedDraws all = draws(std::vector(9, std::vector{2e-15, 0.4}));
  // Lives are lognormal about the median, B50.
  const double middle = median(study, "B50 life", all);
  EXPECT_NEAR(median(study, "mean life", all), middle * std::exp(0.5 * 0.4 * 0.4), 1e-6 * middle);
}

TEST_F(MeanLifeTest, Refusals) {
  PosteriorStudy study;
  EXPECT_NE(message_of<InputError>([&] { sn("", "mean_life = true\n", study); }).find("stress"),
            std::string::npos);
}

}  // namespace
}  // namespace wearwell
