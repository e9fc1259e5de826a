#pragma once

#include <filesystem>
#include <string>

#include "wearwell/study/model.h"

namespace wearwell {

struct LifeAgainstOptions {
  std::filesystem::path result, against;
  std::string unit;        ///< which life of both; empty: the headline
  std::string horizon;     ///< use at which survival is compared
  std::string confidence;  ///< of "at least"; empty: 90 %
  bool json = false;
};

/// `wearwell life RESULT --against OTHER`. Returns the exit code. Throws InputError.
int run_life_against(const LifeAgainstOptions& options, Models models);

}  // namespace wearwell
