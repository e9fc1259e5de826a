// Gradients per second of two log-likelihoods written in the language of laws, beside the same by hand in C++. The peer is
// peers/formula.R (rstan's grad_log_prob of the same models). The counter `gradients` is what is compared:
//   weibull: 1000 rows, t ~ Weibull(shape m, scale exp(b0 + b1 x1 + b2 x2)), four parameters
//   hierarchy: 50 machines x 20 readings, y ~ normal(exp(mu + tau z[machine]) x, sigma), 53 parameters
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "wearwell/base/rng.h"
#include "wearwell/formula/program.h"
#include "wearwell/models/fatigue/sn_likelihood.h"

namespace wearwell::formula {
namespace {

constexpr std::size_t rows = 1000, machines = 50;

struct Regression {
  std::vector<double> t, x1, x2;
  std::vector<double> parameters = {2, 1, 0.5, -0.3};  // m, b0, b1, b2

  Regression() {
    Rng rng(1, 0);
    for (std::size_t i = 0; i < rows; ++i) {
      x1.push_back(2 * rng.uniform() - 1);
      x2.push_back(2 * rng.uniform() - 1);
      t.push_back(std::exp(1 + 0.5 * x1[i] - 0.3 * x2[i]) * std::sqrt(-std::log(rng.uniform())));
    }
  }
};

struct Hierarchy {
  std::vector<double> y, x;
  std::vector<int> machine;
  std::vector<double> parameters = {0.2, 0.4, 0.1};  // mu, tau, sigma, then z

