#include "wearwell/models/bearing/profile.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/models/bearing/flank_noise.h"

namespace wearwell::bearing {
namespace {

void check(const Profile& profile, const char* name) {
  if (profile.position.size() < 3) {
    throw InputError(fmt::format("the profile {} has {} points; it needs at least 3", name,
                                 profile.position.size()));
  }
  for (std::size_t i = 1; i < profile.position.size(); ++i) {
    if (!(profile.position[i] > profile.position[i - 1])) {
      throw InputError(fmt::format(
          "row {} of the profile {}: position {:.6g} m is not above the previous one, {:.6g} m",
          i + 1, name, profile.position[i], profile.position[i - 1]));
    }
  }
}

// Linear between points; `x` must be inside the range.
double height_at(const Profile& profile, double x) {
  const auto& p = profile.position;
  const auto above = std::clamp<std::ptrdiff_t>(std::upper_bound(p.begin(), p.end(), x) - p.begin(),
                                                1, static_cast<std::ptrdiff_t>(p.size()) - 1);
  const auto i = static_cast<std::size_t>(above);
  const double t = (x - p[i - 1]) / (p[i] - p[i - 1]);
  return std::lerp(profile.height[i - 1], profile.height[i], t);
}

// A profile averaged over a few points to either side of a position. Interpolated noise is smaller
// between points than at them, so the misfit of plain profiles has its minimum half way between two
// points, independent of the features; averages avoid that.
class Averaged {
 public:
  Averaged(const Profile& profile, double half_width)
      : profile_(profile), half_width_(half_width), integral_{0} {
    for (std::size_t i = 1; i < profile.position.size(); ++i) {
      integral_.push_back(integral_.back() + 0.5 * (profile.height[i] + profile.height[i - 1]) *
                                                 (profile.position[i] - profile.position[i - 1]));
    }
  }

  double operator()(double x) const {
    const auto& p = profile_.position;
    const double a = std::max(p.front(), x - half_width_), b = std::min(p.back(), x + half_width_);
    return (integral(b) - integral(a)) / (b - a);
  }

 private:
  double integral(double x) const {
    const auto& p = profile_.position;
    const auto above = std::upper_bound(p.begin() + 1, p.end() - 1, x) - p.begin();
    const auto i = static_cast<std::size_t>(above) - 1;
    return integral_[i] + 0.5 * (profile_.height[i] + height_at(profile_, x)) * (x - p[i]);
  }

  const Profile& profile_;
  double half_width_;
  std::vector<double> integral_;
};

// The points of the profile after wear, and which of them are flank.
struct Window {
  std::vector<double> x;       // position relative to the middle
  std::vector<double> height;  // after wear
  std::size_t left, right;     // flanks are [0, left) and [right, size)

