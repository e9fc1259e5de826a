#include "wearwell/prognosis/quantity_like.h"

#include <fmt/format.h>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell::prognosis {

double quantity_like(const std::string& option, const std::string& text, const Unit& like,
                     Allowed allowed) {
  Quantity quantity;
  try {
    quantity = read_quantity(text, like.text);
    refuse_two_readings(quantity, like);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: '{}' must be a number with a unit like {}: {}", option,
                                 printable(text), like.text, error.what()));
  }
  return checked_option(option, text, quantity.si(), allowed);
}

}  // namespace wearwell::prognosis
