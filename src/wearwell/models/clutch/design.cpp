#include "wearwell/models/clutch/design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"

namespace wearwell::clutch {
namespace {

constexpr int candidates_per_kind = 6000;
constexpr int most_exchanges = 20;  // rounds over all points

void check(const DesignRequest& request) {
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto& levels = request.levels[i];
    const char* name = inputs[i].name;
    if (levels.size() < 2) throw InputError(fmt::format("{} needs at least two levels", name));
    for (std::size_t l = 0; l < levels.size(); ++l) {
      if (!std::isfinite(levels[l]) || (l > 0 && !(levels[l] > levels[l - 1])))
        throw InputError(fmt::format("levels of {} must ascend", name));
    }
    if (!(request.lowest[i] <= levels.front() && request.highest[i] >= levels.back()))
      throw InputError(fmt::format("the feasible range of {} must contain all its levels", name));
  }
  if (request.inside < 0 || request.outside < 0)
    throw InputError("a number of points must not be negative");
}

bool is_inside(const DesignRequest& request, const OperatingPoint& at) {
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const double x = at.*inputs[i].value;
    if (x < request.levels[i].front() || x > request.levels[i].back()) return false;
  }
  return true;
}

bool is_feasible(const DesignRequest& request, const OperatingPoint& at) {
  return request.most_energy <= 0 || closing_energy(at) <= request.most_energy;
}

std::vector<OperatingPoint> factorial(const DesignRequest& request) {
  std::vector<OperatingPoint> points(1);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    std::vector<OperatingPoint> more;
    for (const OperatingPoint& point : points) {
      for (const double level : request.levels[i]) {
        more.push_back(point);
        more.back().*inputs[i].value = level;
      }
    }
    points = std::move(more);
  }
  return points;
}

std::vector<OperatingPoint> draw_candidates(const DesignRequest& request, bool inside) {
  Rng rng(request.seed, inside ? 0 : 1);
  std::vector<OperatingPoint> candidates;
  for (int tries = 0; std::ssize(candidates) < candidates_per_kind; ++tries) {
    if (tries == 1000 * candidates_per_kind)
      throw InputError(inside ? "no point inside the levels is feasible: raise the energy limit"
                              : "no point outside the levels is feasible: widen the ranges");
    OperatingPoint at;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const double low = inside ? request.levels[i].front() : request.lowest[i];
      const double high = inside ? request.levels[i].back() : request.highest[i];
      double x = rng.uniform(low, high);
      if (request.step[i] > 0) x = request.step[i] * std::round(x / request.step[i]);
      at.*inputs[i].value = std::clamp(x, low, high);
    }
    if (is_inside(request, at) == inside && is_feasible(request, at)) candidates.push_back(at);
  }
  return candidates;
}

/// Distance to the nearest of `points`, except the one numbered `without`; or any distance up to
/// `useless`, if there is one.
double nearest(const DesignRequest& request, const OperatingPoint& at,
               const std::vector<OperatingPoint>& points, std::size_t without,
               double useless = -1) {
  double least = INFINITY;
  for (std::size_t p = 0; p < points.size() && least > useless; ++p) {
    if (p != without) least = std::min(least, design_distance(request, at, points[p]));
  }
  return least;
}

/// Adds `count` of the candidates to `points`, far from them and from each other.
void spread(const DesignRequest& request, const std::vector<OperatingPoint>& candidates, int count,
            std::vector<OperatingPoint>& points) {
  const auto farthest = [&](std::size_t without) {
    const OperatingPoint* best = nullptr;
    double most = -1;
    for (const OperatingPoint& candidate : candidates) {
      const double distance = nearest(request, candidate, points, without, most);
      if (distance > most) {
        most = distance;
        best = &candidate;
      }
    }
    return std::pair(*best, most);
  };
  const std::size_t first = points.size();
  for (int i = 0; i < count; ++i) points.push_back(farthest(points.size()).first);
  for (int round = 0; round < most_exchanges; ++round) {
    bool better = false;
    for (std::size_t p = first; p < points.size(); ++p) {
      const auto [at, distance] = farthest(p);
      if (distance > nearest(request, points[p], points, p) * (1 + 1e-12)) {
        points[p] = at;
        better = true;
      }
    }
    if (!better) return;
  }
}

}  // namespace

const char* name_of(Role role) {
  static constexpr const char* names[] = {"model", "extrapolation", "validation"};
  return names[static_cast<int>(role)];
}

Role read_role(const std::string& name) {
  for (const Role role : {Role::model, Role::extrapolation, Role::validation}) {
    if (name == name_of(role)) return role;
  }
  throw InputError(
      fmt::format("role '{}' is unknown; use 'model', 'extrapolation' or 'validation'", name));
}

double design_distance(const DesignRequest& request, const OperatingPoint& a,
                       const OperatingPoint& b) {
  double sum = 0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto& levels = request.levels[i];
    const double d = (a.*inputs[i].value - b.*inputs[i].value) / (levels.back() - levels.front());
    sum += d * d;
  }
  return std::sqrt(sum);
}

std::vector<DesignPoint> plan(const DesignRequest& request) {
  check(request);
  std::vector<OperatingPoint> points = factorial(request);
  const std::size_t in_factorial = points.size();
  for (const OperatingPoint& at : points) {
    if (!is_feasible(request, at))
      throw InputError(fmt::format("a closing of the factorial takes {:.6g} J, more than feasible",
                                   closing_energy(at)));
  }
  if (request.outside > 0)
    spread(request, draw_candidates(request, false), request.outside, points);
  const std::size_t modelled = points.size();
  if (request.inside > 0) spread(request, draw_candidates(request, true), request.inside, points);

  std::vector<DesignPoint> design;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Role role = p < in_factorial ? Role::model
                      : p < modelled   ? Role::extrapolation
                                       : Role::validation;
    design.push_back({static_cast<int>(p) + 1, role, points[p]});
  }
  return design;
}

}  // namespace wearwell::clutch