  bool is_flank(std::size_t i) const { return i < left || i >= right; }
  std::size_t flank_points() const { return left + x.size() - right; }
};

// Before less after, and the line fitted to the flanks.
struct Alignment {
  std::vector<double> difference;  // less the line
  Eigen::Vector2d line;            // height, tilt
  double squares;                  // of the flanks
};

// `before` is a function of the position.
template <class Before>
Alignment align(const Before& before, const std::vector<double>& after, const Window& window) {
  Alignment result;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < window.x.size(); ++i) {
    const double d = before(window.x[i]) - after[i];
    result.difference.push_back(d);
    if (!window.is_flank(i)) continue;
    const Eigen::Vector2d row(1, window.x[i]);
    normal += row * row.transpose();
    right += row * d;
  }
  result.line = normal.ldlt().solve(right);
  result.squares = 0;
  for (std::size_t i = 0; i < window.x.size(); ++i) {
    result.difference[i] -= result.line[0] + result.line[1] * window.x[i];
    if (window.is_flank(i)) result.squares += result.difference[i] * result.difference[i];
  }
  return result;
}

// 1 + 2 times the autocorrelations of the residuals, each flank separately, up to the first
// negative sum.
double correlation(const Alignment& alignment, const Window& window, double variance) {
  const std::size_t n = window.x.size();
  const std::size_t longest = std::min(window.left, n - window.right) / 2;
  double sum = 1;
  for (std::size_t lag = 1; lag < longest; ++lag) {
    double products = 0, pairs = 0;
    for (std::size_t i = 0; i + lag < n; ++i) {
      if (!(i + lag < window.left || i >= window.right)) continue;
      products += alignment.difference[i] * alignment.difference[i + lag];
      ++pairs;
    }
    const double rho = products / pairs / variance;
    if (rho <= 0) break;
    sum += 2 * rho;
  }
  return sum;
}

// The shift of least misfit, at most `farthest`: the best on a grid as fine as the points, refined
// between its neighbours. Empty if the flanks have no features. Uses averages: between two points
// interpolated noise is smaller, which looks like a better fit. The minimum of many misfits is
// small by chance, so a shift must improve the fit by more than the scatter of noise, the root of
// the number of independent points.
std::optional<double> best_shift(const Profile& before, const Profile& after, const Window& window,
                                 double middle, double spacing, double farthest) {
  const Averaged smooth_before(before, 2 * spacing), smooth_after(after, 2 * spacing);
  std::vector<double> heights;
  for (const double x : window.x) heights.push_back(smooth_after(middle + x));
  const auto aligned = [&](double shift) {
    const auto moved = [&](double x) { return smooth_before(middle + x + shift); };
    return align(moved, heights, window);
  };
  const auto squares = [&](double shift) { return aligned(shift).squares; };
  const double grid = std::max(spacing, farthest / 100);
  double best = 0, least = squares(0);
  for (double s = -farthest; s <= farthest; s += grid) {
    const double here = squares(s);
    if (here < least) {
      best = s;
      least = here;
    }
  }
  constexpr int bits = 30;
  best = boost::math::tools::brent_find_minima(squares, std::max(-farthest, best - grid),
                                               std::min(farthest, best + grid), bits)
             .first;
  const Alignment shifted = aligned(best);
  const auto degrees = static_cast<double>(window.flank_points());
  const double variance = shifted.squares / (degrees - 3);
  const double independent = correlation(shifted, window, variance);
  const double by_chance = 3.3 * 3.3 + 3 * std::sqrt(degrees / independent);
  if (squares(0) - shifted.squares > by_chance * variance * independent) return best;
  return {};
}

// Depth of the inner quarters of the flanks below a line through the rest, in standard deviations
// of the rest's noise.
template <class Before>
double inner_step(const Before& before, const Window& window) {
  Window outer = window;
  outer.left -= window.left / 4;
  outer.right += (window.x.size() - window.right) / 4;
  const Alignment alignment = align(before, window.height, outer);
  const auto degrees = static_cast<double>(outer.flank_points());
  const double variance = alignment.squares / (degrees - 2);
  double sum = 0, count = 0;
  for (std::size_t i = outer.left; i < outer.right; ++i) {
    if (!window.is_flank(i)) continue;
    sum += alignment.difference[i];
    ++count;
  }
  return sum / count /
         std::sqrt(variance * correlation(alignment, outer, variance) * (1 / count + 1 / degrees));
}

// The alignment of the profiles. Positions of the window count from its middle.
struct Overlap {
  Window window;
  double middle = 0;
  double farthest = 0;  ///< a quarter of a flank is reserved at either end, for the shift
};

Overlap overlap_of(const Profile& before, const Profile& after, std::optional<double> flank) {
  const double start = std::max(before.position.front(), after.position.front());
  const double end = std::min(before.position.back(), after.position.back());
  if (!(end > start)) {
    throw InputError("the profiles before and after have no position in common");
  }
  const double width = flank.value_or(0.2 * (end - start));
  if (!(width > 0 && 2 * width < end - start)) {
    throw InputError(
        fmt::format("a flank of {:.6g} m at either end leaves no worn region between: the profiles "
                    "overlap by {:.6g} m",
                    width, end - start));
  }
  const double farthest = 0.25 * width;
  const double middle = 0.5 * (start + end);
  Window window{{}, {}, 0, 0};
  for (std::size_t i = 0; i < after.position.size(); ++i) {
    const double x = after.position[i];
    if (x < start + farthest || x > end - farthest) continue;
    window.x.push_back(x - middle);
    window.height.push_back(after.height[i]);
    if (x < start + width) ++window.left;
    if (x <= end - width) ++window.right;
  }
  const std::size_t n = window.x.size();
  constexpr std::size_t least = 20;
  if (window.left < least || n - window.right < least || window.right - window.left < 2) {
    throw InputError(fmt::format(
        "the flanks of {:.6g} m have {} and {} points, with {} between; each flank needs {}", width,
        window.left, n - window.right, window.right - window.left, least));
  }
  return {std::move(window), middle, farthest};
}

// The worn area between the flanks and its noise, after alignment; `slope` is the slope of the
// profile before wear, 0 if no shift was estimated.
template <class Slope>
WornArea area_between(const Window& window, const Alignment& alignment, Eigen::Index unknowns,
                      double curvature, const Slope& slope) {
  const std::size_t n = window.x.size();
  const auto degrees = static_cast<double>(window.flank_points());
  const double variance = alignment.squares / (degrees - static_cast<double>(unknowns));
  // Trapezoids between the flanks: one weight per difference. The baseline moves with the flanks'
  // noise: its area is gradient . (height, tilt, shift).
  WornArea result;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::MatrixXd design(static_cast<Eigen::Index>(n), unknowns);
  std::vector<double> weights(n, 0.0);  // of each point's difference in the area
  for (std::size_t i = 0; i < n; ++i) {
    const double x = window.x[i];
    const Eigen::Vector3d row(1, x, slope(x));
    design.row(static_cast<Eigen::Index>(i)) = row.head(unknowns);
    if (window.is_flank(i)) {
      normal += row * row.transpose();
      continue;
    }
    const double weight = 0.5 * ((i + 1 < window.right ? window.x[i + 1] - x : 0) +
                                 (i > window.left ? x - window.x[i - 1] : 0));
    // On a curved surface the section widens with the depth.
    const double d = alignment.difference[i];
    result.area += weight * (d + 0.5 * curvature * (d * d - variance));
    weights[i] = weight;
    gradient += weight * row;
  }
  const Eigen::VectorXd share =
      normal.topLeftCorner(unknowns, unknowns).ldlt().solve(gradient.head(unknowns));
  for (std::size_t i = 0; i < n; ++i) {
    if (window.is_flank(i)) weights[i] = -design.row(static_cast<Eigen::Index>(i)).dot(share);
  }
  const FlankNoise noise =
      flank_noise(alignment.difference, design, window.left, window.right, weights);
  result.sd = noise.sd;
  result.half_width = noise.half_width;
  result.correlation = noise.correlation;
  result.offset = alignment.line[0];
  result.tilt = alignment.line[1];
  result.noise = std::sqrt(variance);
  return result;
}

}  // namespace

