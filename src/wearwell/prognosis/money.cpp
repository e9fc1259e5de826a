#include "wearwell/prognosis/money.h"

#include <fmt/format.h>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/option_value.h"

namespace wearwell::prognosis {

double amount(const std::string& option, const std::string& text, Currency& currency) {
  const std::size_t end = text.find_first_of(" ");
  const double value = option_value(option, text.substr(0, end), "1", Allowed::not_negative);
  const std::size_t word = end == std::string::npos ? end : text.find_first_not_of(' ', end);
  const std::string said = word == std::string::npos ? "" : text.substr(word);
  if (!currency.known) {
    currency = {said, true};
  } else if (said != currency.text) {
    throw InputError(fmt::format(
        "{}: '{}' is in another currency than '{}'; give all amounts in one, or all without",
        option, printable(text), currency.text.empty() ? "no currency" : printable(currency.text)));
  }
  return value;
}

double replacement_amount(const std::string& text, Currency& currency) {
  const double value = amount("--replacement-cost", text, currency);
  if (value <= 0)
    throw InputError("--replacement-cost: must be above 0; otherwise waiting saves nothing");
  return value;
}

double amount_per(const std::string& option, const std::string& text, const Unit& axis,
                  Currency& currency) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos)
    throw InputError(fmt::format("{}: '{}' must be an amount per use, like '50 EUR/{}'", option,
                                 printable(text), axis.text));
  const std::string per = text.substr(slash + 1);
  double use = 0;
  try {
    use = read_unit(per, axis.text).scale;
  } catch (const InputError&) {
    throw InputError(fmt::format("{}: '{}' is not a unit like {}, in which lives are counted",
                                 option, printable(per), axis.text));
  }
  std::string before = text.substr(0, slash);
  while (!before.empty() && before.back() == ' ') before.pop_back();
  return amount(option, before, currency) / use;
}

}  // namespace wearwell::prognosis
