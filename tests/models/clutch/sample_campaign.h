#pragma once

#include "wearwell/models/clutch/design.h"
#include "wearwell/models/clutch/tribometer.h"
#include "wearwell/models/clutch/wear_model.h"

namespace wearwell::clutch {

/// The paper's plan: Haramina et al. (2025), section 2.2.
inline DesignRequest paper_design() {
  return {{{{1200 * rpm, 1700 * rpm, 2800 * rpm}, {25, 50, 75}, {120, 170, 240}, {0.9, 2.15, 3.4}}},
          20,
          20,
          {1000 * rpm, 20, 100, 0.6},
          {3000 * rpm, 80, 255, 3.8},
          45e3,
          {rpm, 0.1, 0.1, 0.01},
          1};
}

/// Truth with the structure that the paper found: its ten terms, its proportions of run-in, a
/// scatter with which R2 is about 0.88. The same as examples/clutch/truth.toml (a test in
/// tests/study compares).
inline Truth paper_like_truth() {
  Truth truth;
  truth.r = 1.2;
  truth.q = 0.5;
  truth.reference = {2800 * rpm, 75, 240, 3.4};
  truth.terms = {{0, 0, 0, 4 * mm3_per_MJ},    {1, 0, 0, -12 * mm3_per_MJ},
                 {0, 1, 0, 8.5 * mm3_per_MJ},  {1, 1, 0, 22 * mm3_per_MJ},
                 {0, 1, 1, -28 * mm3_per_MJ},  {0, 0, 2, 4 * mm3_per_MJ},
                 {1, 1, 1, 14 * mm3_per_MJ},   {2, 1, 0, 5 * mm3_per_MJ},
                 {2, 0, 1, -2.5 * mm3_per_MJ}, {0, 2, 1, 31 * mm3_per_MJ}};
  truth.run_in = {0.4, 4, 78e6, 6e6};
  truth.scatter = {ScatterKind::linear, {75 * mm3_per_MJ, 2.2}};
  truth.plate_sd = 0.04;
  truth.plates = 13;
  truth.density = 2200;
  truth.balance_sd = 1e-6;
  truth.run_in_point = {2800 * rpm, 50, 170, 3.4};
  truth.run_in_weighings = {40, 100, 200, 400, 800, 1500, 2500, 4000, 6000, 8000};
  truth.run_out_cycles = 1500;
  truth.worn_out = 10e-6;
  return truth;
}

/// One campaign of that truth and design, simulated once.
inline const Simulation& paper_like_campaign() {
  static const Simulation simulation = simulate(plan(paper_design()), paper_like_truth(), 1);
  return simulation;
}

/// A model of a wear rate w0, m^3/J, that depends on nothing.
inline WearModel constant_model(double w0, double sigma, const RunIn& run_in) {
  WearModel model;
  model.terms = {{"1", 0, 0, 0, 0, 1, w0}};
  model.covariance = Eigen::MatrixXd::Zero(1, 1);
  model.run_in = run_in;
  model.scatter = {ScatterKind::linear, {sigma, 0}};
  model.lowest = {100, 20, 100, 0.5};
  model.highest = {300, 80, 250, 4};
  model.worn_out = 10e-6;
  return model;
}

}  // namespace wearwell::clutch
