#include "wearwell/present/plain.h"

#include "wearwell/present/number.h"

namespace wearwell {

std::string plain_number(double x, int digits) {
  return number_in_words(x, digits, Script::terminal);
}

std::string plain_given(double x) {
  return given_in_words(x, Script::terminal);
}

std::string plain_range(double low, double high, int digits) {
  return range_in_words(low, high, digits, Script::terminal);
}

}  // namespace wearwell
