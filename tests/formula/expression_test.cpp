// Values of expressions: precedence against Python's, functions against the C library, data and parameters.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "formula/laboratory.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell::formula {
namespace {

using testing::AllOf, testing::HasSubstr;

struct Computed {
  const char* text;
  double value;
};

// What Python 3 prints for these with ** for ^.
constexpr Computed by_python[] = {
    {"2 + 3*4", 14},
    {"(2 + 3)*4", 20},
    {"2 - 3 - 4", -5},
    {"2 - (3 - 4)", 3},
    {"24/4/3", 2},
    {"24/4*3", 18},
    {"24/(4*3)", 2},
    {"-2^2", -4},
    {"(-2)^2", 4},
    {"2^3^2", 512},
    {"(2^3)^2", 64},
    {"2^-1", 0.5},
    {"2^-1^2", 0.5},
    {"-2^-2", -0.25},
    {"2*-3", -6},
    {"--2", 2},
    {"-+-2", 2},
    {"2--3", 5},
    {"4*2^3", 32},
    {"4^3*2", 128},
    {"1 + 2 < 4", 1},
    {"1 < 2 and 3 < 2", 0},
    {"1 < 2 or 3 < 2 and 2 < 1", 1},
    {"not 1 < 2", 0},
    {"not 1 < 2 or 2 < 3", 1},
    {"3 >= 3", 1},
    {"3 > 3", 0},
    {"3 <= 3", 1},
    {"3 == 3", 1},
    {"3 != 3", 0},
    {"1.5e3", 1500},
    {".5 + 5.", 5.5},
    {"1e-3*1E3", 1},
    {"pow(2, 10)", 1024},
    {"min(3, 1, 2)", 1},
    {"max(3, 1, 2)", 3},
    {"abs(-3)", 3},
    {"where(1 < 2, 5, 6)", 5},
    {"where(1 > 2, 5, 6)", 6},
    {"2^0.5", 1.4142135623730951},
    {"27^(1/3)", 3.0},
    {"(1 < 2) + (3 < 4)", 2},
};

TEST(Expression, HasThePrecedenceOfPython) {
  const Laboratory laboratory;
  for (const Computed& each : by_python)
    EXPECT_DOUBLE_EQ(laboratory.value(each.text), each.value) << each.text;
}

TEST(Expression, FunctionsAreThoseOfTheLibrary) {
  Laboratory laboratory;
  laboratory.columns[0] = {0.25, 1.5, 3};
  const std::vector<std::pair<const char*, double (*)(double)>> all = {
      {"exp", std::exp},     {"log", std::log},     {"log10", std::log10}, {"sqrt", std::sqrt},
      {"abs", std::abs},     {"erf", std::erf},     {"tanh", std::tanh},   {"atan", std::atan},
      {"log1p", std::log1p}, {"expm1", std::expm1}, {"erfc", std::erfc},
  };
  for (const auto& [name, function] : all) {
    const auto values = laboratory.values(std::string(name) + "(x)");
    const auto moved = laboratory.values(std::string(name) + "(x*a/a)");
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = laboratory.columns[0][i];
      EXPECT_DOUBLE_EQ(values[i], function(x)) << name;
      // The last bit of the argument moves erfc by more of its own.
      EXPECT_NEAR(moved[i], function(x), 2e-14 * std::abs(function(x))) << name;
    }
  }
  EXPECT_DOUBLE_EQ(laboratory.values("sin(phi)")[1], std::sin(0.2));
  EXPECT_DOUBLE_EQ(laboratory.values("cos(phi)")[2], std::cos(0.3));
  EXPECT_DOUBLE_EQ(laboratory.value("sin(30 [deg])"), 0.5);
  EXPECT_DOUBLE_EQ(laboratory.value("pi"), std::numbers::pi);
}

