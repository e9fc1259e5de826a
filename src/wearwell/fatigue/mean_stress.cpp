#include "wearwell/fatigue/mean_stress.h"

#include <algorithm>

namespace wearwell::fatigue {

const std::vector<std::string>& mean_stress_names() {
  static const std::vector<std::string> names = {"none",   "goodman", "gerber", "soderberg",
                                                 "morrow", "swt",     "walker"};
  return names;
}

std::optional<MeanStress> mean_stress_named(const std::string& name) {
  const auto& names = mean_stress_names();
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) return {};
  return static_cast<MeanStress>(at - names.begin());
}

std::string strength_name(MeanStress correction) {
  switch (correction) {
    case MeanStress::goodman:
    case MeanStress::gerber:
      return "S_ut";
    case MeanStress::soderberg:
      return "S_y";
    case MeanStress::morrow:
      return "sigma_f";
    case MeanStress::none:
    case MeanStress::swt:
    case MeanStress::walker:
      break;
  }
  return {};
}

}  // namespace wearwell::fatigue
