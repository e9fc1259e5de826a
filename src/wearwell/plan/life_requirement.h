#pragma once

#include <string>
#include <string_view>

#include "wearwell/base/unit.h"

namespace wearwell::plan {

/// A statement about a distribution of lives: the share `failing` fails by `life`.
struct LifePoint {
  std::string text;    ///< as written
  double failing = 0;  ///< between 0 and 1
  double life = 0;     ///< SI
  Unit unit;           ///< of the life, as written
};

/// Reads a quantity of any dimension, "1e6 cycles". A plain number has the unit 1. Throws InputError
/// that begins with `option`, unless it is positive and finite.
Quantity read_any_quantity(const std::string& option, const std::string& text);

/// Reads "B10 >= 1e6 cycles" or "reliability >= 90 % at 1e6 cycles", with "=" in place of ">=" for
/// `relation` "=". L10 is B10; R is reliability. The life is in the dimension of `like`, if given.
/// Throws InputError that begins with `option`.
LifePoint read_life_point(const std::string& option, const std::string& text,
                          std::string_view relation, const Unit* like = nullptr);

/// A probability between 0 and 1, "90 %". Throws InputError that begins with `option`.
double read_probability(const std::string& option, const std::string& text);

}  // namespace wearwell::plan
