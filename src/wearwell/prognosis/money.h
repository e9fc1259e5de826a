#pragma once

#include <string>

#include "wearwell/base/unit.h"

namespace wearwell::prognosis {

/// The currency of all amounts of one question: that of the first amount.
struct Currency {
  std::string text = {};  ///< "EUR"; may be empty
  bool known = false;
};

/// "12000 EUR". Throws InputError that begins with the option's name if it is no amount, is
/// negative, or is in another currency than the amounts before.
double amount(const std::string& option, const std::string& text, Currency& currency);

/// The amount of --replacement-cost, of a preventive replacement: above 0, otherwise waiting saves
/// nothing. Throws InputError.
double replacement_amount(const std::string& text, Currency& currency);

/// "50 EUR/h": an amount per unit of use, in the currency per SI unit of `axis`.
double amount_per(const std::string& option, const std::string& text, const Unit& axis,
                  Currency& currency);

}  // namespace wearwell::prognosis
