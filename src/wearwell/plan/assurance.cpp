#include "wearwell/plan/assurance.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <map>
#include <optional>

namespace wearwell::plan {
namespace {

double standard_cdf(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}
double standard_pdf(double z) {
  return std::exp(-0.5 * z * z) / std::sqrt(2 * M_PI);
}

struct ProbitLine {
  double intercept = 0, slope = 0;
};

// By Fisher scoring; empty if it does not increase or diverges (separated points).
std::optional<ProbitLine> probit_line(const std::vector<AssurancePoint>& points) {
  ProbitLine line{0, 0};
  // From the points' own probits, kept from infinity.
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const AssurancePoint& each : points) {
    const double x = std::log(static_cast<double>(each.size));
    const double p =
        (static_cast<double>(each.narrow) + 0.5) / (static_cast<double>(each.runs) + 1);
    const double y = quantile(boost::math::normal(), p);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const auto n = static_cast<double>(points.size());
  const double spread = sxx - sx * sx / n;
  if (!(spread > 0)) return {};
  line.slope = (sxy - sx * sy / n) / spread;
  line.intercept = (sy - line.slope * sx) / n;
  for (int i = 0; i < 100; ++i) {
    double ga = 0, gb = 0, h_aa = 0, h_ab = 0, h_bb = 0;
    for (const AssurancePoint& each : points) {
      const double x = std::log(static_cast<double>(each.size));
      const double z = std::clamp(line.intercept + line.slope * x, -6.0, 6.0);
      const double p = standard_cdf(z), density = standard_pdf(z);
      const double information = static_cast<double>(each.runs) * density * density / (p * (1 - p));
      const double score = (static_cast<double>(each.narrow) - static_cast<double>(each.runs) * p) *
                           density / (p * (1 - p));
      ga += score, gb += score * x;
      h_aa += information, h_ab += information * x, h_bb += information * x * x;
    }
    const double determinant = h_aa * h_bb - h_ab * h_ab;
    if (!(determinant > 1e-12 * h_aa * h_bb)) return {};
    const double da = (h_bb * ga - h_ab * gb) / determinant;
    const double db = (h_aa * gb - h_ab * ga) / determinant;
    line.intercept += da;
    line.slope += db;
    if (std::abs(da) + std::abs(db) < 1e-10) break;
  }
  if (!(line.slope > 0) || !std::isfinite(line.intercept)) return {};
  return line;
}

SmallestSize smallest_of(const std::vector<AssurancePoint>& points, std::size_t bisected,
                         double target) {
  SmallestSize smallest{bisected, static_cast<double>(bisected), static_cast<double>(bisected),
                        false};
  const auto between = std::count_if(points.begin(), points.end(), [](const auto& each) {
    return each.share() > 0.02 && each.share() < 0.98;
  });
  const std::optional<ProbitLine> line = between >= 2 ? probit_line(points) : std::nullopt;
  if (!line) return smallest;
  const double z = quantile(boost::math::normal(), target);
  const double at = (z - line->intercept) / line->slope;
  const double runs = static_cast<double>(points.front().runs);
  const double error = std::sqrt(target * (1 - target) / runs) / (standard_pdf(z) * line->slope);
  smallest.size = static_cast<std::size_t>(std::max(1.0, std::ceil(std::exp(at) * (1 - 1e-9))));
  smallest.low = std::exp(at - error);
  smallest.high = std::exp(at + error);
  smallest.smoothed = true;
  return smallest;
}

}  // namespace

double AssurancePoint::error() const {
  return std::sqrt(share() * (1 - share()) / static_cast<double>(runs));
}

AssuranceSearch search_assurance(const std::function<AssurancePoint(std::size_t size)>& at,
                                 std::size_t first, std::size_t most, double target) {
  AssuranceSearch search;
  std::map<std::size_t, AssurancePoint> tried;
  const auto reaches = [&](std::size_t size) {
    auto found = tried.find(size);
    if (found == tried.end()) found = tried.emplace(size, at(size)).first;
    return found->second.share() >= target;
  };
  std::size_t high = std::min(first, most), low = 0;
  while (!reaches(high) && high < most) {
    low = high;
    high = std::min(2 * high, most);
  }
  search.reached = reaches(high);
  // Closer than one share's Monte Carlo error the line says more than further points.
  const auto apart = [&] {
    if (low == 0 || tried.size() < 6) return true;
    const AssurancePoint &a = tried.at(low), &b = tried.at(high);
    return a.share() < 0.02 || b.share() > 0.98 || b.share() - a.share() > b.error();
  };
  while (search.reached && high - low > 1 && apart()) {
    const double middle = low == 0
                              ? 0.5 * static_cast<double>(high)
                              : std::sqrt(static_cast<double>(low) * static_cast<double>(high));
    const std::size_t size =
        std::clamp(static_cast<std::size_t>(std::lround(middle)), low + 1, high - 1);
    (reaches(size) ? high : low) = size;
  }
  for (const auto& [_, point] : tried) search.points.push_back(point);
  if (search.reached) search.smallest = smallest_of(search.points, high, target);
  return search;
}

}  // namespace wearwell::plan