// R 4.2.2: gamma, lgamma, digamma, qnorm
TEST(Expression, GammaFunctionsAndTheNormalQuantile) {
  const Laboratory laboratory;
  const auto value = [&](const char* text) { return laboratory.value(text); };
  EXPECT_NEAR(value("gamma(0.3)"), 2.99156898768759, 1e-13);
  EXPECT_NEAR(value("gamma(-1.5)"), 2.36327180120735, 1e-13);
  EXPECT_NEAR(value("lgamma(31.4)"), 76.0279562623688, 1e-12);
  EXPECT_NEAR(value("lgamma(-1.5)"), 0.860047015376481, 1e-13);
  EXPECT_NEAR(value("digamma(0.3)"), -3.50252422220013, 1e-13);
  EXPECT_NEAR(value("probit(1e-9)"), -5.99780701500769, 1e-12);
}

struct OfDistribution {
  const char* family;
  const char* parameters;
  double x, cdf, survival, pdf;
};

// Values of tests/golden/defined_functions.R.
constexpr OfDistribution by_r[] = {
    {"normal", "1.5, 2", -9, 7.60496051648871e-08, 0.999999923950395, 2.064235494315e-07},
    {"normal", "1.5, 2", 0.5, 0.308537538725987, 0.691462461274013, 0.17603266338215},
    {"normal", "1.5, 2", 4, 0.894350226333145, 0.105649773666855, 0.091324542694511},
    {"lognormal", "3, 0.7", 0.050000000000000003, 2.47173939002546e-09, 0.999999997528261,
     4.24521083002299e-07},
    {"lognormal", "3, 0.7", 2, 0.281215015716661, 0.718784984283339, 0.240949510934778},
    {"lognormal", "3, 0.7", 60, 0.999990639262372, 9.3607376278118e-06, 1.0013401865686e-06},
    {"weibull", "3, 1.8", 0.0001, 8.7333675796044e-09, 0.999999991266632, 0.000157200615746434},
    {"weibull", "3, 1.8", 2, 0.382445190358309, 0.617554809641691, 0.267888303289513},
    {"weibull", "3, 1.8", 9, 0.999271610085161, 0.000728389914839172, 0.00105247594405512},
    {"exponential", "3", 0.0001, 3.33327777839506e-05, 0.999966667222216, 0.333322222407405},
    {"exponential", "3", 2, 0.486582880967408, 0.513417119032592, 0.171139039677531},
    {"exponential", "3", 60, 0.999999997938846, 2.06115362243856e-09, 6.87051207479519e-10},
    {"loglogistic", "3, 1.8", 0.0001, 8.73336754146858e-09, 0.999999991266633,
     0.000157200614373544},
    {"loglogistic", "3, 1.8", 2, 0.325230454959938, 0.674769545040062, 0.197510045513841},
    {"loglogistic", "3, 1.8", 60, 0.995469210973219, 0.00453078902678115, 0.000135307829327279},
    {"smallest_extreme_value", "1.5, 2", -20, 2.1445178365464e-05, 0.999978554821635,
     1.07224742079913e-05},
    {"smallest_extreme_value", "1.5, 2", 1, 0.541043930692336, 0.458956069307664,
     0.178717673086091},
    {"smallest_extreme_value", "1.5, 2", 6, 0.999924224522717, 7.57754772826072e-05,
     0.000359468855665682},
    {"largest_extreme_value", "1.5, 2", -4, 1.60876011398878e-07, 0.999999839123989,
     1.25826211265455e-06},
    {"largest_extreme_value", "1.5, 2", 1, 0.276920334099909, 0.723079665900091, 0.177786373690972},
    {"largest_extreme_value", "1.5, 2", 20, 0.999903892966515, 9.61070334845312e-05,
     4.80512075278159e-05},
    {"log10_normal", "3, 0.3", 0.050000000000000003, 1.54099152834656e-09, 0.999999998459008,
     2.71597960115325e-07},
    {"log10_normal", "3, 0.3", 2, 0.278611637633296, 0.721388362366704, 0.243068312926076},
    {"log10_normal", "3, 0.3", 60, 0.999992770300673, 7.22969932737646e-06, 7.93259655703825e-07},
    {"birnbaum_saunders", "3, 0.7", 0.29999999999999999, 2.39354688226751e-05, 0.999976064531177,
     0.000850112927308329},
    {"birnbaum_saunders", "3, 0.7", 2, 0.279875349629308, 0.720124650370692, 0.245350421185244},
    {"birnbaum_saunders", "3, 0.7", 40, 0.999999300597737, 6.9940226277869e-07,
     2.45985697678546e-07},
    {"frechet", "3, 1.8", 0.5, 1.18608711084534e-11, 0.999999999988139, 1.07421531041627e-09},
    {"frechet", "3, 1.8", 2, 0.125588724654872, 0.874411275345128, 0.234507872109245},
    {"frechet", "3, 1.8", 900, 0.999965232441689, 3.47675583114564e-05, 6.95339078257929e-08},
    {"exponentiated_weibull", "3, 1.8, 1.4", 0.01, 5.72326517421931e-07, 0.999999427673483,
     0.000144223775163428},
    {"exponentiated_weibull", "3, 1.8, 1.4", 2, 0.260373562362039, 0.739626437637961,
     0.255334482016022},
    {"exponentiated_weibull", "3, 1.8, 1.4", 9, 0.998980402695396, 0.00101959730460436,
     0.00147303692462724},
    {"gamma", "2.3, 3", 0.01, 7.46312645264265e-07, 0.999999253687355, 0.000171478563384366},
    {"gamma", "2.3, 3", 2, 0.0931961821658509, 0.906803817834149, 0.0865898175279948},
    {"gamma", "2.3, 3", 90, 0.999999999993033, 6.96721126941364e-12, 2.22504239298043e-12},
    {"inverse_gaussian", "3, 7", 0.40000000000000002, 0.000257222814277652, 0.999742777185722,
     0.005835650231185},
    {"inverse_gaussian", "3, 7", 2, 0.363242168056027, 0.636757831943973, 0.307233057649684},
    {"inverse_gaussian", "3, 7", 15, 0.999065790450795, 0.000934209549204573, 0.000434466336068263},
    {"generalized_gamma", "3, 0.7, 0.6", 0.40000000000000002, 0.0215514028975657, 0.978448597102434,
     0.111987860336012},
    {"generalized_gamma", "3, 0.7, 0.6", 2, 0.366554510391573, 0.633445489608427, 0.23807104687875},
    {"generalized_gamma", "3, 0.7, 0.6", 30, 0.999999716512088, 2.83487911975069e-07,
     1.48232888659611e-07},
    {"generalized_gamma", "3, 0.7, -0.4", 0.40000000000000002, 0.00011951694769125,
     0.999880483052309, 0.00253125190099314},
    {"generalized_gamma", "3, 0.7, -0.4", 2, 0.231577859002523, 0.768422140997477,
     0.234515720256325},
    {"generalized_gamma", "3, 0.7, -0.4", 30, 0.994727951776369, 0.00527204822363078,
     0.000487126814461317},
    {"generalized_gamma", "3, 0.7, 2", 0.40000000000000002, 0.184948804419307, 0.815051195580693,
     0.330056986621824},
    {"generalized_gamma", "3, 0.7, 2", 2, 0.574990922377526, 0.425009077622473, 0.19281376300192},
    {"generalized_gamma", "3, 0.7, 2", 30, 1, 4.06098079627713e-81, 6.98749033255978e-80},
    {"generalized_gamma", "3, 0.7, 0", 0.40000000000000002, 0.00199828154378382, 0.998001718456216,
     0.0226258821884335},
    {"generalized_gamma", "3, 0.7, 0", 2, 0.281215015716661, 0.718784984283339, 0.240949510934778},
    {"generalized_gamma", "3, 0.7, 0", 30, 0.999498006845662, 0.00050199315433809,
     8.49403694403677e-05},
    {"student_t", "3.5, 1.5, 2", -90, 2.74128567751668e-06, 0.999997258714322, 1.0471468797043e-07},
    {"student_t", "3.5, 1.5, 2", 1, 0.408280399747538, 0.591719600252462, 0.1786288980757},
    {"student_t", "3.5, 1.5, 2", 40, 0.999943894227901, 5.61057720990893e-05, 5.06145985112686e-06},
};

