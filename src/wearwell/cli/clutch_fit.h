#pragma once

#include <filesystem>

#include "wearwell/study/text_file.h"

namespace wearwell::clutch {

struct FitRequest {
  TextFile study;
  std::filesystem::path output;
  int threads = 0;
  bool json = false, quiet = false, no_report = false;
};

/// `wearwell fit` of a study of `model = "clutch-wear"`: returns the exit code.
int fit_clutch_study(const FitRequest& request);

}  // namespace wearwell::clutch
