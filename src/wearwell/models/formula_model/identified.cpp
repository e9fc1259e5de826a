#include "wearwell/models/formula_model/identified.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "wearwell/base/stop_scope.h"

namespace wearwell::formula_model {
namespace {

// Every distribution parameter of every observation, with units at three quantiles of their
// population.
std::vector<double> all_family_parameters(const FormulaRows& rows, const std::vector<double>& x) {
  check_stop();
  UnitRows& units = rows.mine().rows;
  units.move_to(x.data());
  const std::size_t d = rows.model().effects.size();
  static constexpr double places[3][2] = {{-1, 0.7}, {0.4, -1.1}, {1.3, 0.2}};
  std::vector<double> all;
  for (const auto& place : places) {
    std::vector<double> z(rows.model().units.size() * d);
    for (std::size_t i = 0; i < z.size(); ++i) z[i] = place[i % std::max<std::size_t>(d, 1)];
    for (const auto& column : units.each_family_parameter(z))
      all.insert(all.end(), column.begin(), column.end());
    if (d == 0) break;
  }
  return all;
}

double size_of(const Parameter& parameter, double x) {
  return x != 0 ? std::abs(x) : parameter.scale;
}

// Derivatives of the distribution parameters, relative to their size, by relative changes of the
// parameters.
Eigen::MatrixXd derivatives(const FormulaRows& rows, const std::vector<Parameter>& parameters,
                            std::vector<double> x) {
  constexpr double step = 1e-4;
  const std::vector<double> here = all_family_parameters(rows, x);
  Eigen::MatrixXd result(static_cast<Eigen::Index>(here.size()),
                         static_cast<Eigen::Index>(x.size()));
  for (std::size_t p = 0; p < x.size(); ++p) {
    const double at = x[p], size = size_of(parameters[p], at);
    x[p] = at + step * size;
    const std::vector<double> above = all_family_parameters(rows, x);
    x[p] = at - step * size;
    const std::vector<double> below = all_family_parameters(rows, x);
    x[p] = at;
    for (std::size_t i = 0; i < here.size(); ++i) {
      check_stop();
      const double scale = std::max({std::abs(here[i]), std::abs(above[i]), std::abs(below[i])});
      const double slope = scale > 0 ? (above[i] - below[i]) / (2 * step * scale) : 0;
      result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(p)) =
          std::isfinite(slope) ? slope : 0;
    }
  }
  return result;
}

// The direction in which no output changes, as relative changes; empty if there is none.
Eigen::VectorXd still(Eigen::MatrixXd slopes) {
  constexpr double least = 1e-6;
  Eigen::VectorXd length = slopes.colwise().norm();
  for (Eigen::Index p = 0; p < length.size(); ++p) {
    if (length[p] < 1e-12) return Eigen::VectorXd::Unit(length.size(), p);
    slopes.col(p) /= length[p];
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(slopes.transpose() * slopes);
  if (eigen.eigenvalues()[0] > least * least * eigen.eigenvalues()[length.size() - 1]) return {};
  const Eigen::VectorXd direction = eigen.eigenvectors().col(0).cwiseQuotient(length);
  return direction / direction.cwiseAbs().maxCoeff();
}

std::string description(const std::vector<Parameter>& parameters,
                        const Eigen::VectorXd& direction) {
  constexpr double counts = 0.01;
  Eigen::Index first = 0;
  while (std::abs(direction[first]) < counts) ++first;
  const double sign = direction[first] > 0 ? 1 : -1;
  std::vector<std::string> moves;
  for (Eigen::Index p = 0; p < direction.size(); ++p) {
    const double by = sign * direction[p];
    if (std::abs(by) < counts) continue;
    moves.push_back(fmt::format("{} {} by {:.3g} %", parameters[static_cast<std::size_t>(p)].name,
                                by > 0 ? "up" : "down", std::abs(by)));
  }
  return fmt::format("{}", fmt::join(moves, " and "));
}

std::string names(const std::vector<Parameter>& parameters, const Eigen::VectorXd& direction) {
  std::vector<std::string> all;
  for (Eigen::Index p = 0; p < direction.size(); ++p) {
    if (std::abs(direction[p]) >= 0.01) all.push_back(parameters[static_cast<std::size_t>(p)].name);
  }
  if (all.size() == 1) return all[0];
  const std::string last = all.back();
  all.pop_back();
  return fmt::format("{} and {}", fmt::join(all, ", "), last);
}

}  // namespace

Check identified(const FormulaRows& rows, const std::vector<Parameter>& parameters,
                 const Fit& fit) {
  constexpr Eigen::Index points = 4;
  Findings findings("identified");
  Eigen::VectorXd direction;
  for (Eigen::Index i = 0; i < points; ++i) {
    const Eigen::VectorXd at =
        fit.pooled.values.row((2 * i + 1) * fit.pooled.values.rows() / (2 * points));
    // Drawn effects are identified by their distribution; they follow all other parameters.
    const std::vector<DrawnEffect>& drawn = rows.model().drawn;
    const auto others = drawn.empty() ? at.size() : static_cast<Eigen::Index>(drawn.front().first);
    direction = still(derivatives(rows, parameters, {at.begin(), at.end()}).leftCols(others));
    if (direction.size() == 0) break;
  }
  if (direction.size() > 0) {
    const std::string all = names(parameters, direction);
    const bool one = (direction.cwiseAbs().array() >= 0.01).count() == 1;
    findings.add(
        Verdict::fail,
        one ? fmt::format("the data do not inform {}: no observed quantity depends on it", all)
            : fmt::format(
                  "the data do not identify {} separately: with {} no observed quantity changes",
                  all, description(parameters, direction)),
        one ? fmt::format("Leave {} out, or measure conditions where it matters; its posterior is "
                          "its prior.",
                          all)
            : "Keep one parameter for their combined effect, or move the others to [constants]; "
              "the data inform only the combination.");
  }
  return findings.result("every combination of the parameters changes an observed quantity");
}

}  // namespace wearwell::formula_model
