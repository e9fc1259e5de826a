#include "wearwell/present/plain.h"

#include "wearwell/present/number.h"

namespace wearwell {

std::string plain_number(double x, int digits) {
  return shown_number(x, digits, Script::terminal);
}

std::string plain_given(double x) {
  return given_text(x, Script::terminal);
}

std::string plain_quantity(double x, const std::string& unit, int digits) {
  const std::string text = unit_description(unit, Script::terminal);
  return text.empty() ? plain_number(x, digits) : plain_number(x, digits) + " " + text;
}

std::string plain_range(double low, double high, int digits) {
  return range_text(low, high, digits, Script::terminal);
}

}  // namespace wearwell