TEST(Expression, FunctionsOfDistributionsAreThoseOfR) {
  const Laboratory laboratory;
  for (const OfDistribution& each : by_r) {
    const auto value = [&](const std::string& function, double x) {
      return laboratory.value(
          fmt::format("{}_{}({:.17g}, {})", each.family, function, x, each.parameters));
    };
    const std::string what = fmt::format("{} {}", each.family, each.x);
    EXPECT_NEAR(value("cdf", each.x), each.cdf, 1e-12 * each.cdf) << what;
    EXPECT_NEAR(value("survival", each.x), each.survival, 1e-12 * each.survival) << what;
    EXPECT_NEAR(value("pdf", each.x), each.pdf, 1e-12 * each.pdf) << what;
    if (each.cdf > 0 && each.cdf < 0.999) {
      EXPECT_NEAR(value("quantile", each.cdf), each.x, 1e-11 * std::abs(each.x)) << what;
    }
  }
}

// The form of R's pgamma loses all digits as lambda approaches 0: values beside those of the lognormal
// distribution, to the first order in lambda.
TEST(Expression, GeneralizedGammaKeepsItsDigitsNearTheLognormal) {
  const Laboratory laboratory;
  const auto value = [&](const char* function, double x, double lambda) {
    return laboratory.value(
        fmt::format("generalized_gamma_{}({:.17g}, 3, 0.7, {:.17g})", function, x, lambda));
  };
  for (const double x : {0.3, 2.0, 20.0})
    for (const char* function : {"cdf", "survival", "pdf"}) {
      const double middle = value(function, x, 0);
      EXPECT_NEAR(0.5 * (value(function, x, 1e-7) + value(function, x, -1e-7)), middle,
                  1e-12 * middle)
          << function << x;
    }
}

