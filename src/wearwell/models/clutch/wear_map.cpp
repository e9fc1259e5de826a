#include "wearwell/models/clutch/wear_map.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <cmath>
#include <numeric>

#include "wearwell/base/error.h"
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
  std::vector<std::string> names = input_names(surrogate);
  if (drop_temperature) names.erase(names.begin() + 1);
  const std::vector<Term> terms = cubic_terms(names);
  ExponentSearch search{
      surrogate, exponents, {}, 0, std::ldexp(1.0, static_cast<int>(terms.size())) - 1, 0};
  for (const double r : exponents) {
    for (const double q : exponents) search.pairs.push_back({r, q, 0, 0, 0, {}});
  }
  const auto solve = [&](std::size_t i) {
    PairBest& pair = search.pairs[i];
    Eigen::MatrixXd values = input_values(surrogate, pair.r, pair.q, points.at);
    if (drop_temperature) {
      const std::vector<int> kept =
          values.cols() == 3 ? std::vector<int>{0, 2} : std::vector<int>{0};
      values = values(Eigen::all, kept).eval();
    }
    SearchSettings settings;
    settings.keep = 1;
    settings.threads = 1;
    const SearchResult result =
        search_subsets(make_design(terms, values).columns, points.w, {}, settings);
    const SubsetModel& best = result.models.front();
    pair.press = best.press;
    pair.r2 = best.r2;
    pair.r2p = best.r2p;
    pair.terms = best.terms;
    if (progress) progress->advance(1);
  };
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, search.pairs.size(), solve); });
  for (std::size_t i = 1; i < search.pairs.size(); ++i) {
    if (search.pairs[i].press < search.pairs[search.best].press) search.best = i;
  }
  search.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return search;
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
