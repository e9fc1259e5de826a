#include "wearwell/study/inference_data.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/bayes/observation.h"

namespace wearwell {
namespace {

using netcdf::Group;
using netcdf::plain_name;
using netcdf::Variable;

// Random streams from this number on are not used by chains or stages.
constexpr std::uint64_t predictive_stream = std::uint64_t{1} << 40;

std::size_t chains_of(const PosteriorSummary& result) {
  return result.posterior_draws.size();
}

std::size_t draws_of(const PosteriorSummary& result) {
  const Draws& draws = result.posterior_draws;
  return draws.empty() ? 0 : static_cast<std::size_t>(draws.front().values.rows());
}

// A draw in the likelihood's parametrization.
std::vector<double> natural(const PosteriorStudy& study, const Chain& chain, std::size_t draw) {
  std::vector<double> x;
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    x.push_back(to_si(study.parameters[p].unit,
                      chain.values(static_cast<Eigen::Index>(draw), static_cast<Eigen::Index>(p))));
  }
  return x;
}

std::string now() {
  const std::time_t time = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&time, &utc);
  char text[32];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S+00:00", &utc)};
}

netcdf::Attributes who(const PosteriorSummary& result) {
  return {{"created_at", now()},
          {"inference_library", "wearwell"},
          {"inference_library_version", result.version}};
}

// Coordinates 0, 1, ...
Variable counted(const std::string& name, std::size_t size) {
  std::vector<std::int64_t> values(size);
  for (std::size_t i = 0; i < size; ++i) values[i] = static_cast<std::int64_t>(i);
  return {name, {name}, std::move(values)};
}

Group drawn(const std::string& name, const PosteriorSummary& result) {
  Group group{name,
              {{"chain", chains_of(result)}, {"draw", draws_of(result)}},
              {counted("chain", chains_of(result)), counted("draw", draws_of(result))},
              who(result)};
  return group;
}

// For every draw of every chain.
template <class T, class Value>
std::vector<T> gathered(const PosteriorSummary& result, const Value& value) {
  std::vector<T> all;
  for (const Chain& chain : result.posterior_draws) {
    for (std::size_t d = 0; d < draws_of(result); ++d) {
      all.push_back(static_cast<T>(value(chain, d)));
    }
  }
  return all;
}

Group posterior_group(const PosteriorSummary& result, const std::string& left_out) {
  Group group = drawn("posterior", result);
  for (std::size_t p = 0; p < result.parameters.size(); ++p) {
    const ParameterSummary& parameter = result.parameters[p];
    Variable variable{plain_name(parameter.name),
                      {"chain", "draw"},
                      gathered<double>(result,
                                       [&](const Chain& chain, std::size_t d) {
                                         return chain.values(static_cast<Eigen::Index>(d),
                                                             static_cast<Eigen::Index>(p));
                                       }),
                      {{"units", parameter.unit}, {"prior", parameter.prior}}};
    if (variable.name != parameter.name) {
      variable.attributes.emplace_back("name", parameter.name);
    }
    group.variables.push_back(std::move(variable));
  }
  group.attributes.insert(group.attributes.end(), {{"title", result.title},
                                                   {"model", result.model},
                                                   {"equation", result.equation},
                                                   {"sampler", result.method},
                                                   {"seed", fmt::format("{}", result.seed)},
                                                   {"trusted", result.trusted ? "yes" : "no"}});
  if (!left_out.empty()) group.attributes.emplace_back("left_out", left_out);
  return group;
}

Group sample_stats(const PosteriorSummary& result) {
  Group group = drawn("sample_stats", result);
  const auto add = [&](const char* name, auto values) {
    group.variables.push_back({name, {"chain", "draw"}, std::move(values)});
  };
  add("lp", gathered<double>(
                result, [](const Chain& chain, std::size_t d) { return chain.log_density[d]; }));
  if (result.posterior_draws.empty() || result.posterior_draws.front().nuts.empty()) return group;
  const auto each = [&](auto type, const auto& value) {
    return gathered<decltype(type)>(
        result, [&](const Chain& chain, std::size_t d) { return value(chain.nuts[d]); });
  };
  using Whole = std::int64_t;
  add("acceptance_rate", each(0.0, [](const NutsStep& s) { return s.accept_stat; }));
  add("step_size",
      gathered<double>(result, [](const Chain& chain, std::size_t) { return chain.step_size; }));
  add("tree_depth", each(Whole{}, [](const NutsStep& s) { return s.treedepth; }));
  add("n_steps", each(Whole{}, [](const NutsStep& s) { return s.n_leapfrog; }));
  using Flag = Variable::Flags::value_type;
  add("diverging", each(Flag{}, [](const NutsStep& s) { return s.divergent ? 1 : 0; }));
  add("energy", each(0.0, [](const NutsStep& s) { return s.energy; }));
  return group;
}

