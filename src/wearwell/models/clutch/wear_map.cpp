#include "wearwell/models/clutch/wear_map.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <numeric>

#include "wearwell/base/error.h"
#include "wearwell/base/workers.h"
#include "wearwell/regress/search_problem.h"
#include "wearwell/regress/subset_search.h"

namespace wearwell::clutch {
namespace {

using Eigen::Index;

std::vector<Term> cubic_terms(const std::vector<std::string>& names) {
  return polynomial_terms(names, 3);
}

double surrogate_value(Surrogate surrogate, double r, double q, const OperatingPoint& at) {
  switch (surrogate) {
    case Surrogate::distance:
      return std::pow(at.slip_speed, r) * std::pow(at.closing_time, q);
    case Surrogate::power:
      return std::pow(at.slip_speed, r) * std::pow(at.torque, q);
    case Surrogate::energy:
      break;
  }
  return std::pow(at.slip_speed * at.closing_time, r) * std::pow(at.torque, q);
}

Eigen::MatrixXd temperatures(const std::vector<OperatingPoint>& at) {
  Eigen::MatrixXd values(std::ssize(at), 1);
  for (Index i = 0; i < values.rows(); ++i)
    values(i, 0) = at[static_cast<std::size_t>(i)].temperature;
  return values;
}

WearMap fit_terms(WearMap map, const WearPoints& points, const Eigen::MatrixXd& values,
                  const std::vector<Term>& all) {
  map.design = make_design(all, values);
  if (map.terms.empty()) {
    map.terms.resize(all.size());
    std::iota(map.terms.begin(), map.terms.end(), 0);
  }
  std::vector<std::string> names;
  for (const int t : map.terms) names.push_back(all[static_cast<std::size_t>(t)].name);
  map.fit = fit_least_squares(map.design.columns(Eigen::all, map.terms), points.w, {}, names);
  return map;
}

const char* const temperature_map = "temperature";

/// By r, then by q; not yet computed.
std::vector<PairBest> pairs_of(const std::vector<double>& exponents) {
  std::vector<PairBest> pairs;
  for (const double r : exponents) {
    for (const double q : exponents) pairs.push_back({r, q, INFINITY, 0, 0, {}});
  }
  return pairs;
}

/// The search at one pair of exponents.
class PairSearch {
 public:
  PairSearch(const WearPoints& points, Surrogate surrogate, bool drop_temperature)
      : points_(points), surrogate_(surrogate), drop_temperature_(drop_temperature) {
    std::vector<std::string> names = input_names(surrogate);
    if (drop_temperature) names.erase(names.begin() + 1);
    terms_ = cubic_terms(names);
  }

  double submodels() const { return std::ldexp(1.0, static_cast<int>(terms_.size())) - 1; }

  /// Fills in the best submodel; empty if its PRESS would exceed `at_most`.
  void solve(PairBest& pair, const std::vector<int>& start, double at_most = INFINITY) const {
    SearchSettings settings;
    settings.keep = 1;
    settings.threads = 1;
    settings.start = start;
    settings.press_at_most = at_most;
    const SearchResult result = search_subsets(columns(pair), points_.w, {}, settings);
    if (result.models.empty()) return;
    const SubsetModel& best = result.models.front();
    pair.press = best.press;
    pair.r2 = best.r2;
    pair.r2p = best.r2p;
    pair.terms = best.terms;
  }

  /// PRESS of one model; infinite if it cannot be fitted.
  double press(const PairBest& pair, const std::vector<int>& terms) const {
    const Eigen::MatrixXd chosen = columns(pair)(Eigen::all, terms);
    const SearchProblem problem(chosen, points_.w, {}, Criterion::loo);
    return exact_error(problem, every_term(problem.terms)).value_or(INFINITY);
  }

 private:
  Eigen::MatrixXd columns(const PairBest& pair) const {
    Eigen::MatrixXd values = input_values(surrogate_, pair.r, pair.q, points_.at);
    if (drop_temperature_) {
      const std::vector<int> kept =
          values.cols() == 3 ? std::vector<int>{0, 2} : std::vector<int>{0};
      values = values(Eigen::all, kept).eval();
    }
    return make_design(terms_, values).columns;
  }

