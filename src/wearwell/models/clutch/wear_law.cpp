#include "wearwell/models/clutch/wear_law.h"

#include <fmt/format.h>

#include "wearwell/base/error.h"

namespace wearwell::clutch {

int size_of(ScatterKind kind) {
  static constexpr int sizes[] = {2, 2, 3, 5};
  return sizes[static_cast<int>(kind)];
}

const char* name_of(ScatterKind kind) {
  static constexpr const char* names[] = {"exponential", "linear", "quadratic", "conditions"};
  return names[static_cast<int>(kind)];
}

const char* formula_of(ScatterKind kind) {
  static constexpr const char* formulas[] = {"p1 exp(p2 w)", "p1 + p2 w", "p1 + p2 w + p3 w^2",
                                             "p1 + p2 Td + p3 omega0 + p4 Mz + p5 t2"};
  return formulas[static_cast<int>(kind)];
}

ScatterKind read_scatter_kind(const std::string& name) {
  for (const ScatterKind kind : scatter_kinds) {
    if (name == name_of(kind)) return kind;
  }
  throw InputError(fmt::format(
      "'{}' is unknown; use 'exponential', 'linear', 'quadratic' or 'conditions'", name));
}

}  // namespace wearwell::clutch
