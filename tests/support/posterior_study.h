#pragma once

#include <filesystem>
#include <stdexcept>

#include "wearwell/models/registry.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// A study file that is known to be of a posterior.
inline PosteriorStudy read_posterior_study(const std::filesystem::path& file) {
  const auto study = read_study(source_of(file), all_models());
  const auto* posterior = dynamic_cast<const PosteriorStudy*>(study.get());
  if (!posterior) throw std::logic_error("a study without a posterior");
  return *posterior;
}

}  // namespace wearwell
