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
  Eigen::MatrixXd values;           ///< draws x parameters: natural parameters, SI
  std::vector<double> log_density;  ///< of each draw, on the whole real line: with the Jacobian
  std::vector<NutsStep> nuts;       ///< one a draw; empty for other methods
  double accept_rate = 1;           ///< accepted proposals (Metropolis) or mean accept_stat (NUTS)
  double step_size = 0;             ///< NUTS, after warm-up, on the whitened real line
  std::vector<std::string> notes;   ///< what else warm-up adapted, one line each
};

using Draws = std::vector<Chain>;  ///< chains of equal length

}  // namespace wearwell
