#include "wearwell/infer/ridge.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "wearwell/infer/maximize.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/view.h"

namespace wearwell {

Slice::Buffer Slice::expand(std::span<const double> rest) const {
  Buffer full;
  for (std::size_t i = 0; i < rest.size(); ++i) full[i + (i >= held_)] = rest[i];
  full[held_] = at;
  return full;
}

double Slice::value(std::span<const double> rest) const {
  const Buffer full = expand(rest);
  return whole_.value(std::span(full.data(), rest.size() + 1));
}

double Slice::value_and_gradient(std::span<const double> rest, std::span<double> gradient) const {
  const Buffer full = expand(rest);
  Buffer slope{};
  const double value = whole_.value_and_gradient(std::span(full.data(), rest.size() + 1),
                                                 std::span(slope.data(), rest.size() + 1));
  for (std::size_t i = 0; i < rest.size(); ++i) gradient[i] = slope[i + (i >= held_)];
  return value;
}

Eigen::VectorXd Slice::whole(const Eigen::VectorXd& rest) const {
  const Buffer full = expand(view(rest));
  return Eigen::Map<const Eigen::VectorXd>(full.data(), rest.size() + 1);
}

Eigen::VectorXd without(const Eigen::VectorXd& whole, Eigen::Index held) {
  Eigen::VectorXd rest(whole.size() - 1);
  for (Eigen::Index i = 0; i < rest.size(); ++i) rest[i] = whole[i + (i >= held)];
  return rest;
}

ConditionalMode visit(const Slice& slice, const std::vector<Eigen::VectorXd>& guesses,
                      const Eigen::VectorXd& width) {
  const auto n = static_cast<Eigen::Index>(slice.dimension());
  ConditionalMode station;
  station.at = slice.at;
  if (n == 0) {
    station.rest.resize(0);
    station.width.resize(0);
    station.curvature.resize(0, 0);
    station.log_density = station.log_marginal = slice.value({});
    station.converged = std::isfinite(station.log_density);
    return station;
  }
  const Eigen::VectorXd* best = &guesses.front();
  double highest = -INFINITY;
  for (const Eigen::VectorXd& guess : guesses) {
    const double value = slice.value(view(guess));
    if (value > highest) {
      highest = value;
      best = &guess;
    }
  }
  const Box everywhere{Eigen::VectorXd::Constant(n, -infinity),
                       Eigen::VectorXd::Constant(n, infinity)};
  constexpr double enough = 1e-6;  // sufficient for a Laplace approximation
  const Maximum summit = maximize(slice, *best, width, everywhere, enough);
  station.rest = summit.x;
  station.width = width;
  station.log_density = station.log_marginal = summit.value;
  station.curvature = summit.curvature;
  if (!std::isfinite(summit.value) || station.curvature.size() == 0 ||
      !station.curvature.allFinite()) {
    return station;
  }
  // Scaled to unit diagonal, so that magnitudes of 1e-9 and 1 can occur together. A direction
  // without curvature counts as unit width, which only changes a tail by a constant factor.
  for (Eigen::Index i = 0; i < n; ++i) {
    const double bend = station.curvature(i, i);
    station.width[i] = bend > 1e-8 ? 1 / std::sqrt(bend) : 1;
  }
  const Eigen::MatrixXd scaled =
      station.width.asDiagonal() * station.curvature * station.width.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled, Eigen::EigenvaluesOnly);
  const double log_determinant =
      eigen.eigenvalues().unaryExpr([](double c) { return std::log(c > 1e-12 ? c : 1.0); }).sum() -
      2 * station.width.array().log().sum();
  station.log_marginal -= 0.5 * log_determinant;
  station.converged = summit.converged;
  return station;
}

std::vector<Eigen::VectorXd> guesses(const ConditionalMode& before, const ConditionalMode& last,
                                     double step) {
  std::vector<Eigen::VectorXd> all = {last.rest};
  const double back = last.at - before.at;
  if (back == 0 || last.rest.size() == 0) return all;
  const Eigen::VectorXd moved = last.rest - before.rest;
  all.emplace_back(last.rest + step / back * moved);
  for (const double sign : {-1.0, 1.0}) {
    const double growth = std::expm1(sign * step) / -std::expm1(-sign * back);
    if (std::isfinite(growth)) all.emplace_back(last.rest + growth * moved);
  }
  return all;
}

}  // namespace wearwell