  Hierarchy() {
    Rng rng(2, 0);
    for (std::size_t j = 0; j < machines; ++j) parameters.push_back(3 * rng.uniform() - 1.5);
    for (std::size_t i = 0; i < rows; ++i) {
      machine.push_back(static_cast<int>(i / (rows / machines)));
      x.push_back(0.1 + rng.uniform());
      const double z = parameters[3 + static_cast<std::size_t>(machine[i])];
      y.push_back(std::exp(0.2 + 0.4 * z) * x[i] + 0.2 * (rng.uniform() - 0.5));
    }
  }
};

// The sum of an output over all rows, and its gradient, as a study's likelihood takes them.
double value_and_gradient(const Program& program, const Data& data, Workspace& work,
                          std::span<const double> parameters, std::span<double> gradient) {
  program.forward(data, 0, data.rows(), {parameters}, work);
  const auto values = work.values(0);
  double sum = 0;
  for (const double each : values) sum += each;
  for (double& each : work.adjoints(0)) each = 1;
  std::fill(gradient.begin(), gradient.end(), 0.0);
  program.reverse(data, 0, data.rows(), {parameters}, work, gradient);
  return sum;
}

void run(benchmark::State& state, const Program& program, const Rows& at,
         std::vector<double> parameters) {
  const Data data = program.bind(at);
  Workspace work = program.workspace(at.count);
  std::vector<double> gradient(parameters.size());
  for (auto _ : state) {
    parameters[0] = -parameters[0] + 4;  // another place each time
    benchmark::DoNotOptimize(value_and_gradient(program, data, work, parameters, gradient));
    benchmark::ClobberMemory();
  }
  state.counters["gradients"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void weibull_language(benchmark::State& state) {
  const Regression all;
  Symbols symbols;
  symbols.columns = {{"t", {}}, {"x1", {}}, {"x2", {}}};
  symbols.parameters = {{"m", {}}, {"b0", {}}, {"b1", {}}, {"b2", {}}};
  const Program program = compile({{"z", "m * (log(t) - (b0 + b1*x1 + b2*x2))"}},
                                  {{"log-likelihood", "log(m) + z - log(t) - exp(z)"}}, symbols);
  Rows at;
  at.count = rows;
  at.columns = {all.t, all.x1, all.x2};
  run(state, program, at, all.parameters);
}
BENCHMARK(weibull_language);

// By hand, as one writes it: one pass, the derivatives of z known.
double weibull_hand(const Regression& all, std::span<const double> p, std::span<double> gradient) {
  double sum = 0, by_m = 0, by_b0 = 0, by_b1 = 0, by_b2 = 0;
  const double log_m = std::log(p[0]);
  for (std::size_t i = 0; i < rows; ++i) {
    const double log_t = std::log(all.t[i]);
    const double w = log_t - (p[1] + p[2] * all.x1[i] + p[3] * all.x2[i]);
    const double z = p[0] * w, e = std::exp(z);
    sum += log_m + z - log_t - e;
    by_m += 1 / p[0] + w * (1 - e);
    const double slope = -p[0] * (1 - e);
    by_b0 += slope;
    by_b1 += slope * all.x1[i];
    by_b2 += slope * all.x2[i];
  }
  gradient[0] = by_m;
  gradient[1] = by_b0;
  gradient[2] = by_b1;
  gradient[3] = by_b2;
  return sum;
}

template <class F>
void run_hand(benchmark::State& state, std::vector<double> parameters, const F& likelihood) {
  std::vector<double> gradient(parameters.size());
  for (auto _ : state) {
    parameters[0] = -parameters[0] + 4;
    benchmark::DoNotOptimize(likelihood(parameters, gradient));
    benchmark::ClobberMemory();
  }
  state.counters["gradients"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void weibull_by_hand(benchmark::State& state) {
  const Regression all;
  run_hand(state, all.parameters, [&](const auto& p, auto& g) { return weibull_hand(all, p, g); });
}
BENCHMARK(weibull_by_hand);

void hierarchy_language(benchmark::State& state) {
  const Hierarchy all;
  Symbols symbols;
  symbols.columns = {{"y", {}}, {"x", {}}};
  symbols.labels = {{"machine", {}}};
  for (std::size_t j = 0; j < machines; ++j) symbols.labels[0].levels.push_back(std::to_string(j));
  symbols.parameters = {
      {"mu", {}}, {"tau", {}}, {"sigma", {}}, {"z", {}, Scope::per_level, "machine"}};
  const Program program =
      compile({{"k", "exp(mu + tau*z[machine])"}},
              {{"log-likelihood", "-0.5*((y - k*x)/sigma)^2 - log(sigma)"}}, symbols);
  Rows at;
  at.count = rows;
  at.columns = {all.y, all.x};
  at.labels = {all.machine};
  run(state, program, at, all.parameters);
}
BENCHMARK(hierarchy_language);

double hierarchy_hand(const Hierarchy& all, std::span<const double> p, std::span<double> gradient) {
  double sum = 0, by_sigma = 0, by_mu = 0, by_tau = 0;
  const double inverse = 1 / p[2];
  for (std::size_t j = 0, i = 0; j < machines; ++j) {
    const double k = std::exp(p[0] + p[1] * p[3 + j]);
    double by_k = 0;
    for (std::size_t end = i + rows / machines; i < end; ++i) {
      const double r = (all.y[i] - k * all.x[i]) * inverse;
      sum -= 0.5 * r * r;
      by_k += r * all.x[i];
      by_sigma += r * r;
    }
    const double slope = by_k * inverse * k;
    by_mu += slope;
    by_tau += slope * p[3 + j];
    gradient[3 + j] = slope * p[1];
  }
  gradient[0] = by_mu;
  gradient[1] = by_tau;
  gradient[2] = (by_sigma - static_cast<double>(rows)) * inverse;
  return sum - static_cast<double>(rows) * std::log(p[2]);
}

void hierarchy_by_hand(benchmark::State& state) {
  const Hierarchy all;
  run_hand(state, all.parameters,
           [&](const auto& p, auto& g) { return hierarchy_hand(all, p, g); });
}
BENCHMARK(hierarchy_by_hand);

// One machine's rows a call, its k put in by the caller: what an integral over effects asks for.
void hierarchy_by_unit(benchmark::State& state) {
  const Hierarchy all;
  Symbols symbols;
  symbols.columns = {{"y", {}}, {"x", {}}};
  symbols.parameters = {{"k", {}}, {"sigma", {}}};
  const Program program =
      compile({}, {{"log-likelihood", "-0.5*((y - k*x)/sigma)^2 - log(sigma)"}}, symbols);
  Rows at;
  at.count = rows;
  at.columns = {all.y, all.x};
  const Data data = program.bind(at);
  Workspace work = program.workspace(rows / machines);
  std::vector<double> parameters = {1, 0.1}, gradient(2);
  for (auto _ : state) {
    parameters[0] = 2.5 - parameters[0];
    for (std::size_t j = 0, i = 0; j < machines; ++j, i += rows / machines) {
      program.forward(data, i, i + rows / machines, {parameters}, work);
      for (double& each : work.adjoints(0)) each = 1;
      program.reverse(data, i, i + rows / machines, {parameters}, work, gradient);
    }
    benchmark::ClobberMemory();
  }
  state.counters["gradients"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(hierarchy_by_unit);

// 50 paths of 20 rows through a state whose rate leans on it.
void run_in_state(benchmark::State& state) {
  const Hierarchy all;
  Symbols symbols;
  symbols.columns = {{"s", {}}, {"x", {}}};
  symbols.parameters = {{"k", {}}, {"h0", {}}};
  const Program program =
      compile({{"d(depth)/d(s)", "k * x * (1 - depth/h0)"}, {"depth(0)", "0 * h0"}},
              {{"depth", "depth"}}, symbols);
  Rows at;
  at.count = rows;
  std::vector<double> axis;
  for (std::size_t i = 0; i < rows; ++i) {
    axis.push_back(static_cast<double>(i % 20 + 1));
    if (i % 20 == 0) at.paths.push_back(i);
  }
  at.columns = {axis, all.x};
  run(state, program, at, {0.1, 3});
}
BENCHMARK(run_in_state);

// What the language costs: Basquin's law with Goodman's correction of 1000 tests, in it and as the S-N trade has it.
struct Springs {
  std::vector<double> amplitude, mean, life;
  fatigue::LifeTests tests;
  std::vector<double> parameters = {9.3, -0.09, 9.25, 0.2};

  Springs() {
    for (std::size_t i = 0; i < rows; ++i) {
      fatigue::LifeTest test;
      test.stress.alternating = 3e8 + 2e5 * static_cast<double>(i);
      test.stress.mean = 5e8 - 2e5 * static_cast<double>(i);
      test.life = std::pow(10, 6 - 0.001 * static_cast<double>(i));
      tests.push_back(test);
      amplitude.push_back(test.stress.alternating);
      mean.push_back(test.stress.mean);
      life.push_back(test.life);
    }
  }
};

void springs_language(benchmark::State& state) {
  const Springs all;
  const Powers pascal = read_any_unit("Pa").powers;
  Symbols symbols;
  symbols.columns = {{"amplitude", pascal}, {"mean", pascal}, {"life", {}}};
  symbols.parameters = {{"log10_a", {}}, {"b", {}}, {"log10_sut", {}}, {"sigma", {}}};
  const Program program = compile(
      {{"reversed", "amplitude/(1 - mean/(10^log10_sut * 1 [Pa]))"},
       {"z", "(log10(life) - (log10(reversed/1 [Pa]) - log10_a)/b)/sigma"}},
      {{"log-likelihood", "-log(life*log(10)) - 0.5*z^2 - log(sigma) - 0.5*log(2*pi)"}}, symbols);
  Rows at;
  at.count = rows;
  at.columns = {all.amplitude, all.mean, all.life};
  run(state, program, at, all.parameters);
}
BENCHMARK(springs_language);

void springs_built_in(benchmark::State& state) {
  const Springs all;
  const auto likelihood = fatigue::sn_likelihood(fatigue::SnLaw(), all.tests, rows);
  run_hand(state, all.parameters,
           [&](const auto& p, auto& g) { return likelihood->value_and_gradient(p, g); });
}
BENCHMARK(springs_built_in);

}  // namespace
}  // namespace wearwell::formula