  const WearPoints& points_;
  Surrogate surrogate_;
  bool drop_temperature_;
  std::vector<Term> terms_;
};

}  // namespace

const char* name_of(Surrogate surrogate) {
  static constexpr const char* names[] = {"distance", "power", "energy"};
  return names[static_cast<int>(surrogate)];
}

std::vector<std::string> input_names(Surrogate surrogate) {
  switch (surrogate) {
    case Surrogate::distance:
      return {"ds", "Td", "Mz"};
    case Surrogate::power:
      return {"ps", "Td", "t2"};
    case Surrogate::energy:
      break;
  }
  return {"es", "Td"};
}

Eigen::MatrixXd input_values(Surrogate surrogate, double r, double q,
                             const std::vector<OperatingPoint>& at) {
  Eigen::MatrixXd values(std::ssize(at), surrogate == Surrogate::energy ? 2 : 3);
  for (Index i = 0; i < values.rows(); ++i) {
    const OperatingPoint& point = at[static_cast<std::size_t>(i)];
    values(i, 0) = surrogate_value(surrogate, r, q, point);
    values(i, 1) = point.temperature;
    if (surrogate == Surrogate::distance) values(i, 2) = point.torque;
    if (surrogate == Surrogate::power) values(i, 2) = point.closing_time;
  }
  return values;
}

std::vector<double> paper_exponents() {
  std::vector<double> exponents;
  for (int i = 1; i <= 30; ++i) exponents.push_back(i / 10.0);
  return exponents;
}

ExponentSearch search_exponents(const WearPoints& points, Surrogate surrogate,
                                const std::vector<double>& exponents, int threads,
                                bool drop_temperature, Progress* progress) {
  const auto start = std::chrono::steady_clock::now();
  const PairSearch one(points, surrogate, drop_temperature);
  ExponentSearch search{surrogate, exponents, pairs_of(exponents), 0, one.submodels(), 0};
  // Along a row of the exponents the best model changes little: the previous one is a good start.
  const auto solve_row = [&](int row) {
    const std::size_t size = exponents.size(), first = static_cast<std::size_t>(row) * size;
    std::vector<int> before;
    for (std::size_t i = first; i < first + size; ++i) {
      one.solve(search.pairs[i], before);
      before = search.pairs[i].terms;
      if (progress) progress->advance(1);
    }
  };
  run_tasks(static_cast<int>(exponents.size()), threads_or_all(threads), solve_row);
  for (std::size_t i = 1; i < search.pairs.size(); ++i) {
    if (search.pairs[i].press < search.pairs[search.best].press) search.best = i;
  }
  search.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return search;
}

PairBest best_exponents(const WearPoints& points, Surrogate surrogate,
                        const std::vector<double>& exponents, const std::vector<int>& start,
                        int threads, bool drop_temperature, Progress* progress) {
  const PairSearch one(points, surrogate, drop_temperature);
  std::vector<PairBest> pairs = pairs_of(exponents);
  std::vector<int> terms = start;
  if (terms.empty()) {
    PairBest& middle = pairs[pairs.size() / 2 + exponents.size() / 2];
    one.solve(middle, {});
    terms = middle.terms;
  }
  // The promising pairs first, so that the others end early.
  std::vector<double> promise(pairs.size());
  std::vector<std::size_t> order(pairs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (const std::size_t i : order) promise[i] = one.press(pairs[i], terms);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return promise[a] < promise[b]; });
  std::mutex mutex;
  double least = promise[order.front()];
  const auto solve = [&](int k) {
    PairBest& pair = pairs[order[static_cast<std::size_t>(k)]];
    double most;
    {
      const std::lock_guard lock(mutex);
      most = least;
    }
    // A little more than the best, so that rounding does not drop a tie.
    one.solve(pair, terms, most * (1 + 1e-9));
    if (progress) progress->advance(1);
    const std::lock_guard lock(mutex);
    least = std::min(least, pair.press);
  };
  run_tasks(static_cast<int>(pairs.size()), threads_or_all(threads), solve);
  return *std::min_element(pairs.begin(), pairs.end(),
                           [](const PairBest& a, const PairBest& b) { return a.press < b.press; });
}

Eigen::MatrixXd WearMap::rows(const std::vector<OperatingPoint>& at) const {
  return scaled_terms(
      design, terms,
      name == temperature_map ? temperatures(at) : input_values(surrogate, r, q, at));
}

Eigen::VectorXd WearMap::predict(const std::vector<OperatingPoint>& at) const {
  return rows(at) * fit.coefficients;
}

WearMap fit_map(const std::string& name, const WearPoints& points, Surrogate surrogate, double r,
                double q, int degree, std::vector<int> terms) {
  WearMap map{name, surrogate, r, q, {}, std::move(terms), {}};
  return fit_terms(std::move(map), points, input_values(surrogate, r, q, points.at),
                   polynomial_terms(input_names(surrogate), degree));
}

WearMap fit_temperature_map(const WearPoints& points) {
  WearMap map{temperature_map, Surrogate::distance, 0, 0, {}, {}, {}};
  return fit_terms(std::move(map), points, temperatures(points.at), cubic_terms({"Td"}));
}

std::array<double, 4> correlations(const WearPoints& points) {
  std::array<double, 4> result{};
  const Eigen::ArrayXd w = points.w.array() - points.w.mean();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    Eigen::ArrayXd x(points.size());
    for (Index j = 0; j < x.size(); ++j)
      x[j] = points.at[static_cast<std::size_t>(j)].*inputs[i].value;
    x -= x.mean();
    result[i] = (w * x).sum() / std::sqrt(w.square().sum() * x.square().sum());
  }
  return result;
}

}  // namespace wearwell::clutch
