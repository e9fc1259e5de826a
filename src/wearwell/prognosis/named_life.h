#pragma once

#include <span>
#include <string>
#include <vector>

#include "wearwell/study/posterior_study.h"

namespace wearwell::prognosis {

/// A life among the quantities of a study. The study must outlive it.
struct NamedLife {
  const QuantityGroup* group = nullptr;
  const QuantityRequest* request = nullptr;
  std::size_t index = 0;  ///< among the lives of its group
};

/// Lives whose distribution the study knows, in the order of its requests.
std::vector<NamedLife> named_lives(const PosteriorStudy& study);

/// Its distribution at one point of the parameters (natural, SI).
LifeDistribution distribution_at(const NamedLife& life, std::span<const double> x);

/// "softer spring" of "new softer spring".
std::string without_new(const std::string& of);

/// The life that a text names, case ignored: by what it is of, by the last word of that, by its
/// conditions, or by both; an empty text is the only one, or the study's headline. A new unit is preferred to one that has
/// survived. Throws InputError that begins with `option` and lists the known names.
NamedLife life_named(const std::vector<NamedLife>& lives, const std::string& text,
                     const std::string& option);

}  // namespace wearwell::prognosis