// The formula names the columns that it measures; "worn volume" names the column of its values.
bool is_observed(const PosteriorStudy& study, const DataColumn& column) {
  const std::string names = ", " + study.quantity + ",";
  const auto named = [&](const DataColumn& each) {
    return names.find(", " + each.name + ",") != std::string::npos;
  };
  const bool any = std::any_of(study.data_columns.begin(), study.data_columns.end(), named);
  return any ? named(column) : column.values == study.observed;
}

Group data_group(const std::string& name, const PosteriorStudy& study,
                 const PosteriorSummary& result, bool observed) {
  Group group{name, {}, {}, who(result)};
  for (const DataColumn& column : study.data_columns) {
    if (is_observed(study, column) != observed) continue;
    const std::string rows = column.values.size() == study.data_rows
                                 ? "row"
                                 : fmt::format("{}_row", plain_name(column.name));
    if (std::none_of(group.dimensions.begin(), group.dimensions.end(),
                     [&](const auto& each) { return each.name == rows; })) {
      group.dimensions.push_back({rows, column.values.size()});
      group.variables.push_back(counted(rows, column.values.size()));
    }
    std::vector<double> values;
    for (const double x : column.values) values.push_back(from_si(column.unit, x));
    group.variables.push_back(
        {plain_name(column.name), {rows}, std::move(values), {{"units", column.unit.text}}});
  }
  if (observed && group.variables.empty() && !study.observed.empty()) {
    group.dimensions = {{"observed", study.observed.size()}};
    group.variables = {{"observations", {"observed"}, study.observed, {{"units", "SI"}}}};
  }
  return group;
}

// The common name of the observations in log_likelihood and observed_data, if there is one.
std::string observed_name(const Group& observed) {
  std::set<std::string> names;
  for (const Variable& each : observed.variables) {
    if (each.dimensions != std::vector{each.name}) names.insert(each.name);
  }
  return names.size() == 1 ? *names.begin() : "observations";
}

Group likelihood_group(const PosteriorStudy& study, const PosteriorSummary& result,
                       const std::vector<Eigen::MatrixXd>& terms, const std::string& name) {
  const auto observations = static_cast<std::size_t>(terms.front().cols());
  std::string noun = plain_name(study.observation);
  if (noun == name) noun += "_";
  Group group = drawn("log_likelihood", result);
  group.dimensions.push_back({noun, observations});
  group.variables.push_back(counted(noun, observations));
  std::vector<double> values;
  values.reserve(terms.size() * static_cast<std::size_t>(terms.front().size()));
  for (const Eigen::MatrixXd& chain : terms) {
    for (Eigen::Index d = 0; d < chain.rows(); ++d)
      for (Eigen::Index i = 0; i < chain.cols(); ++i) values.push_back(chain(d, i));
  }
  group.variables.push_back(
      {name, {"chain", "draw", noun}, std::move(values), {{"density_unit", study.density.text}}});
  return group;
}

Group predictive_group(const PosteriorSummary& result, std::vector<PredictiveDraws> predictions) {
  Group group = drawn("posterior_predictive", result);
  for (PredictiveDraws& each : predictions) {
    const std::string at = plain_name(each.quantity) + "_at";
    group.dimensions.push_back({at, each.at.size()});
    group.variables.push_back({at, {at}, each.at, {{"long_name", each.at_name}}});
    group.variables.push_back({plain_name(each.quantity),
                               {"chain", "draw", at},
                               std::move(each.values),
                               {{"units", each.unit}}});
  }
  return group;
}

}  // namespace

const PosteriorStudy& require_posterior_study(const Study& study) {
  const auto* posterior = dynamic_cast<const PosteriorStudy*>(&study);
  if (!posterior) {
    throw InputError(
        "this study has no posterior (a clutch campaign is a chain of fits), so there are no draws "
        "to write as NetCDF");
  }
  return *posterior;
}

