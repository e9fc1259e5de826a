// Published figures of other programs and of books, from the file of a study to its classical estimates.
#include <gtest/gtest.h>

#include <cmath>

#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

using Json = nlohmann::ordered_json;

class PublishedPrograms : public ScratchTest {
 protected:
  Json maximum(const std::string& rows, const std::string& text) const {
    write("d.csv", rows);
    const std::filesystem::path file =
        write("study.toml", "model = \"formula\"\n[data]\nfile = \"d.csv\"\n" + text);
    const PosteriorSummary result =
        run_study(read_posterior_study(file), {Method::exact, 1, {}, 50, {}}, {}, false);
    return read_posterior_study(file)
        .addition(*result.fit)
        .body.at("classical")
        .at("maximum_likelihood");
  }
};

const Json& entry_of(const Json& list, const std::string& name) {
  for (const Json& each : list) {
    if (each.at("name") == name) return each;
  }
  throw std::logic_error("no " + name);
}

double value_of(const Json& of) {
  return of.at("value").get<double>();
}

double normal_end(const Json& of, const char* end) {
  return of.at("normal").at(end).get<double>();
}

// ALTA, Time-Varying Stress Example (ReliaSoft): eleven components under 2 V until 250 h, 3 V until 350 h, 4 V until 370 h,
// 5 V until 380 h and 6 V until 390 h. At 2 V the B10 life is 507.9438 h; with 90 % confidence at least 300.4821 h.
TEST_F(PublishedPrograms, AltasStepStressTest) {
  std::string rows = "specimen,V,hours,status\n";
  int specimen = 0;
  for (const double life : {280, 310, 330, 352, 360, 366, 371, 374, 378, 381, 385}) {
    ++specimen;
    double volt = 2;
    for (const double end : {250, 350, 370, 380, 390}) {
      const bool failed = life <= end;
      rows += fmt::format("{},{},{},{}\n", specimen, volt, failed ? life : end,
                          failed ? "failure" : "runout");
      if (failed) break;
      ++volt;
    }
  }
  const Json found = maximum(rows, R"toml([data.columns]
specimen = "specimen"
life = { column = "hours", unit = "h" }
voltage = { column = "V", unit = "V" }
status = "status"
[constants]
reference = "2 V"
[likelihood.life]
family = "weibull"
scale = "eta * inverse_power(voltage, reference, n)"
shape = "beta"
steps = "specimen"
[prior]
eta = { distribution = "lognormal", median = "1000 h", log_sd = 1 }
n = { distribution = "normal", mean = 4, sd = 2 }
beta = { distribution = "lognormal", median = 2, log_sd = 0.5 }
[predict]
given = { voltage = "2 V" }
b_lives = [10]
level = 0.9
sides = "lower"
classical = true
)toml");
  const Json& b10 = entry_of(found.at("quantities"), "B10 life");
  EXPECT_NEAR(value_of(b10), 507.9438, 0.01);
  EXPECT_NEAR(normal_end(b10, "lower"), 300.4821, 0.05);
}

// ALTA, temperature-humidity relation A exp(phi/T + b/U) with a Weibull distribution (ReliaSoft): beta 5.874395, A 0.000060,
// b 0.280599, phi 5630.329851.
TEST_F(PublishedPrograms, AltasTemperatureAndHumidity) {
  const Json found = maximum(
      "hours,kelvin,humidity\n310,378,0.4\n316,378,0.4\n329,378,0.4\n411,378,0.4\n190,378,0.8\n"
      "208,378,0.8\n230,378,0.8\n298,378,0.8\n108,398,0.4\n123,398,0.4\n166,398,0.4\n200,398,0.4\n",
      R"toml([data.columns]
life = { column = "hours", unit = "h" }
temperature = { column = "kelvin", unit = "K" }
humidity = "humidity"
[constants]
tested = "378 K"
[likelihood.life]
family = "weibull"
scale = "eta * exp(phi * (1/temperature - 1/tested) + b * (1/humidity - 1/0.4))"
shape = "beta"
[prior]
eta = { distribution = "lognormal", median = "300 h", log_sd = 1 }
phi = { distribution = "lognormal", median = "5000 K", log_sd = 0.5 }
b = { distribution = "normal", mean = 0.3, sd = 0.3 }
beta = { distribution = "lognormal", median = 3, log_sd = 0.7 }
[predict]
given = { temperature = "350 K", humidity = 0.4 }
classical = true
)toml");
  const auto parameter = [&](const char* name) {
    return value_of(entry_of(found.at("parameters"), name));
  };
  EXPECT_NEAR(parameter("beta"), 5.874395, 1e-4);
  EXPECT_NEAR(parameter("b"), 0.280599, 1e-5);
  EXPECT_NEAR(parameter("phi"), 5630.329851, 0.1);
  EXPECT_NEAR(parameter("eta") * std::exp(-parameter("phi") / 378 - parameter("b") / 0.4),
              0.0000597, 5e-8);
}

// Meeker and Escobar (1998), example 19.10, Mylar-polyurethane insulation: the log-likelihood is -271.4, sigma 1.05 with 0.83 to
// 1.32, and the exponent 4.29 with 3.11 to 5.46 (95 %).
TEST_F(PublishedPrograms, MylarPolyurethane) {
  std::string rows = "minutes,voltage\n";
  const auto add = [&](double voltage, const std::vector<double>& lives) {
    for (const double life : lives) rows += fmt::format("{},{}\n", life, voltage);
  };
  add(219, {15, 16, 36, 50, 55, 95, 122, 129, 625, 700});
  add(157.1, {49, 99, 154.5, 180, 291, 447, 510, 600, 1656, 1721});
  add(122.4, {188, 297, 405, 744, 1218, 1340, 1715, 3382});
  add(100.3, {606, 1012, 2520, 2610, 3988, 4100, 5025, 6842});
  const Json found = maximum(rows, R"toml([data.columns]
life = { column = "minutes", unit = "min" }
voltage = { column = "voltage", unit = "kV/mm" }
[constants]
reference = "150 kV/mm"
[likelihood.life]
family = "lognormal"
median = "middle * inverse_power(voltage, reference, n)"
log_sd = "sigma"
[prior]
middle = { distribution = "lognormal", median = "500 min", log_sd = 1 }
n = { distribution = "normal", mean = 5, sd = 3 }
sigma = { distribution = "lognormal", median = 1, log_sd = 0.5 }
[predict]
given = { voltage = "50 kV/mm" }
level = 0.95
sides = "both"
classical = true
)toml");
  EXPECT_NEAR(found.at("log_likelihood").get<double>(), -271.4, 0.05);
  const Json &n = entry_of(found.at("parameters"), "n"),
             &sigma = entry_of(found.at("parameters"), "sigma");
  EXPECT_NEAR(value_of(n), 4.29, 0.005);
  EXPECT_NEAR(normal_end(n, "lower"), 3.11, 0.006);
  EXPECT_NEAR(normal_end(n, "upper"), 5.46, 0.006);
  EXPECT_NEAR(value_of(sigma), 1.05, 0.005);
  EXPECT_NEAR(normal_end(sigma, "lower"), 0.83, 0.005);
  EXPECT_NEAR(normal_end(sigma, "upper"), 1.32, 0.005);
}

}  // namespace
}  // namespace wearwell
