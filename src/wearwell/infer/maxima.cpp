#include "wearwell/infer/maxima.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "wearwell/infer/starts.h"
#include "wearwell/infer/whitened.h"
#include "wearwell/math/minimizer.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// Searches run in batches of fixed size, independent of the number of threads.
constexpr std::size_t batch = 8;
constexpr int uphill_evaluations = 250;

// A maximum with a smaller share of the mass and of second moments about the first maximum is
// omitted.
constexpr double negligible = 1e-5;
constexpr std::size_t most_maxima = 64;

// Another maximum with this much more mass (log) replaces the first.
constexpr double much_more = 1;

// Points and ends of searches lower by more than this (log) can belong to a relevant maximum only
// if it is broader by a factor of e^2 along every axis.
double reach(Eigen::Index dimension) {
  return 25 + 2 * static_cast<double>(dimension);
}

struct Effort {
  int points;          // at which the density is evaluated
  std::size_t fewest;  // searches
  std::size_t most;    // of them
  std::size_t enough;  // if the number of maxima indicates that none is left
};

// The cost of an evaluation is proportional to the number of observations. For comparison, the
// walks along the tails and the sampler take thousands of evaluations.
Effort effort_for(const Posterior& posterior, const Mode& known) {
  const int d = posterior.dimension();
  if (posterior.likelihood()->is_slow()) return {64, 4, 16, 4};
  Eigen::VectorXd x(d);
  posterior.to_natural(view(known.position), view(x));
  const auto rows = static_cast<double>(posterior.likelihood()->pointwise(view(x)).size());
  constexpr double cheap = 100, expensive = 5000;
  const double most = d == 1 ? 4096 : 2048;
  const int points = static_cast<int>(std::clamp(most * cheap / std::max(rows, cheap), 64.0, most));
  if (rows > expensive) return {points, 8, 48, 8};
  if (d == 1) return {points, 12, 256, 256};
  return {points, 12, d <= 8 ? 128u : 32u, 32};
}

// The real line in units of the widths of the first maximum.
class Search {
 public:
  Search(const Posterior& posterior, const Mode& known)
      : posterior_(posterior), round_(whitening_at(known)), density_(posterior, round_) {
    if (known.found) add(known, 1);
  }

  const Whitening& round() const { return round_; }

  // A batch of starts.
  void follow(const std::vector<Eigen::VectorXd>& starts) {
    std::vector<Mode> ends(starts.size());
    const double least = highest() - reach(posterior_.dimension());
    tbb::parallel_for(std::size_t{0}, starts.size(),
                      [&](std::size_t i) { ends[i] = uphill(starts[i], least); });
    for (const Mode& end : ends) {
      if (end.found && !count(end.position, end.log_density)) add(end, 1);
    }
    searches_ += starts.size();
  }

  std::size_t searches() const { return searches_; }
  double highest() const {
    double most = -INFINITY;
    for (const Found& each : found_) most = std::max(most, each.mode.log_density);
    return most;
  }
  double dropped() const { return dropped_; }
  // The expected number of undiscovered maxima of any mass.
  double left() const {
    const auto w = static_cast<double>(found_.size());
    const auto n = static_cast<double>(searches_);
    return w * (w + 1) / std::max(n - w - 2, 1.0);
  }
  // Whether more searches would probably find no more.
  bool exhausted() const { return left() < 0.5; }

  Maxima result() {
    if (found_.empty()) return {};
    double top = -INFINITY;
    for (const Found& each : found_) top = std::max(top, each.log_mass);
    double total = 0;
    for (const Found& each : found_) total += std::exp(each.log_mass - top);
    const auto by_mass = [](const Found& a, const Found& b) { return a.log_mass > b.log_mass; };
    const auto heaviest = std::min_element(found_.begin(), found_.end(), by_mass);
    // The first keeps its place unless another has much more mass.
    if (heaviest->log_mass > found_.front().log_mass + much_more)
      std::rotate(found_.begin(), heaviest, heaviest + 1);
    std::stable_sort(found_.begin() + 1, found_.end(), by_mass);
    Maxima maxima;
    maxima.starts = static_cast<int>(searches_) + 1;
    double kept = 0, dropped = 0;
    for (const Found& each : found_) {
      const double share = std::exp(each.log_mass - top) / total;
      if (!maxima.found.empty() && !(share * (1 + distance(each.mode)) > negligible)) continue;
      if (maxima.found.size() == most_maxima) {
        ++dropped;
        continue;
      }
      maxima.found.push_back({each.mode, share, each.reached});
      kept += share;
    }
    for (LocalMaximum& each : maxima.found) each.share /= kept;
    dropped_ = dropped;
    // Assumes the same fraction of non-negligible maxima among the undiscovered as among the found
    // ones.
    maxima.left =
        left() * static_cast<double>(maxima.found.size()) / static_cast<double>(found_.size());
    return maxima;
  }

 private:
  struct Found {
    Mode mode;
    double log_mass = 0;
    int reached = 0;
  };
  // Empty if it reaches no maximum, or one far below `least`.
  Mode uphill(const Eigen::VectorXd& start, double least) const {
    const Objective objective = [&](std::span<const double> u, std::span<double> gradient) {
      if (gradient.empty()) return -density_.value(u);
      const double value = density_.value_and_gradient(u, gradient);
      for (double& slope : gradient) slope = std::isfinite(value) ? -slope : 0;
      return -value;
    };
    const Eigen::VectorXd u = round_.scale.partialPivLu().solve(start - round_.center);
    const Minimum end = minimize(objective, u, uphill_evaluations);
    if (!(-end.value > least)) return {};
    if (const Found* known = nearest(round_(end.position), -end.value)) return known->mode;
    Mode there = find_mode(density_, end.position);
    if (!there.found || !(there.log_density > least)) return {};
    // Back to the real line: u = scale^-1 (z - center).
    const Eigen::MatrixXd back = round_.scale.inverse();
    there.position = round_(there.position);
    there.curvature = back.transpose() * there.curvature * back;
    return there;
  }

