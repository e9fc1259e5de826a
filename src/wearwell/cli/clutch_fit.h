#pragma once

#include <filesystem>

namespace wearwell::clutch {

struct FitRequest {
  std::filesystem::path study, output;
  int threads = 0;
  bool json = false, quiet = false, no_report = false;
};

/// `wearwell fit` of a study of `model = "clutch-wear"`: returns the exit code.
int fit_clutch_study(const FitRequest& request);

}  // namespace wearwell::clutch
