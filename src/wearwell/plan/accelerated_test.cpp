#include "wearwell/plan/accelerated_test.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "wearwell/plan/demonstration.h"

namespace wearwell::plan {
namespace {

constexpr double undetermined = std::numeric_limits<double>::infinity();
constexpr double highest_low = 0.99;  // of the lower level: two equal levels determine nothing

template <int n>
using InformationMatrix = Eigen::Matrix<double, n, n>;
template <int n>
using TermVector = Eigen::Matrix<double, n, 1>;

// Information of terms 1, xi, ... of the location and of the scale, last, times scale^2.
template <int terms>
InformationMatrix<terms + 1> information_of(const AccelerationGoal& goal,
                                            const CensoredInformation& information,
                                            const PlanningPoint& point, const TestLevel& level) {
  const LocationScaleInformation f = information(standardized_stop(goal, point, level));
  TermVector<terms> x;
  for (int i = 0; i < terms; ++i) x[i] = std::pow(level.xi, i);
  InformationMatrix<terms + 1> m;
  m.template topLeftCorner<terms, terms>() = f.location * x * x.transpose();
  m.template topRightCorner<terms, 1>() = f.both * x;
  m.template bottomLeftCorner<1, terms>() = f.both * x.transpose();
  m(terms, terms) = f.scale;
  return m;
}

template <int terms>
InformationMatrix<terms + 1> information_of(const AccelerationGoal& goal,
                                            const CensoredInformation& information,
                                            const PlanningPoint& point,
                                            std::span<const TestLevel> levels) {
  InformationMatrix<terms + 1> sum = InformationMatrix<terms + 1>::Zero();
  for (const TestLevel& level : levels)
    if (level.share > 0)
      sum += level.share * information_of<terms>(goal, information, point, level);
  if (goal.scale_known) {
    sum.row(terms).setZero();
    sum.col(terms).setZero();
    sum(terms, terms) = 1;
  }
  return sum;
}

// m^-1 c after scaling to a unit diagonal; none if m is singular to rounding.
template <int n>
std::optional<TermVector<n>> inverse_times(const InformationMatrix<n>& m, const TermVector<n>& c) {
  const TermVector<n> size = m.diagonal();
  if (!(size.minCoeff() > 0)) return std::nullopt;
  const TermVector<n> root = size.cwiseSqrt().cwiseInverse();
  const InformationMatrix<n> scaled = root.asDiagonal() * m * root.asDiagonal();
  const Eigen::LLT<InformationMatrix<n>> factor(scaled);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const TermVector<n> diagonal = factor.matrixL().toDenseMatrix().diagonal();
  if (diagonal.minCoeff() < 1e-7) return std::nullopt;
  return TermVector<n>(root.asDiagonal() * factor.solve(TermVector<n>(root.asDiagonal() * c)));
}

TermVector<3> gradient_of(const AccelerationGoal& goal) {
  return {1, 0, goal.scale_known ? 0 : quantile(goal.distribution, goal.failing)};
}

// The least value of a function of one number, by a grid and Brent's method about its best point.
template <class F>
double least_over(double from, double to, int steps, const F& f) {
  double best = from, value = f(from);
  for (int i = 1; i <= steps; ++i) {
    const double x = from + (to - from) * i / steps, y = f(x);
    if (y < value) {
      best = x;
      value = y;
    }
  }
  const double step = (to - from) / steps;
  const auto [x, y] = boost::math::tools::brent_find_minima(f, std::max(from, best - step),
                                                            std::min(to, best + step), 30);
  return y < value ? x : best;
}

std::vector<TestLevel> levels_of(PlanKind kind, const AccelerationGoal& goal, double low,
                                 double low_share, double middle_share) {
  const double middle = 0.5 * (1 + low);
  const auto& [low_stop, middle_stop, high_stop] = goal.log_stops;
  switch (kind) {
    case PlanKind::optimum:
      return {{low, low_share, low_stop}, {1, 1 - low_share, high_stop}};
    case PlanKind::compromise:
      return {{low, low_share, low_stop},
              {middle, middle_share, middle_stop},
              {1, 1 - low_share - middle_share, high_stop}};
    case PlanKind::four_two_one:
      return {{low, 4.0 / 7, low_stop}, {middle, 2.0 / 7, middle_stop}, {1, 1.0 / 7, high_stop}};
    case PlanKind::equal:
      break;
  }
  return {{low, 1.0 / 3, low_stop}, {middle, 1.0 / 3, middle_stop}, {1, 1.0 / 3, high_stop}};
}

}  // namespace

double standardized_stop(const AccelerationGoal& goal, const PlanningPoint& point,
                         const TestLevel& level) {
  const double known = goal.known_part ? goal.known_part(level.xi) : 0;
  return point.at_use + point.rise * level.xi + (level.log_stop + known) / point.scale;
}

std::vector<double> goal_variances(const AccelerationGoal& goal,
                                   const CensoredInformation& information,
                                   std::span<const TestLevel> levels) {
  const TermVector<3> c = gradient_of(goal);
  std::vector<double> all;
  for (const PlanningPoint& point : goal.points) {
    const auto x = inverse_times<3>(information_of<2>(goal, information, point, levels), c);
    all.push_back(x ? point.scale * point.scale * c.dot(*x) : undetermined);
  }
  return all;
}

double goal_variance(const AccelerationGoal& goal, const CensoredInformation& information,
                     std::span<const TestLevel> levels) {
  const std::vector<double> all = goal_variances(goal, information, levels);
  double sum = 0;
  for (std::size_t i = 0; i < all.size(); ++i) sum += goal.points[i].weight * all[i];
  return sum;
}

double curvature_variance(const AccelerationGoal& goal, const CensoredInformation& information,
                          std::span<const TestLevel> levels) {
  double sum = 0;
  const TermVector<4> c = {0, 0, 1, 0};
  for (const PlanningPoint& point : goal.points) {
    const auto x = inverse_times<4>(information_of<3>(goal, information, point, levels), c);
    if (!x || levels.size() < 3) return undetermined;
    sum += point.weight * point.scale * point.scale * c.dot(*x);
  }
  return sum;
}

double gain_at(const AccelerationGoal& goal, const CensoredInformation& information,
               std::span<const TestLevel> levels, double xi) {
  const TermVector<3> c = gradient_of(goal);
  double gain = 0, variance = 0;
  for (const PlanningPoint& point : goal.points) {
    const auto x = inverse_times<3>(information_of<2>(goal, information, point, levels), c);
    if (!x) return undetermined;
    InformationMatrix<3> here = information_of<2>(goal, information, point, TestLevel{xi, 1});
    if (goal.scale_known) {
      here.row(2).setZero();
      here.col(2).setZero();
    }
    const double size = point.weight * point.scale * point.scale;
    gain += size * x->dot(here * *x);
    variance += size * c.dot(*x);
  }
  return gain / variance;
}

std::vector<TestLevel> best_allocation(PlanKind kind, const AccelerationGoal& goal,
                                       const CensoredInformation& information, double low,
                                       double middle_share) {
  if (kind == PlanKind::four_two_one || kind == PlanKind::equal)
    return levels_of(kind, goal, low, 0, middle_share);
  const double most = kind == PlanKind::optimum ? 1 : 1 - middle_share;
  const double share = least_over(0.002 * most, 0.998 * most, 8, [&](double low_share) {
    return goal_variance(goal, information, levels_of(kind, goal, low, low_share, middle_share));
  });
  return levels_of(kind, goal, low, share, middle_share);
}

std::vector<TestLevel> best_plan(PlanKind kind, const AccelerationGoal& goal,
                                 const CensoredInformation& information, double lowest,
                                 double middle_share) {
  const double low = least_over(lowest, highest_low, 30, [&](double xi) {
    return goal_variance(goal, information,
                         best_allocation(kind, goal, information, xi, middle_share));
  });
  return best_allocation(kind, goal, information, low, middle_share);
}

std::vector<std::size_t> whole_allocation(std::span<const TestLevel> levels, std::size_t n) {
  std::vector<std::size_t> count;
  std::vector<std::pair<double, std::size_t>> rest;
  std::size_t left = n;
  for (const TestLevel& level : levels) {
    const double exact = level.share * static_cast<double>(n);
    const double whole = std::floor(exact + 1e-9);
    rest.emplace_back(whole - exact, count.size());
    count.push_back(static_cast<std::size_t>(whole));
    left -= std::min(left, count.back());
  }
  std::stable_sort(rest.begin(), rest.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < left; ++i) ++count[rest[i % rest.size()].second];
  return count;
}

double failing_at(const AccelerationGoal& goal, const TestLevel& level) {
  double sum = 0;
  for (const PlanningPoint& point : goal.points)
    sum += point.weight * cdf(goal.distribution, standardized_stop(goal, point, level));
  return sum;
}

double enough_failures(const AccelerationGoal& goal, const TestLevel& level, std::size_t n,
                       std::size_t least) {
  if (least == 0) return 1;
  double sum = 0;
  for (const PlanningPoint& point : goal.points)
    sum += point.weight *
           (1 - at_most_failing(n, least - 1,
                                cdf(goal.distribution, standardized_stop(goal, point, level))));
  return sum;
}

}  // namespace wearwell::plan
