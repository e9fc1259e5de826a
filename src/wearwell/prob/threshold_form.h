#pragma once

#include "wearwell/prob/family_form.h"

namespace wearwell {

/// The form of the same family whose last parameter, the threshold, is left out; itself if it has none.
inline const ResponseForm& without_threshold(const ResponseForm& form) {
  const auto& all = form.family_parameters;
  if (all.empty() || all.back().name != "threshold") return form;
  for (const ResponseForm& each : response_forms()) {
    const auto& own = each.family_parameters;
    if (each.name != form.name || own.size() + 1 != all.size()) continue;
    bool same = true;
    for (std::size_t i = 0; i < own.size(); ++i) same = same && own[i].name == all[i].name;
    if (same) return each;
  }
  return form;
}

}  // namespace wearwell
