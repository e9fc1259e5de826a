#include "wearwell/plan/planning_value.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/trimmed.h"
#include "wearwell/input/option_value.h"
#include "wearwell/input/prior.h"

namespace wearwell::plan {
namespace {

// "A to B"; a first end without a unit has that of the second.
std::optional<std::pair<std::string, std::string>> ends_of(const std::string& text) {
  const std::size_t middle = text.find(" to ");
  if (middle == std::string::npos) return std::nullopt;
  std::string low(trimmed(text.substr(0, middle)));
  const std::string high(trimmed(text.substr(middle + 4)));
  const bool bare = low.find_first_not_of("0123456789.eE+-") == std::string::npos;
  const std::size_t unit = high.find_first_of(" %");
  if (bare && unit != std::string::npos) low.append(" ").append(trimmed(high.substr(unit)));
  return std::pair(low, high);
}

void refuse_order(const std::string& option, const std::string& text, double low, double high) {
  if (!(low < high))
    throw InputError(fmt::format("{}: '{}': the first end of an interval must be below the second",
                                 option, printable(text)));
}

PlanningValue lognormal_between(const std::string& text, double low, double high) {
  const double middle = 0.5 * (std::log(low) + std::log(high));
  const double sd = (std::log(high) - std::log(low)) / (2 * z95);
  return {text, true, [=](double z) { return std::exp(middle + sd * z); },
          "90 % interval of a lognormal distribution"};
}

// "lognormal, median = 2, log_sd = 0.2" as an entry of [prior].
PlanningValue of_prior(const std::string& option, const std::string& text) {
  const std::size_t comma = text.find(',');
  const std::string entry =
      text.front() == '{'
          ? text
          : fmt::format("{{ distribution = \"{}\"{} }}", trimmed(text.substr(0, comma)),
                        comma == std::string::npos ? "" : text.substr(comma));
  Parameter parameter;
  try {
    const TomlReader reader = TomlReader::parse({option, "value = " + entry + "\n"});
    parameter = read_prior(reader, {"value", "1", 0});
    reader.finish();
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("{}: '{}' must be a number like 2, an interval like '1.5 to 3', or a prior "
                    "like 'lognormal, median = 2, log_sd = 0.2': {}",
                    option, printable(text), error.what()));
  }
  if (!parameter.prior.proper)
    throw InputError(fmt::format("{}: '{}' has no finite integral; a plan needs a proper prior",
                                 option, printable(text)));
  const Distribution prior = parameter.prior;
  return {text, true,
          [prior](double z) { return quantile(prior, cdf(StandardDistribution::normal, z)); },
          "prior"};
}

bool begins_with_letter(const std::string& text) {
  return !text.empty() &&
         (std::isalpha(static_cast<unsigned char>(text.front())) || text.front() == '{');
}

}  // namespace

PlanningValue known_value(double value) {
  return {fmt::format("{:.6g}", value), false, [value](double) { return value; }, {}};
}

PlanningValue read_planning_value(const std::string& option, const std::string& text) {
  if (begins_with_letter(text)) return of_prior(option, text);
  return read_planning_quantity(option, text, "1");
}

PlanningValue read_planning_quantity(const std::string& option, const std::string& text,
                                     const std::string& si) {
  if (const auto ends = ends_of(text)) {
    const double low = option_value(option, ends->first, si, Allowed::positive),
                 high = option_value(option, ends->second, si, Allowed::positive);
    refuse_order(option, text, low, high);
    return lognormal_between(text, low, high);
  }
  const double value = option_value(option, text, si, Allowed::positive);
  return {text, false, [value](double) { return value; }, {}};
}

PlanningValue read_planning_share(const std::string& option, const std::string& text,
                                  StandardDistribution distribution) {
  const auto share = [&](const std::string& word) {
    const double value = option_value(option, word, "1");
    if (!(value > 0 && value < 1))
      throw InputError(fmt::format("{}: '{}' must lie above 0 % and below 100 %, like '0.1 %'",
                                   option, printable(word)));
    return value;
  };
  if (const auto ends = ends_of(text)) {
    const double low = share(ends->first), high = share(ends->second);
    refuse_order(option, text, low, high);
    const double a = quantile(distribution, low), b = quantile(distribution, high);
    const double middle = 0.5 * (a + b), sd = (b - a) / (2 * z95);
    return {text, true, [=](double z) { return cdf(distribution, middle + sd * z); },
            "90 % interval"};
  }
  const double value = share(text);
  return {text, false, [value](double) { return value; }, {}};
}

std::vector<NormalNode> normal_nodes(int n) {
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(n), off(n - 1);
  for (int i = 1; i < n; ++i) off[i - 1] = std::sqrt(i);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, off);
  std::vector<NormalNode> nodes;
  for (int i = 0; i < n; ++i)
    nodes.push_back(
        {solver.eigenvalues()[i], solver.eigenvectors()(0, i) * solver.eigenvectors()(0, i)});
  return nodes;
}

}  // namespace wearwell::plan
