#include "wearwell/workbench/family_papers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "wearwell/math/minimizer.h"
#include "wearwell/prob/gathered_responses.h"
#include "wearwell/prob/standard_distribution.h"

namespace wearwell::workbench {
namespace {

using Numbers = std::vector<double>;

constexpr std::size_t gathered_above = 1000, line_points = 40;

// A parameter that leaves its start by more than this, as a logarithm, has no maximum on the way.
constexpr double farthest = 12;

// Of the log-likelihood per item: the maximum is then found to all digits that are shown.
constexpr double flat_slope = 1e-5;

// Few responses with the same sum of log densities.
std::vector<WeightedResponse> weighted(std::span<const Response> responses,
                                       std::span<const int> counts) {
  const Numbers weights(counts.begin(), counts.end());
  if (responses.size() > gathered_above) return gathered_responses(responses, weights, true);
  std::vector<WeightedResponse> all;
  for (std::size_t i = 0; i < responses.size(); ++i) all.push_back({responses[i], weights[i]});
  return all;
}

bool is_positive(const ParameterForm& parameter) {
  return parameter.kind == ParameterKind::scale || parameter.kind == ParameterKind::number;
}

// The negative log-likelihood of parameters on their scales: logarithms of the positive ones.
class Misfit {
 public:
  Misfit(const ResponseForm& form, std::span<const Response> responses, std::span<const int> counts)
      : form_(form), data_(weighted(responses, counts)) {}

  double items() const {
    double sum = 0;
    for (const WeightedResponse& each : data_) sum += each.weight;
    return sum;
  }

  Numbers parameters(std::span<const double> x) const {
    Numbers values(most_response_parameters, 0.0);
    for (std::size_t i = 0; i < x.size(); ++i)
      values[i] = is_positive(form_.family_parameters[i]) ? std::exp(x[i]) : x[i];
    return values;
  }

  double operator()(std::span<const double> x, std::span<double> gradient) const {
    const Numbers values = parameters(x);
    double sum = 0;
    std::fill(gradient.begin(), gradient.end(), 0.0);
    for (const WeightedResponse& each : data_) {
      const ResponseTerm term = log_response(form_.family, each.response, values.data());
      sum -= each.weight * term.value;
      for (std::size_t i = 0; i < gradient.size(); ++i)
        gradient[i] -=
            each.weight * term.slope[i] * (is_positive(form_.family_parameters[i]) ? values[i] : 1);
    }
    return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
  }

 private:
  const ResponseForm& form_;
  std::vector<WeightedResponse> data_;
};

// Mean and standard deviation of the logarithms of lives, where censored ones count as they stand.
struct LogMoments {
  double mean = 0, sd = 1;
};

LogMoments log_moments(std::span<const Response> responses, std::span<const int> counts) {
  double n = 0, sum = 0, squares = 0;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    const Response& each = responses[i];
    const double at = each.seen == Censoring::interval ? 0.5 * (each.at + each.until) : each.at;
    if (!(at > 0)) continue;
    n += counts[i];
    sum += counts[i] * std::log(at);
    squares += counts[i] * std::log(at) * std::log(at);
  }
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(squares / n - mean * mean, 1e-8))};
}

// Parameters of a family with about these moments of log life, on their scales. The shape of a gamma
// distribution is about 1/sd^2, that of an inverse Gaussian one mean/sd^2.
std::vector<Numbers> starts_of(const ResponseForm& form, LogMoments log) {
  const std::string_view name = form.name;
  const double m = log.mean, s = log.sd;
  const auto shape = [&](double sd_of_standard) { return std::log(sd_of_standard / s); };
  if (name == "lognormal" || name == "birnbaum-saunders") return {{m, std::log(s)}};
  if (name == "loglogistic") return {{m, shape(1.8138)}};
  if (name == "weibull") return {{m + 0.45 * s, shape(1.2825)}};
  if (name == "frechet") return {{m - 0.45 * s, shape(1.2825)}};
  if (name == "gamma") return {{-2 * std::log(s), m + 2 * std::log(s)}};
  if (name == "inverse-gaussian") return {{m + 0.5 * s * s, m - 2 * std::log(s)}};
  if (name == "exponentiated-weibull")
    return {{m + 0.45 * s, shape(1.2825), 0.0}, {m - s, shape(0.9), 1.0}};
  if (name == "generalized-gamma")
    return {{m, std::log(s), 0.0}, {m + 0.45 * s, std::log(s / 1.2825), 1.0}};
  throw std::logic_error("no start for this family");
}

}  // namespace

std::optional<FittedFamily> fitted_family(const ResponseForm& form,
                                          std::span<const Response> responses,
                                          std::span<const int> counts) {
  const Misfit misfit(form, responses, counts);
  const double items = misfit.items();
  // Of one item, whatever their number: the first step of a minimizer is as long as the slope.
  const auto mean_misfit = [&](std::span<const double> x, std::span<double> slope) {
    const double sum = misfit(x, slope);
    for (double& each : slope) each /= items;
    return sum / items;
  };
  std::optional<FittedFamily> best;
  for (const Numbers& start : starts_of(form, log_moments(responses, counts))) {
    const Eigen::Map<const Eigen::VectorXd> x0(start.data(),
                                               static_cast<Eigen::Index>(start.size()));
    const Minimum found = minimize(mean_misfit, x0);
    if (!std::isfinite(found.value) || (found.position - x0).cwiseAbs().maxCoeff() > farthest ||
        (best && best->log_likelihood >= -items * found.value))
      continue;
    const std::span<const double> position(found.position.data(), start.size());
    Numbers slope(start.size());
    mean_misfit(position, slope);
    if (std::any_of(slope.begin(), slope.end(),
                    [](double each) { return !(std::abs(each) <= flat_slope); }))
      continue;
    Numbers parameters = misfit.parameters(position);
    parameters.resize(start.size());
    best = FittedFamily{&form, std::move(parameters), -items * found.value};
  }
  return best;
}

const ResponseForm& form_named(std::string_view name) {
  for (const ResponseForm& each : response_forms())
    if (each.name == name) return each;
  throw std::logic_error("no family of this name");
}

std::vector<PlottingPosition> on_paper(const Paper& paper, std::vector<PlottingPosition> positions,
                                       std::size_t most) {
  // The last one is 1 where the longest life is a failure of a step without a middle.
  std::erase_if(positions,
                [](const PlottingPosition& each) { return !(each.p > 0 && each.p < 1); });
  if (positions.size() > most) {
    const double apart = static_cast<double>(positions.size() - 1) / static_cast<double>(most - 1);
    for (std::size_t i = 0; i < most; ++i)
      positions[i] =
          positions[static_cast<std::size_t>(std::lround(apart * static_cast<double>(i)))];
    positions.resize(most);
  }
  for (PlottingPosition& each : positions) each.p = quantile(paper.distribution, each.p);
  return positions;
}

std::vector<PlottingPosition> line_on_paper(const FittedFamily& fitted, double low, double high) {
  const StandardDistribution paper = fitted.form->paper.distribution;
  Numbers parameters = fitted.parameters;
  parameters.resize(most_response_parameters, 0.0);
  const double from = quantile(paper, low), to = quantile(paper, high);
  std::vector<PlottingPosition> line;
  for (std::size_t i = 0; i <= line_points; ++i) {
    const double z = std::lerp(from, to, static_cast<double>(i) / line_points);
    const double life = quantile(fitted.form->family, cdf(paper, z), parameters.data());
    if (life > 0 && std::isfinite(life)) line.push_back({life, z});
  }
  return line;
}

}  // namespace wearwell::workbench