TEST(Expression, FunctionsOfDistributionsAtTheEnds) {
  const Laboratory laboratory;
  const auto value = [&](const char* text) { return laboratory.value(text); };
  for (const std::string family : {"gamma", "inverse_gaussian"}) {
    EXPECT_EQ(value((family + "_cdf(-1, 2, 3)").c_str()), 0);
    EXPECT_EQ(value((family + "_cdf(0, 2, 3)").c_str()), 0);
    EXPECT_EQ(value((family + "_survival(0, 2, 3)").c_str()), 1);
    EXPECT_EQ(value((family + "_quantile(0, 2, 3)").c_str()), 0);
    EXPECT_THROW(value((family + "_quantile(1, 2, 3)").c_str()), InputError);
  }
  Laboratory below;
  below.columns[0] = {-1, 0, 1e300};
  for (const std::string family : {"gamma", "inverse_gaussian", "birnbaum_saunders", "frechet"}) {
    EXPECT_THAT(below.values(family + "_cdf(x, 2, 3)"), ::testing::ElementsAre(0, 0, 1));
    EXPECT_THAT(below.values(family + "_survival(x, 2, 3)")[1], 1);
  }
  for (const std::string family : {"generalized_gamma", "exponentiated_weibull"})
    EXPECT_THAT(below.values(family + "_cdf(x, 2, 3, 0.4)"), ::testing::ElementsAre(0, 0, 1));
  for (const char* text :
       {"gamma_cdf(1, -2, 3)", "gamma_quantile(0.1, 0, 1)", "inverse_gaussian_cdf(1, 2, -3)",
        "student_t_cdf(0, -1, 0, 1)", "generalized_gamma_quantile(1.5, 1, 1, 1)"})
    EXPECT_THROW(value(text), InputError) << text;
  EXPECT_EQ(value("student_t_quantile(0.5, 3, 1.5, 2)"), 1.5);
}