std::vector<Eigen::MatrixXd> log_likelihood(const PosteriorStudy& study,
                                            const PosteriorSummary& result, std::string& why) {
  const std::shared_ptr<const LogDensity> likelihood = study.likelihood(study.data_rows);
  const std::size_t chains = chains_of(result), draws = draws_of(result);
  if (chains == 0 || draws == 0) return {};
  const std::size_t terms =
      likelihood->pointwise(natural(study, result.posterior_draws.front(), 0)).size();
  if (terms == 0) {
    why = "log_likelihood: the likelihood of this study does not factor over observations";
    return {};
  }
  std::vector<int> counts = likelihood->pointwise_counts();
  if (counts.empty()) counts.assign(terms, 1);
  std::size_t observations = 0;
  for (const int count : counts) observations += static_cast<std::size_t>(count);
  if (observations > most_log_likelihoods / (chains * draws)) {
    why = fmt::format("log_likelihood: {} observations at {} draws exceed the limit of {} values",
                      observations, chains * draws, most_log_likelihoods);
    return {};
  }
  std::vector<Eigen::MatrixXd> all(
      chains,
      Eigen::MatrixXd(static_cast<Eigen::Index>(draws), static_cast<Eigen::Index>(observations)));
  tbb::parallel_for(std::size_t{0}, chains * draws, [&](std::size_t i) {
    const std::size_t c = i / draws, d = i % draws;
    const std::vector<double> each =
        likelihood->pointwise(natural(study, result.posterior_draws[c], d));
    Eigen::Index column = 0;
    for (std::size_t t = 0; t < each.size(); ++t) {
      const double term = each[t] + (study.density.terms.empty() ? 0 : study.density.terms[t]);
      for (int n = 0; n < counts[t]; ++n) all[c](static_cast<Eigen::Index>(d), column++) = term;
    }
  });
  return all;
}

std::vector<PredictiveDraws> predictive_draws(const PosteriorStudy& study,
                                              const PosteriorSummary& result) {
  const std::size_t draws = draws_of(result);
  std::vector<PredictiveDraws> all;
  std::vector<std::vector<const PredictionRequest*>> requests;
  for (const PredictionRequest& request : study.predictions) {
    if (request.with_item) continue;  // a draw does not contain the item's own unknowns
    std::size_t at = 0;
    while (at < all.size() &&
           (all[at].quantity != request.quantity || all[at].unit != request.unit.text ||
            all[at].at_name != request.at_name))
      ++at;
    if (at == all.size()) {
      all.push_back({request.quantity, request.unit.text, request.at_name, {}, {}});
      requests.emplace_back();
    }
    all[at].at.push_back(request.at);
    requests[at].push_back(&request);
  }
  for (std::size_t q = 0; q < all.size(); ++q) {
    for (std::size_t c = 0; c < chains_of(result); ++c) {
      Rng rng(result.seed, predictive_stream + q * max_chains + c);
      for (std::size_t d = 0; d < draws; ++d) {
        const std::vector<double> x = natural(study, result.posterior_draws[c], d);
        const double z = rng.normal();  // the same item at all points of measurement
        for (const PredictionRequest* request : requests[q]) {
          const double mean = request->item ? request->item(x.data(), z) : request->mean(x.data());
          const ObservationDistribution distribution(request->family, mean, request->sd(x.data()));
          const double t = distribution.location + distribution.scale * rng.normal();
          all[q].values.push_back(from_si(
              request->unit, request->family == ObservationFamily::lognormal ? std::exp(t) : t));
        }
      }
    }
  }
  return all;
}

std::vector<Group> inference_data(const PosteriorStudy& study, const PosteriorSummary& result) {
  std::string left_out;
  const std::vector<Eigen::MatrixXd> terms = log_likelihood(study, result, left_out);
  const Group observed = data_group("observed_data", study, result, true);
  std::vector<Group> groups = {posterior_group(result, left_out), sample_stats(result)};
  if (!terms.empty()) {
    groups.push_back(likelihood_group(study, result, terms, observed_name(observed)));
  }
  std::vector<PredictiveDraws> predictions = predictive_draws(study, result);
  if (!predictions.empty()) groups.push_back(predictive_group(result, std::move(predictions)));
  if (!observed.variables.empty()) groups.push_back(observed);
  Group constant = data_group("constant_data", study, result, false);
  if (!constant.variables.empty()) groups.push_back(std::move(constant));
  return groups;
}

}  // namespace wearwell
