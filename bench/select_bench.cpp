// Subset search on the layout of the clutch paper (peers/select.csv); the peer is peers/select.R.
#include <benchmark/benchmark.h>

#include <Eigen/Cholesky>
#include <fstream>
#include <sstream>

#include "wearwell/base/rng.h"
#include "wearwell/regress/subset_search.h"
#include "wearwell/regress/terms.h"

namespace wearwell {
namespace {

struct Problem {
  Eigen::MatrixXd columns;
  Eigen::VectorXd response;
};

/// A cubic in the first `inputs` of four: 20 terms in three, 35 in four.
Problem clutch(int inputs) {
  std::ifstream file(PROJECT_SOURCE_DIR "/bench/peers/select.csv");
  std::vector<std::vector<double>> rows;
  std::string line;
  for (std::getline(file, line); std::getline(file, line);) {
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');)
      rows.back().push_back(std::stod(field));
  }
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd values(count, inputs);
  Eigen::VectorXd response(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (int j = 0; j < inputs; ++j) values(i, j) = rows[i][j];
    response[i] = rows[i][4];
  }
  std::vector<std::string> names = {"a", "b", "c", "d"};
  names.resize(inputs);
  return {make_design(polynomial_terms(names, 3), values).columns, response};
}

/// The 35 terms over more rows, drawn at random.
Problem tall(int rows) {
  Rng rng(1, 0);
  Eigen::MatrixXd values(rows, 4);
  for (double& x : values.reshaped()) x = rng.uniform(1, 3);
  Problem problem{make_design(polynomial_terms({"a", "b", "c", "d"}, 3), values).columns,
                  Eigen::VectorXd(rows)};
  for (double& y : problem.response) y = rng.normal();
  for (int t = 0; t < 35; t += 4) problem.response += rng.uniform(-3, 3) * problem.columns.col(t);
  return problem;
}

/// Columns that have nothing to do with each other; every fourth matters, and less and less.
Problem wide(int terms, int rows) {
  Rng rng(2, 0);
  Problem problem{Eigen::MatrixXd(rows, terms), Eigen::VectorXd(rows)};
  for (double& x : problem.columns.reshaped()) x = rng.normal();
  for (double& y : problem.response) y = rng.normal();
  for (int t = 0; t < terms; t += 4) problem.response += 4.0 / (t + 4) * problem.columns.col(t);
  return problem;
}

void search(benchmark::State& state, const Problem& problem, const SearchSettings& settings) {
  double nodes = 0;
  for (auto _ : state) {
    const auto result = search_subsets(problem.columns, problem.response, {}, settings);
    if (!result.certified) state.SkipWithError("not proven");
    nodes += result.nodes;
  }
  state.counters["nodes"] = benchmark::Counter(nodes, benchmark::Counter::kAvgIterations);
  state.counters["nodes/s"] = benchmark::Counter(nodes, benchmark::Counter::kIsRate);
}

SearchSettings settings_of(benchmark::State& state, Criterion criterion) {
  SearchSettings settings;
  settings.criterion = criterion;
  settings.threads = static_cast<int>(state.range(0));
  return settings;
}

// R2 and R2p of all 2^20 - 1 models.
void cloud_of_20(benchmark::State& state) {
  auto settings = settings_of(state, Criterion::loo);
  settings.cloud = CloudKind::bins;
  search(state, clutch(3), settings);
}

// The best of 2^35 - 1 models, proven.
void loo_of_35(benchmark::State& state) {
  search(state, clutch(4), settings_of(state, Criterion::loo));
}
void bic_of_35(benchmark::State& state) {
  search(state, clutch(4), settings_of(state, Criterion::bic));
}

// The task of leaps: the best of every size by the residual sum of squares, with the constant.
void every_size_of_35(benchmark::State& state) {
  auto settings = settings_of(state, Criterion::bic);
  settings.prove_sizes = true;
  settings.forced = {0};
  settings.keep = 1;
  search(state, clutch(4), settings);
}

void loo_of_35_in_1000_rows(benchmark::State& state) {
  search(state, tall(1000), settings_of(state, Criterion::loo));
}
void bic_of_35_in_10000_rows(benchmark::State& state) {
  search(state, tall(10'000), settings_of(state, Criterion::bic));
}
void bic_of_60(benchmark::State& state) {
  search(state, wide(60, 500), settings_of(state, Criterion::bic));
}

// What one would write without thinking: each model's normal equations anew, of the first 14
// terms of the 20. Compare models per second with cloud_of_20.
void plain_loop_of_14(benchmark::State& state) {
  const Problem problem = clutch(3);
  const Eigen::MatrixXd all = problem.columns.leftCols(14);
  constexpr int models = (1 << 14) - 1;
  for (auto _ : state) {
    double best = INFINITY;
    for (int model = 1; model <= models; ++model) {
      std::vector<int> terms;
      for (int t = 0; t < 14; ++t) {
        if (model >> t & 1) terms.push_back(t);
      }
      const Eigen::MatrixXd x = all(Eigen::all, terms);
      const Eigen::LLT<Eigen::MatrixXd> llt(x.transpose() * x);
      const Eigen::VectorXd e = problem.response - x * llt.solve(x.transpose() * problem.response);
      const Eigen::MatrixXd half = llt.matrixL().solve(x.transpose());
      const Eigen::ArrayXd rest = 1 - half.colwise().squaredNorm().transpose().array();
      best = std::min(best, (e.array() / rest).square().sum());
    }
    benchmark::DoNotOptimize(best);
  }
  state.counters["nodes/s"] =
      benchmark::Counter(models, benchmark::Counter::kIsIterationInvariantRate);
}

#define SEARCH(name) \
  BENCHMARK(name)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime()
SEARCH(cloud_of_20);
SEARCH(loo_of_35);
SEARCH(bic_of_35);
SEARCH(every_size_of_35);
SEARCH(loo_of_35_in_1000_rows);
SEARCH(bic_of_35_in_10000_rows);
SEARCH(bic_of_60);
BENCHMARK(plain_loop_of_14)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace wearwell