TEST(Expression, FunctionsOfDistributionsHaveUnits) {
  Laboratory laboratory;
  EXPECT_DOUBLE_EQ(laboratory.value("weibull_cdf(2 [h], 7200 [s], 3)"), 1 - std::exp(-1));
  EXPECT_DOUBLE_EQ(laboratory.value("weibull_quantile(0.1, 2 [h], 3) / 1 [s]"),
                   7200 * std::pow(-std::log1p(-0.1), 1 / 3.0));
  laboratory.columns[0] = {-1, 0, 3};
  const auto below = laboratory.values("lognormal_cdf(x * 1 [h], 1 [h], 0.5)");
  EXPECT_EQ(below[0], 0);
  EXPECT_EQ(below[1], 0);
  const auto message = [&](const char* text) {
    return message_of<InputError>([&] { laboratory.value(text); });
  };
  EXPECT_THAT(
      message("weibull_cdf(2 [h], 3 [m], 1)"),
      AllOf(HasSubstr("'2 [h]' is s, but '3 [m]' is m"), HasSubstr("arguments of weibull_cdf")));
  EXPECT_THAT(message("weibull_cdf(2 [h], 3 [h], 1 [h])"), HasSubstr("shape of weibull_cdf"));
  EXPECT_THAT(message("weibull_cdf(2, 3)"), AllOf(HasSubstr("needs 3 arguments, but has 2"),
                                                  HasSubstr("weibull_cdf(x, scale, shape)")));
  EXPECT_THAT(message("gamma_cdf(2 [h], 3, 1 [m])"), HasSubstr("arguments of gamma_cdf"));
  EXPECT_THAT(message("gamma_cdf(2 [h], 3 [h], 1 [h])"), HasSubstr("shape of gamma_cdf"));
  EXPECT_THAT(message("gamma_cdf(2 [h], 3)"), HasSubstr("gamma_cdf(x, shape, scale)"));
  EXPECT_DOUBLE_EQ(laboratory.value("inverse_gaussian_cdf(2 [h], 1 [h], 3600 [s])"),
                   laboratory.value("inverse_gaussian_cdf(2, 1, 1)"));
  EXPECT_DOUBLE_EQ(laboratory.value("student_t_quantile(0.1, 3, 0 [h], 2 [h]) / 7200 [s]"),
                   laboratory.value("student_t_quantile(0.1, 3, 0, 1)"));
  EXPECT_THAT(message("weibull_quantile(2, 3, 1)"), HasSubstr("is not a finite number"));
  EXPECT_THAT(message("weibul_cdf(2, 3, 1)"), HasSubstr("did you mean 'weibull_cdf'?"));
}

struct OfRelation {
  const char* text;
  double ratio;
};

// Values of tests/golden/defined_functions.R.
constexpr OfRelation relations_by_r[] = {
    {"arrhenius(313.15 [K], 353.15 [K], 0.7 [eV])", 18.8808271117541},
    {"eyring(313.15 [K], 353.15 [K], 0.7 [eV])", 21.2925565847547},
    {"inverse_power(24 [kV], 30000 [V], 15.5)", 31.7764371615651},
    {"voltage_temperature(12 [V], 24 [V], 3, 313.15 [K], 353.15 [K], 0.7 [eV])", 151.046616894032},
    {"peck(40 [%], 0.85, 2.66, 303.15 [K], 358.15 [K], 0.79 [eV])", 772.055172020071},
    {"coffin_manson(35 [K], 140 [K], 2)", 16},
    {"norris_landzberg(35 [K], 100 [K], 1.9, 2 [1/day], 48 [1/day], 1/3, 333.15 [K], 373.15 [K], "
     "0.122 [eV])",
     4.0182551756436},
};