WornArea worn_area(const Profile& before, const Profile& after, std::optional<double> flank,
                   double curvature) {
  check(before, "before");
  check(after, "after");
  const Overlap overlap = overlap_of(before, after, flank);
  const Window& window = overlap.window;
  const double middle = overlap.middle;
  const std::size_t n = window.x.size();
  const double spacing = (window.x.back() - window.x.front()) / static_cast<double>(n - 1);
  const std::optional<double> reported =
      best_shift(before, after, window, middle, spacing, overlap.farthest);
  const double best = reported.value_or(0);
  const auto moved = [&](double shift) {
    return [&before, at = middle + shift](double x) { return height_at(before, at + x); };
  };
  const Alignment alignment = align(moved(best), window.height, window);
  const double eps = 0.5 * spacing;
  const auto slope = [&](double x) {
    const double there = middle + x + best;
    return reported ? (height_at(before, there + eps) - height_at(before, there - eps)) / (2 * eps)
                    : 0;
  };
  WornArea result = area_between(window, alignment, reported ? 3 : 2, curvature, slope);
  result.from = middle + window.x[window.left];
  result.to = middle + window.x[window.right - 1];
  result.shift = best;
  result.flank_step = inner_step(moved(best), window);
  const auto degrees = static_cast<double>(window.flank_points());
  constexpr double least_independent = 6;
  // Wear in the flanks looks like correlated noise; the step reveals it.
  if (degrees < least_independent * result.correlation && !(result.flank_step > suspicious_step)) {
    throw InputError(fmt::format(
        "{:.3g} neighbouring points of the flanks are correlated, so their {} points count as no "
        "more than {:.2g} independent ones; {} are needed: use longer flanks",
        result.correlation, window.flank_points(), degrees / result.correlation,
        least_independent));
  }
  return result;
}

}  // namespace wearwell::bearing
