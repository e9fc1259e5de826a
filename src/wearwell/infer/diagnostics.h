#pragma once

#include <span>
#include <vector>

/// Convergence and effective sample size of a sampler, after Vehtari,
/// Gelman, Simpson, Carpenter, Bürkner (2021), "Rank-normalization, folding, and localization: an
/// improved R-hat", Bayesian Analysis 16, 667-718, with the conventions of the R package posterior
/// 1.4.0; results agree up to rounding.
///
/// All are NaN ("unknown", which never passes a threshold) when a draw is not finite, when all
/// draws are equal to within rounding, or when chains are too short to be split: fewer than 4
/// draws for R-hat, fewer than 6 for everything else. For discrete quantities a single diagnostic
/// is NaN if its transformed values are constant: R-hat of two values equally far from the median,
/// tail ESS if more than 5 % of the draws share the largest value.
///
/// Three intended differences from posterior: draws in a narrow range (a wear rate of 1e-16 m^3/(N
/// m)) are not constant; an infinite draw makes R-hat and bulk ESS NaN as well; and chains of 2 or
/// 3 draws have no R-hat.
namespace wearwell {

/// Views of the draws of one quantity: at least one chain, all of equal length. The
/// functions below throw std::invalid_argument for chains of different lengths.
struct Chains {
  std::vector<std::span<const double>> draws;  ///< draws[c][n]: draw n of chain c
};

struct Diagnostics {
  double rhat;       ///< rank-normalized split R-hat, the larger of bulk and folded: at most 1.01
  double ess_bulk;   ///< effective draws for the center of the distribution: at least 100 per chain
  double ess_tail;   ///< effective draws for its 5 % and 95 % quantiles, the smaller: the same
  double mcse_mean;  ///< Monte Carlo standard error of the mean, in the quantity's unit, as below
  double mcse_sd;    ///< of the standard deviation
  double mcse_q05;   ///< of the 5 % quantile
  double mcse_q50;   ///< of the median
  double mcse_q95;   ///< of the 95 % quantile
};

/// All diagnostics at once, cheaper than the separate functions below.
Diagnostics diagnose(const Chains& chains);

/// Potential scale reduction: the variance between split chains compared with that within (sections
/// 3.1 and 4.1).
double rhat(const Chains& chains);         ///< the larger of the two below
double rhat_bulk(const Chains& chains);    ///< of the draws' normal scores: compares locations
double rhat_folded(const Chains& chains);  ///< of those of |x - median|: compares spreads

/// Effective sample sizes: from split chains, autocorrelations summed over Geyer's initial monotone
/// sequence (section 3.2), at most S log10(S) of S draws.
double ess_bulk(const Chains& chains);                ///< of the draws' normal scores
double ess_tail(const Chains& chains);                ///< the smaller of 5 % and 95 % quantile
double ess_mean(const Chains& chains);                ///< for the mean
double ess_sd(const Chains& chains);                  ///< for the spread: of |x - mean|
double ess_quantile(const Chains& chains, double p);  ///< for the p-quantile, 0 <= p <= 1

/// Monte Carlo standard errors, in the unit of the draws.
double mcse_mean(const Chains& chains);
double mcse_sd(const Chains& chains);  ///< by the delta method from the ESS of (x - mean)^2
/// Half the distance between the draws at the 16 % and 84 % points of the beta distribution that
/// the p-quantile's rank has (section 4.4).
double mcse_quantile(const Chains& chains, double p);

/// Energy Bayesian fraction of missing information of one chain of Hamiltonian Monte Carlo:
/// sum (E_n - E_{n-1})^2 / sum (E_n - mean E)^2 (Betancourt 2016, arXiv:1604.00695). Near 1 is
/// good; below 0.3 momentum resampling explores the posterior's energies too slowly. One bad chain
/// is enough for a warning. NaN for fewer than two draws or constant energy.
double e_bfmi(std::span<const double> energies);

}  // namespace wearwell
