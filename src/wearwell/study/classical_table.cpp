#include "wearwell/study/classical_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/terminal_rows.h"

namespace wearwell {
namespace {

using present::Cell;
using Json = nlohmann::ordered_json;

constexpr Eigen::Index classical_starts = 8;

// "68.9 to 97.3"; "open" for an end that does not close.
std::string ends_text(const ProfileEnd& lower, const ProfileEnd& upper) {
  if (lower.open.empty() && upper.open.empty()) return plain_range(lower.value, upper.value);
  const auto end = [](const ProfileEnd& each) {
    return each.open.empty() ? plain_number(each.value) : std::string("open");
  };
  return end(lower) + " to " + end(upper);
}

// "14.5 to never" where a life may never end.
std::string posterior_text(double lower, double upper) {
  if (std::isfinite(upper)) return plain_range(lower, upper);
  return std::isfinite(lower) ? plain_number(lower) + " to never" : "never";
}

Json end_json(const ProfileEnd& lower, const ProfileEnd& upper) {
  Json json = {{"lower", lower.value}, {"upper", upper.value}};
  if (!lower.open.empty()) json["lower_open"] = lower.open;
  if (!upper.open.empty()) json["upper_open"] = upper.open;
  return json;
}

bool any_exact(std::span<const ClassicalEstimate> estimates) {
  return std::any_of(estimates.begin(), estimates.end(),
                     [](const ClassicalEstimate& each) { return each.exact.has_value(); });
}

}  // namespace

MaximumLikelihood maximum_of(std::shared_ptr<const LogDensity> likelihood,
                             const std::vector<NormalScale>& scales,
                             const std::vector<Parameter>& parameters, const WeightedDraws& draws) {
  const auto n = static_cast<Eigen::Index>(scales.size());
  std::vector<Eigen::VectorXd> starts(1, Eigen::VectorXd(n));
  Eigen::VectorXd widths(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Parameter& parameter = parameters[static_cast<std::size_t>(i)];
    starts[0][i] = parameter.start;
    const Eigen::ArrayXd own = draws.values.col(i).array();
    const double sd = std::sqrt((own - own.mean()).square().mean());
    widths[i] = sd > 0 && std::isfinite(sd) ? sd : parameter.scale;
  }
  for (Eigen::Index i = 0; i < classical_starts; ++i)
    starts.push_back(draws.values.row((2 * i + 1) * draws.values.rows() / (2 * classical_starts)));
  return {std::move(likelihood), scales, starts, widths};
}

void set_bounds(ClassicalEstimate& estimate, const ClassicalBounds& bounds,
                const std::function<double(double)>& shown) {
  const double by = 1e-4 * bounds.error;
  const auto end = [&](const ProfileEnd& open) {
    return open.open.empty() ? ProfileEnd{shown(open.value), ""} : open;
  };
  estimate.value = shown(bounds.estimate);
  estimate.standard_error =
      std::abs(shown(bounds.estimate + by) - shown(bounds.estimate - by)) / (2 * by) * bounds.error;
  estimate.lower = shown(bounds.lower);
  estimate.upper = shown(bounds.upper);
  estimate.ratio_lower = end(bounds.likelihood_ratio.lower);
  estimate.ratio_upper = end(bounds.likelihood_ratio.upper);
}

std::string confidence_text(const ClassicalLevel& level) {
  const std::string percent = fmt::format("{:.6g} %", 100 * level.level);
  return level.two_sided ? "two-sided bounds with " + percent + " confidence"
                         : "one-sided bounds with " + percent + " confidence each";
}

// Exact bounds stand first and words last, because a screen may be narrower than the table. The text
// around it says what is exact.
present::Table estimate_table(std::span<const ClassicalEstimate> estimates,
                              const ClassicalLevel& level) {
  present::Table table{"maximum-likelihood-estimates",
                       "Maximum likelihood, " + confidence_text(level),
                       {{"Quantity"}, {"Unit"}, {"Estimate"}}};
  const bool exact = any_exact(estimates);
  const auto add_columns = [&](std::initializer_list<const char*> names) {
    for (const char* name : names) table.columns.push_back({name});
  };
  if (exact) add_columns({"Exact, lower", "Exact, upper"});
  add_columns({"Standard error", "Normal, lower", "Normal, upper", "Likelihood ratio, lower",
               "Likelihood ratio, upper", "Posterior, lower", "Posterior, upper", "Normal scale"});
  const auto end = [](const ProfileEnd& each) -> Cell {
    return each.open.empty() ? Cell(each.value) : Cell("open: " + each.open);
  };
  for (const ClassicalEstimate& each : estimates) {
    if (!std::isfinite(each.value)) {
      std::vector<Cell> row = {each.name, each.unit, Cell("not finite")};
      row.resize(table.columns.size() - 3);
      row.insert(row.end(), {each.posterior_lower, each.posterior_upper, each.scale});
      table.rows.push_back(std::move(row));
      continue;
    }
    std::vector<Cell> row = {each.name, each.unit, each.value};
    if (exact && each.exact) row.insert(row.end(), {each.exact->lower, each.exact->upper});
    if (exact && !each.exact) row.insert(row.end(), 2, Cell());
    row.insert(row.end(),
               {each.standard_error, each.lower, each.upper, end(each.ratio_lower),
                end(each.ratio_upper), each.posterior_lower, each.posterior_upper, each.scale});
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string estimate_text(std::span<const ClassicalEstimate> estimates) {
  std::vector<std::vector<std::string>> rows = {
      {"", "estimate", "standard error", "normal", "likelihood ratio", "posterior"}};
  const bool exact = any_exact(estimates);
  if (exact) rows[0].insert(rows[0].begin() + 2, "exact");
  for (const ClassicalEstimate& each : estimates) {
    const std::string name =
        printable_heading(numbers_text(each.name, Script::terminal), each.unit);
    // The mean of a distribution with a long tail, or a life that most never reach.
    if (!std::isfinite(each.value)) {
      rows.emplace_back(rows[0].size(), "-");
      rows.back()[0] = name;
      rows.back()[1] = "not finite";
      rows.back().back() = posterior_text(each.posterior_lower, each.posterior_upper);
      continue;
    }
    rows.push_back({name, plain_number(each.value), plain_number(each.standard_error),
                    plain_range(each.lower, each.upper),
                    ends_text(each.ratio_lower, each.ratio_upper),
                    posterior_text(each.posterior_lower, each.posterior_upper)});
    if (exact)
      rows.back().insert(rows.back().begin() + 2,
                         each.exact ? plain_range(each.exact->lower, each.exact->upper) : "-");
  }
  return text_table(rows);
}

Json estimate_json(const ClassicalEstimate& each) {
  Json json = {{"name", each.name}};
  if (!each.of.empty()) json["of"] = each.of;
  if (!each.of.empty() || !each.at.empty()) json["at"] = each.at;
  json.update({{"unit", each.unit},
               {"value", each.value},
               {"standard_error", each.standard_error},
               {"normal_scale", each.scale},
               {"normal", {{"lower", each.lower}, {"upper", each.upper}}},
               {"likelihood_ratio", end_json(each.ratio_lower, each.ratio_upper)},
               {"posterior", {{"lower", each.posterior_lower}, {"upper", each.posterior_upper}}}});
  if (each.exact)
    json["exact"] = {
        {"lower", each.exact->lower}, {"upper", each.exact->upper}, {"method", each.exact->method}};
  return json;
}

}  // namespace wearwell
