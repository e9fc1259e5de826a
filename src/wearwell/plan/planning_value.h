#pragma once

#include <functional>
#include <string>
#include <vector>

#include "wearwell/prob/standard_distribution.h"

namespace wearwell::plan {

/// A value that a plan assumes before any test: a number, or a distribution that says how well it
/// is known. `at` maps a standard normal score to the value: `at(0)` is the median, `at(z05)` and
/// `at(z95)` bound its 90 % interval.
struct PlanningValue {
  std::string text;        ///< as written
  bool uncertain = false;  ///< a distribution, not a number
  std::function<double(double)> at = {};
  std::string prior = {};  ///< "90 % interval of a lognormal distribution", if uncertain
};
inline constexpr double z95 = 1.6448536269514722, z05 = -z95;

/// A value that is known.
PlanningValue known_value(double value);

/// Reads a positive number without unit: "2", "1.5 to 3" (the 90 % interval of a lognormal
/// distribution), or a prior as in a study: "lognormal, median = 2, log_sd = 0.2", with any family
/// of docs/reference/priors.md. Throws InputError that begins with `option`.
PlanningValue read_planning_value(const std::string& option, const std::string& text);

/// The same for a quantity of the dimension of the SI unit `si`, in SI: "0.7 eV", "0.65 eV to 0.8
/// eV", "0.65 to 0.8 eV".
PlanningValue read_planning_quantity(const std::string& option, const std::string& text,
                                     const std::string& si);

/// The same for a share between 0 and 1: "0.1 %", "0.05 % to 0.2 %". An interval is normal on the
/// scale of the standard quantiles of `distribution`.
PlanningValue read_planning_share(const std::string& option, const std::string& text,
                                  StandardDistribution distribution);

/// A score of a standard normal distribution and its weight.
struct NormalNode {
  double z, weight;
};

/// Gauss-Hermite rule for expectations over a standard normal distribution (Golub and Welsch 1969):
/// exact for polynomials up to degree 2n - 1.
std::vector<NormalNode> normal_nodes(int n);

}  // namespace wearwell::plan
