#pragma once

#include <limits>

#include "wearwell/math/constants.h"
#include "wearwell/study/posterior_result.h"
#include "wearwell/study/saved_result.h"

namespace wearwell {

/// A small result with everything in it: two chains of NUTS, two parameters, one stage, a life
/// that may never end.
inline PosteriorSummary sample_result() {
  PosteriorSummary result;
  result.version = "1.2.3";
  result.title = "Pin joint";
  result.model = "archard-joint";
  result.equation = "V = k W";
  result.data_file = "joint.csv";
  result.data_rows = 2;
  result.quantity = "worn volume";
  result.method = "nuts";
  result.chains = 2;
  result.warmup = 100;
  result.draws = 3;
  result.seed = 18446744073709551615u;
  ParameterSummary k{"k",    "mm^3/(N m)", 7.5e-4,
                     1e-5,   1e-7,         7.3e-4,
                     7.5e-4, 7.7e-4,       1000,
                     900,    1.001,        ExactSummary{7.51e-4, 1.1e-5, 7.3e-4, 7.5e-4, 7.7e-4}};
  ParameterSummary sigma{"sigma", "mm^3", 2, 0.5, 0.01, 1, 2, 3, 800, 700, 1.002, {}};
  result.parameters = {k, sigma};
  PredictionSummary prediction{"cycles",
                               20585,
                               "volume",
                               "mm^3",
                               {91, 88, 94, 80, 101},
                               Prediction{91.5, 88.5, 94.5, 80.5, 101.5},
                               92.73};
  result.predictions = {prediction};
  result.predictions[0].measured.reset();
  result.checks = {{"convergence", Verdict::pass, "R-hat 1.002", ""},
                   {"energy", Verdict::warn, "E-BFMI 0.25", "look"},
                   {"divergences", Verdict::fail, "3 of 6", "reparametrize"}};
  result.trusted = false;
  result.stages = {{1, {k, sigma}, {prediction}, {result.checks[0]}, true}};
  result.life = LifeSummary{
      "cycles", 100, "mm^3", 20585, 0.01, {21000, 22000, 23000, 21500, infinity, 400}, {}};
  result.log_evidence = -12.25;
  result.density_unit = "mm^3";
  result.data_fingerprint = "da39a3ee";
  result.data_remarks = {"1 hidden row left out (3)"};
  result.mode =
      ModeSummary{"",
                  {{"k", "mm^3/(N m)", 7.4e-4, 9e-6, "inside"},
                   {"sigma", "mm^3", 15, std::numeric_limits<double>::quiet_NaN(), "upper bound"}},
                  "mm^3",
                  -20.5,
                  -22.5,
                  45,
                  44.25,
                  false,
                  2,
                  13,
                  12};
  result.loo = LooSummary{"row", {{{-1.5, -1.25, 0.25}, {-3, -2, 0.875, 2, true}}, 0.7}, "mm^3"};
  result.pointwise = PointwiseTable{"mm^3", "N", "m", "mm^3/(N m)", {{1, 65, 0.0918, 4.44, 0.744}}};
  for (int c = 0; c < 2; ++c) {
    Chain chain;
    chain.values.resize(3, 2);
    chain.values << 7.123456789012345e-4 + c, 1. / 3, 1e-300, 2.5, -0.0, 1e17;
    chain.log_density = {-1.1, -0.1 - c, -infinity};
    chain.nuts = {{0.9, 3, 7, false, 2.5}, {0.8, 2, 3, true, 1. / 7}, {1, 1, 1, false, 4}};
    chain.step_size = 0.625;
    chain.notes = {"Diagonal elements of inverse mass matrix:", "1, 2"};
    result.posterior_draws.push_back(chain);
  }
  return result;
}

/// What `wearwell compare` would read of it.
inline SavedResult saved(const PosteriorSummary& result) {
  return {posterior_result(result).header, result.parameters, result.mode, result.loo,
          result.posterior_draws};
}

}  // namespace wearwell
