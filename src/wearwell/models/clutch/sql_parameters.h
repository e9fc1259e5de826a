#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/models/clutch/wear_model.h"

namespace wearwell::clutch {

/// A parameter of the model, as a row of the database.
struct SqlParameter {
  std::size_t replicate = 0;  ///< 0: the model itself
  std::string name;           ///< "ds*Td", "slow_energy", "sigma1"
  double value = 0;
  std::string column;  ///< name after pivoting into one row: "k0_3"
};

/// All of them.
struct SqlParameters {
  std::vector<SqlParameter> all;
  /// Distinct pairs of exponents, with a replicate that has them; and the pair of each replicate.
  std::vector<std::pair<std::size_t, std::pair<double, double>>> pairs;
  std::vector<std::size_t> pair_of;
  /// Powers of ds, Td and Mz to the parameter, by replicate.
  std::vector<std::map<std::array<int, 3>, std::string>> monomials;

  const std::string& column(std::size_t replicate, const std::string& name) const;
};
/// `inlined`: the columns are literals of PostgreSQL.
SqlParameters sql_parameters(const WearModel& model, bool replicates, bool inlined);

/// The polynomial of one replicate by Horner's rule, `prefix` before each parameter: "(k.k0_1 + ds0
/// * (k.k0_2 + temperature * k.k0_3))".
std::string horner(const SqlParameters& parameters, std::size_t replicate,
                   const std::string& prefix);

}  // namespace wearwell::clutch