  // The known maximum at which a search ended, if any.
  const Found* nearest(const Eigen::VectorXd& z, double log_density) const {
    constexpr double same = 0.5, as_high = 0.1;  // widths; log
    for (const Found& each : found_) {
      if (std::abs(each.mode.log_density - log_density) > as_high) continue;
      const Eigen::VectorXd off = z - each.mode.position;
      if (off.dot(each.mode.curvature * off) < same * same) return &each;
    }
    return nullptr;
  }
  bool count(const Eigen::VectorXd& z, double log_density) {
    const Found* known = nearest(z, log_density);
    if (!known) return false;
    ++found_[static_cast<std::size_t>(known - found_.data())].reached;
    return true;
  }
  void add(const Mode& mode, int reached) {
    const Eigen::MatrixXd scaled = round_.scale.transpose() * mode.curvature * round_.scale;
    const double log_determinant = Eigen::LLT<Eigen::MatrixXd>(scaled)
                                       .matrixL()
                                       .toDenseMatrix()
                                       .diagonal()
                                       .array()
                                       .log()
                                       .sum();
    const double log_mass = mode.log_density - log_determinant;
    if (std::isfinite(log_mass)) found_.push_back({mode, log_mass, reached});
  }
  // Squared distance from the first, in its standard deviations of natural parameters.
  double distance(const Mode& mode) const {
    double sum = 0;
    for (std::size_t i = 0; i < posterior_.parameters().size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const Transform::Point first = posterior_.transforms()[i].from_real(round_.center[at]);
      const double width = std::abs(first.slope) * round_.scale.row(at).norm();
      sum += std::pow((posterior_.transforms()[i].natural(mode.position[at]) - first.x) / width, 2);
    }
    return sum;
  }

  const Posterior& posterior_;
  Whitening round_;
  WhitenedDensity density_;
  std::vector<Found> found_;
  std::size_t searches_ = 0;
  double dropped_ = 0;  // non-negligible maxima beyond the limit
};

}  // namespace

Maxima find_maxima(const Posterior& posterior, const Mode& known) {
  const Effort effort = effort_for(posterior, known);
  Search search(posterior, known);
  const StartPoints points = start_points(posterior, search.round(), effort.points);
  std::size_t high = 0, plain = 0;
  const auto within_reach = [&] {
    return high < points.high.size() &&
           points.high[high].log_density > search.highest() - reach(posterior.dimension());
  };
  while (search.searches() < effort.most) {
    if (search.searches() >= effort.fewest && search.exhausted() &&
        (search.searches() >= effort.enough || !within_reach())) {
      break;
    }
    std::vector<Eigen::VectorXd> starts;
    while (starts.size() < batch && (high < points.high.size() || plain < points.plain.size())) {
      // Alternates while both kinds remain.
      const bool highest =
          high < points.high.size() && (high <= plain || plain == points.plain.size());
      starts.push_back(highest ? points.high[high++].z : points.plain[plain++].z);
    }
    if (starts.empty()) break;
    search.follow(starts);
  }
  Maxima maxima = search.result();
  // No maximum is left if all starts are used, or in one dimension, where every peak among the
  // points was followed.
  if (high == points.high.size() && (posterior.dimension() == 1 || plain == points.plain.size()))
    maxima.left = 0;
  maxima.left += search.dropped();
  return maxima;
}

std::string description(const Posterior& posterior, const Maxima& maxima) {
  if (maxima.found.empty()) return "";
  if (!maxima.several()) return fmt::format("{} starts found one maximum", maxima.starts);
  constexpr double reported = 1e-3;
  constexpr std::size_t most_reported = 8, most_parameters = 4;
  std::vector<const LocalMaximum*> order;
  for (const LocalMaximum& each : maxima.found) order.push_back(&each);
  std::stable_sort(order.begin(), order.end(), [](const LocalMaximum* a, const LocalMaximum* b) {
    return a->share > b->share;
  });
  std::vector<std::string> places;
  double rest = 0;
  for (const LocalMaximum* each : order) {
    if (places.size() == most_reported || (each->share < reported && !places.empty())) {
      rest += each->share;
      continue;
    }
    std::vector<std::string> values;
    for (std::size_t i = 0; i < std::min(most_parameters, posterior.parameters().size()); ++i) {
      const Parameter& parameter = posterior.parameters()[i];
      const double x =
          posterior.transforms()[i].natural(each->mode.position[static_cast<Eigen::Index>(i)]);
      values.push_back(fmt::format("{} = {:.4g}{}{}", parameter.name, from_si(parameter.unit, x),
                                   parameter.unit.text == "1" ? "" : " ",
                                   parameter.unit.text == "1" ? "" : parameter.unit.text));
    }
    places.push_back(fmt::format("{} ({:.{}f} %)", fmt::join(values, ", "), 100 * each->share,
                                 each->share < 0.01 ? 1 : 0));
  }
  const std::size_t others = order.size() - places.size();
  if (others > 0) {
    places.push_back(
        fmt::format("{} more with {} % together", others,
                    rest < reported ? "less than 0.1" : fmt::format("{:.1f}", 100 * rest)));
  }
  const std::string last = places.back();
  places.pop_back();
  return fmt::format("{} starts: {} maxima, at {}{}{}", maxima.starts, order.size(),
                     fmt::join(places, "; "), places.empty() ? "" : " and ", last);
}

}  // namespace wearwell
