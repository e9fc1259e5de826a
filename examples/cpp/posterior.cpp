// A posterior of one's own: the half-life of an additive from five concentrations, c = c0 exp(-t/tau) with normal scatter of
// 2 %. The engine alone: no study file, nothing on the disk.
#include <wearwell/infer/fit.h>
#include <wearwell/infer/trust.h>
#include <wearwell/math/dual.h>

#include <cmath>
#include <cstdio>

namespace {

class Decay final : public wearwell::LogDensity {
 public:
  int dimension() const override { return 2; }
  double value(std::span<const double> x) const override { return formula(x.data()); }
  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    return wearwell::value_and_gradient<2>([this](const auto* p) { return formula(p); }, x,
                                           gradient);
  }

 private:
  template <class T>
  T formula(const T* x) const {
    using std::exp;
    constexpr double sd = 0.02;
    T sum(0);
    for (int i = 0; i < 5; ++i) {
      const T z = (measured[i] - x[0] * exp(-time[i] / x[1])) / sd;
      sum -= 0.5 * z * z;
    }
    return sum;
  }

  static constexpr double time[] = {0, 100, 200, 400, 800};  // h
  static constexpr double measured[] = {1.01, 0.81, 0.69, 0.44, 0.21};
};

}  // namespace

int main() {
  using namespace wearwell;
  const auto positive = [](const char* name, double start) {
    Parameter parameter;
    parameter.name = name;
    parameter.si = "1";
    parameter.unit = read_unit("1", "1");
    parameter.distribution = "flat";
    parameter.prior = make_distribution(Flat{}, 0, INFINITY);
    parameter.start = start;
    parameter.scale = start;
    parameter.natural_lower = 0;
    return parameter;
  };
  const Posterior posterior({positive("c0", 1), positive("tau", 500)}, std::make_shared<Decay>());
  FitSettings settings;
  settings.method = Method::exact;
  settings.run.draws = 1000;
  const Fit result = fit(posterior, settings);
  if (!result.exact) return 1;
  std::printf("c0 %.4f +- %.4f, tau %.1f +- %.1f h\n", result.exact->mean[0], result.exact->sd[0],
              result.exact->mean[1], result.exact->sd[1]);
  for (const Check& check : trust_checks(posterior, result))
    if (check.verdict == Verdict::fail) return 1;
}