TEST(Expression, RelationsBetweenLifeAndStressAreTheirFormulas) {
  const Laboratory laboratory;
  for (const OfRelation& each : relations_by_r)
    EXPECT_NEAR(laboratory.value(each.text), each.ratio, 1e-12 * each.ratio) << each.text;
  EXPECT_EQ(laboratory.value("arrhenius(353.15 [K], 353.15 [K], 0.7 [eV])"), 1);
  const auto message = [&](const char* text) {
    return message_of<InputError>([&] { laboratory.value(text); });
  };
  EXPECT_THAT(message("arrhenius(40, 353.15 [K], 0.7 [eV])"),
              HasSubstr("temperature of arrhenius needs K, but '40' is a pure number"));
  EXPECT_THAT(message("arrhenius(313 [K], 353 [K], 68 [kJ/mol])"),
              AllOf(HasSubstr("energy of arrhenius needs"), HasSubstr("6.02214076e23 [1/mol]")));
  EXPECT_THAT(message("inverse_power(24 [kV], 30 [mm], 2)"),
              HasSubstr("arguments of inverse_power"));
  EXPECT_THAT(message("peck(40, 85 [m], 2, 300 [K], 350 [K], 0.7 [eV])"),
              HasSubstr("reference_humidity of peck"));
}

// A parameter may be named gamma, but not where the function is called.
TEST(Expression, AFunctionMayHaveTheNameOfAParameter) {
  Laboratory laboratory;
  laboratory.lines.push_back({"gamma", "2 * a"});
  EXPECT_DOUBLE_EQ(laboratory.value("gamma + 1"), 2.4);
  EXPECT_THAT(message_of<InputError>([&] { laboratory.value("gamma(3)"); }),
              AllOf(HasSubstr("'gamma' is a function, but this study uses the name itself"),
                    HasSubstr("write a product as gamma * (...)")));
}

// exp and log are our own: bounds, and within an ulp of the library's over the whole range.
TEST(Expression, ExponentialAndLogarithmAreGoodToAnUlp) {
  Laboratory laboratory;
  std::vector<double>& x = laboratory.columns[0];
  x.clear();
  for (double at = -760; at < 720; at += 0.173) x.push_back(at);
  const double infinity = INFINITY;
  x.insert(x.end(), {0.0, -0.0, infinity, -infinity, NAN, 709.78271289338397, 709.7827128933841,
                     -745.13, -745.14, 1e300, -1e300, 5e-324});
  for (auto& column : laboratory.columns) column.resize(x.size(), 1.0);
  for (auto& label : laboratory.labels) label.resize(x.size());
  const auto exponentials = laboratory.values("exp(x)");
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double wanted = std::exp(x[i]);
    if (std::isnan(wanted)) {
      EXPECT_TRUE(std::isnan(exponentials[i]));
    } else if (std::isinf(wanted)) {
      EXPECT_EQ(exponentials[i], wanted) << x[i];
    } else if (wanted < 1e-300) {
      EXPECT_NEAR(exponentials[i] / 4.9e-324, wanted / 4.9e-324, 1 + 1e-15 * wanted / 4.9e-324)
          << x[i];
    } else {
      EXPECT_NEAR(exponentials[i] / wanted, 1, 2.3e-16) << x[i];
    }
  }
  for (std::size_t i = 0; i + 12 < x.size(); ++i) x[i] = std::exp(x[i]);
  const auto logarithms = laboratory.values("log(x)");
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double wanted = std::log(x[i]);
    if (std::isnan(wanted)) {
      EXPECT_TRUE(std::isnan(logarithms[i])) << x[i];
    } else if (std::isinf(wanted) || wanted == 0) {
      EXPECT_EQ(logarithms[i], wanted) << x[i];
    } else {
      EXPECT_NEAR(logarithms[i] / wanted, 1, 2.3e-16) << x[i];
    }
  }
}

