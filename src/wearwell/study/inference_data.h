#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "wearwell/netcdf/netcdf_file.h"
#include "wearwell/study/posterior_study.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// The study of a posterior. Throws InputError where it has none, as of a clutch campaign.
const PosteriorStudy& require_posterior_study(const Study& study);

/// Limit on the number of log-likelihood values that are computed and written.
inline constexpr std::size_t most_log_likelihoods = 50'000'000;

/// log p of each observation at each draw, draws x observations for each chain; natural logarithm,
/// data in SI. Repeated observations are repeated. Empty if the likelihood has no factors or has
/// more than `most_log_likelihoods` values; `why` states the reason.
std::vector<Eigen::MatrixXd> log_likelihood(const PosteriorStudy& study,
                                            const PosteriorSummary& result, std::string& why);

/// Posterior predictive draws of one measured quantity, in `unit`, at the places `at`.
struct PredictiveDraws {
  std::string quantity, unit, at_name;
  std::vector<double> at;
  std::vector<double> values;  ///< chain by chain, draw by draw, along `at`
};
/// One draw of each predicted measurement for each posterior draw, from separate random streams of
/// the seed.
std::vector<PredictiveDraws> predictive_draws(const PosteriorStudy& study,
                                              const PosteriorSummary& result);

/// The groups and names that ArviZ reads: posterior, sample_stats, log_likelihood,
/// posterior_predictive, observed_data, constant_data; chain and draw first. Parameters and columns
/// in the units of the study, which each names (attribute "units"). The attribute "left_out" of the
/// group "posterior" says what is left out.
std::vector<netcdf::Group> inference_data(const PosteriorStudy& study,
                                          const PosteriorSummary& result);

}  // namespace wearwell
