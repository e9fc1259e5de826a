#include "wearwell/prognosis/unit_like.h"

#include "wearwell/base/unit_system.h"

namespace wearwell::prognosis {

std::optional<Unit> unit_like(const std::string& text, const Unit& like) {
  if (text == like.text) return like;
  const auto unit = parse_unit(text), known = parse_unit(like.text);
  if (!unit || !known || !unit->linear || !known->linear || unit->dimension != known->dimension)
    return {};
  return Unit{text, unit->scale, unit->offset};
}

}  // namespace wearwell::prognosis