TEST(Expression, UnitsAreConverted) {
  const Laboratory laboratory;
  EXPECT_DOUBLE_EQ(laboratory.value("9.81 [m/s^2] / 1 [mm/s^2]"), 9810);
  EXPECT_DOUBLE_EQ(laboratory.values("force / 1 [kN]")[1], 0.02);
  EXPECT_DOUBLE_EQ(laboratory.values("(force/1 [kN])^b")[1], std::pow(0.02, 1.9));
  EXPECT_DOUBLE_EQ(laboratory.value("2 [krev] / 1 [cycle]"), 2000);
  EXPECT_DOUBLE_EQ(laboratory.value("3 [MPa sqrt(m)] / (1 [MPa] * sqrt(1 [m]))"), 3);
  EXPECT_DOUBLE_EQ(laboratory.value("3 [MPa m^0.5] / 1 [Pa] / sqrt(1 [mm])"), 3e6 * std::sqrt(1e3));
  EXPECT_DOUBLE_EQ(laboratory.value("5 [%]"), 0.05);
  EXPECT_DOUBLE_EQ(laboratory.value("2 [mm]^2 / 1 [m^2]"), 4e-6);
}

TEST(Expression, ZeroFitsAnyDimension) {
  const Laboratory laboratory;
  EXPECT_EQ(laboratory.values("max(force - 15 [N], 0)"), (std::vector<double>{0, 5, 15}));
  EXPECT_EQ(laboratory.values("where(force > 0, force, 0)")[2], 30);
  EXPECT_EQ(laboratory.values("0 + force")[2], 30);
}

TEST(Expression, LabelsPickAndIndicate) {
  const Laboratory laboratory;
  EXPECT_EQ(laboratory.values("q[material]"), (std::vector<double>{2.5, -1.5, 2.5}));
  EXPECT_EQ(laboratory.value("q[\"PEEK\"]"), -1.5);
  EXPECT_EQ(laboratory.values("material == \"PTFE\""), (std::vector<double>{1, 0, 1}));
  EXPECT_EQ(laboratory.values("\"PTFE\" != material"), (std::vector<double>{0, 1, 0}));
  EXPECT_EQ(laboratory.values("b * (machine == '2')"), (std::vector<double>{0, 1.9, 0}));
  EXPECT_EQ(laboratory.values("where(material == \"PTFE\" and x < 3, a, b)"),
            (std::vector<double>{0.7, 1.9, 1.9}));
}

TEST(Expression, RunningSumsBeginAnewWithEachPath) {
  Laboratory laboratory;
  EXPECT_EQ(laboratory.values("cum(force)/1 [N]"), (std::vector<double>{10, 30, 60}));
  EXPECT_EQ(laboratory.values("cum(a*x)"), (std::vector<double>{0.7 * 1.5, 0.7 * 1.5 + 0.7 * 2,
                                                                0.7 * 1.5 + 0.7 * 2 + 0.7 * 3.25}));
  EXPECT_EQ(laboratory.values("cum(1)"), (std::vector<double>{1, 2, 3}));
  laboratory.paths = {0, 2};
  EXPECT_EQ(laboratory.values("cum(force)/1 [N]"), (std::vector<double>{10, 30, 30}));
  EXPECT_EQ(laboratory.values("cum(b)"), (std::vector<double>{1.9, 3.8, 1.9}));
}

TEST(Distribution, LinesStandInAnyOrder) {
  Laboratory laboratory;
  laboratory.lines = {{"wear", "k * work / area"}, {"work", "force * distance"}};
  const Program program = laboratory.program({"wear", "log(wear/1 [um]) + a"});
  EXPECT_EQ(program.outputs()[0].powers, read_any_unit("m").powers);
  EXPECT_EQ(program.text(0), "k * (force * distance) / 5e-05 [m^2]");
}

}  // namespace
}  // namespace wearwell::formula
