#include "drift.h"

#include <wearwell/input/columns.h>
#include <wearwell/input/prior.h>
#include <wearwell/math/dual.h>
#include <wearwell/study/posterior_study.h>

#include <algorithm>
#include <cmath>

namespace drift {
namespace {

using namespace wearwell;

// The law, written once: the derivatives come of running it on dual numbers.
class Likelihood final : public LogDensity {
 public:
  Likelihood(std::vector<double> time, std::vector<double> depth)
      : time_(std::move(time)), observed_(ObservationFamily::normal, std::move(depth)) {}

  int dimension() const override { return 2; }
  double value(std::span<const double> x) const override { return formula(x.data()); }
  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    return wearwell::value_and_gradient<2>([this](const auto* p) { return formula(p); }, x,
                                           gradient);
  }
  std::vector<double> pointwise(std::span<const double> x) const override {
    return observed_.pointwise([&](std::size_t i) { return x[0] * time_[i]; }, x[1]);
  }

 private:
  template <class T>
  T formula(const T* x) const {
    return observed_.log_likelihood([&](std::size_t i) { return x[0] * time_[i]; }, x[1]);
  }

  std::vector<double> time_;
  Observations observed_;
};

std::vector<double> first(const std::vector<double>& all, std::size_t count) {
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)};
}

// The study's own keys. The ones that are asked for are the ones that may stand in the file.
void read(const TomlReader& root, const Source& source, PosteriorStudy& study) {
  const TomlReader data = root.required_table("data"), columns = data.required_table("columns");
  const Table table = read_table(data, source);
  const ColumnChoice time = required_column(columns, "time", "s", table);
  const ColumnChoice depth = required_column(columns, "depth", "m", table);
  const std::vector<double> t = si_numbers(table, time), y = si_numbers(table, depth);
  for (std::size_t i = 0; i < t.size(); ++i) require(t[i] > 0, table, time, i, "positive");

  study.equation = "depth = rate t; depth measured with normal scatter of standard deviation sigma";
  study.quantity = "worn depth";
  study.data_rows = t.size();
  study.observed = y;
  const double last = *std::max_element(t.begin(), t.end());
  const double most = std::abs(*std::max_element(y.begin(), y.end()));
  const TomlReader priors = root.required_table("prior");
  study.parameters = {read_prior(priors, {"rate", "m/s", 0, INFINITY, most / last}),
                      read_prior(priors, {"sigma", "m", 0, INFINITY, 0.1 * most})};
  study.meanings = {"wear rate", "scatter of one measurement"};
  study.likelihood = [t, y](std::size_t rows) {
    return std::make_shared<Likelihood>(first(t, rows), first(y, rows));
  };

  const Unit unit = depth.unit, hour = time.unit;
  const auto request = [=](double at, std::optional<double> measured) {
    PredictionRequest r;
    r.at_name = hour.text;
    r.at = from_si(hour, at);
    r.quantity = "depth";
    r.unit = unit;
    r.mean = [at](const double* x) { return x[0] * at; };
    r.sd = [](const double* x) { return x[1]; };
    r.measured = measured;
    return r;
  };
  study.stage_predictions = [=](std::size_t rows) {
    return std::vector{request(t[rows - 1], y[rows - 1])};
  };
  for (int i = 1; i <= 32; ++i) study.history.push_back(request(1.1 * last * i / 32, {}));
  if (const auto predict = root.table("predict")) {
    for (const Quantity& at : predict->quantities("time", "s"))
      study.predictions.push_back(request(at.si(), {}));
  }
}

// A real model carries its example with it; this one's are short enough to stand here.
std::string_view study_file() {
  return R"(# How fast does the diameter of a pin shrink?
model = "linear-drift"

[data]
file = "pin.csv"

[data.columns]
time  = { column = "t", unit = "h" }
depth = { column = "worn", unit = "um" }

[prior]
rate  = { distribution = "flat", unit = "um/h" }
sigma = { distribution = "flat", unit = "um" }

[predict]
time = ["2000 h", "5000 h"]
)";
}
std::string_view data_file() {
  return "t,worn\n100,2.9\n250,4.1\n400,9.4\n600,11.2\n850,18.3\n1000,19.6\n1200,25.1\n";
}

}  // namespace

Model model() {
  static constexpr ExampleFile example[] = {{"study.toml", study_file}, {"pin.csv", data_file}};
  return {.key = "linear-drift",
          .preset = "drift",
          .example = example,
          .read = [](const TomlReader& root, const Source& source) {
            return read_posterior_study(root, source, read);
          }};
}

}  // namespace drift
