#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

namespace wearwell {

/// NUTS diagnostics of one draw; names as CmdStan's columns.
struct NutsStep {
  double accept_stat;  ///< mean acceptance probability over the trajectory
  int treedepth;
  int n_leapfrog;
  bool divergent;
  double energy;  ///< Hamiltonian of the draw
};

/// One chain's draws after warm-up.
struct Chain {
  Eigen::MatrixXd values;           ///< draws x parameters, natural, SI
  std::vector<double> log_density;  ///< of each draw, on the real line, with the Jacobian
  std::vector<NutsStep> nuts;       ///< one per draw; empty for other methods
  double accept_rate = 1;           ///< accepted proposals (Metropolis) or mean accept_stat (NUTS)
  double step_size = 0;             ///< NUTS, after warm-up
  std::vector<std::string> notes;   ///< other results of warm-up, one line each
};

using Draws = std::vector<Chain>;  ///< chains of equal length

}  // namespace wearwell
