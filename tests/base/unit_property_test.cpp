// Units that are made up at random.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/unit.h"

namespace wearwell {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

template <class... T>
std::string one_of(T... words) {
  return *rc::gen::element<std::string>(words...);
}

struct Prefix {
  std::string text;
  double size;
};
Prefix prefix() {
  return *rc::gen::element(Prefix{"", 1}, Prefix{"k", 1e3}, Prefix{"M", 1e6}, Prefix{"G", 1e9},
                           Prefix{"m", 1e-3}, Prefix{"u", 1e-6}, Prefix{"n", 1e-9});
}

std::string count() {
  return one_of("cycle", "cycles", "rev", "revolutions", "turn", "strokes", "closing", "rotations",
                "r", "U");
}
std::string angle() {
  return one_of("rad", "deg", "degree", "arc_minute", "radian");
}
struct Time {
  std::string text;
  double seconds;
};
Time time_unit() {
  return *rc::gen::element(Time{"s", 1}, Time{"min", 60}, Time{"h", 3600}, Time{"day", 86400},
                           Time{"ms", 1e-3});
}

std::optional<Unit> try_unit(const std::string& text, const std::string& si) {
  try {
    return read_unit(text, si);
  } catch (const InputError&) {
    return {};
  }
}

bool same(double a, double b) {
  return std::abs(a - b) <= 1e-12 * std::abs(b);
}

RC_GTEST_PROP(UnitProperty, PrefixesMultiply, ()) {
  const Prefix p = prefix();
  const auto [base, si] = *rc::gen::element<std::pair<std::string, std::string>>(
      std::pair{"m", "m"}, std::pair{"N", "N"}, std::pair{"Pa", "Pa"}, std::pair{"Nm", "N m"},
      std::pair{"J", "N m"}, std::pair{"s", "s"}, std::pair{"Hz", "rev/s"},
      std::pair{"rad/s", "rad/s"});
  RC_ASSERT(same(read_unit(p.text + base, si).scale, p.size));
}

RC_GTEST_PROP(UnitProperty, CountsWithPrefixes, ()) {
  const Prefix p = prefix();
  const std::string text = p.text + count();
  const auto unit = try_unit(text, one_of("cycle", "rev"));
  RC_ASSERT(unit.has_value() == (p.size >= 1));
  if (unit) RC_ASSERT(same(unit->scale, p.size));
}

// Whatever stands around them, an angle is never read where a count stands, nor a count as an
// angle or a number.
RC_GTEST_PROP(UnitProperty, CountsAndAnglesAreNeverConverted, ()) {
  const std::string factor = one_of("", "1e3 ", "10^3 ", "5 "), p = prefix().text;
  const std::string per = one_of("", "N m/", "mm/", "kJ/");
  const std::string rest = per == "" ? "" : per == "mm/" ? "m/" : "N m/";
  const auto si_of = [&](const char* turns) {
    return rest.empty() ? std::string(turns) : rest + turns;
  };
  const std::string an_angle = factor + per + p + angle(), a_count = factor + per + count();
  RC_ASSERT(!try_unit(an_angle, si_of("cycle")));
  RC_ASSERT(!try_unit(an_angle, rest.empty() ? "1" : rest.substr(0, rest.size() - 1)));
  RC_ASSERT(!try_unit(a_count, si_of("rad")));
  RC_ASSERT(!try_unit(a_count, rest.empty() ? "1" : rest.substr(0, rest.size() - 1)));
  RC_ASSERT(try_unit(an_angle, si_of("rad")).has_value());
  RC_ASSERT(try_unit(a_count, si_of("cycle")).has_value());
}

// A speed of rotation is the same whether it is kept in revolutions or radians; without either it
// is refused, but for 1/min.
RC_GTEST_PROP(UnitProperty, SpeedsAreTwoPiApart, ()) {
  const Time time = time_unit();
  const bool counted = *rc::gen::arbitrary<bool>();
  const Prefix p = *rc::gen::element(Prefix{"", 1}, Prefix{"k", 1e3}, Prefix{"M", 1e6});
  const std::string turn = counted ? count() : "rad";
  const std::string text = p.text + turn + (*rc::gen::arbitrary<bool>() ? "/" : " ") + time.text;
  const std::string speed = text.find('/') != text.npos ? text : text + "^-1";
  const double in_turns = read_unit(speed, "rev/s").scale;
  const double in_radians = read_unit(speed, "rad/s").scale;
  RC_ASSERT(same(in_radians, two_pi * in_turns));
  RC_ASSERT(same(counted ? in_turns : in_radians, p.size / time.seconds));
  RC_ASSERT(try_unit("1/" + time.text, "rad/s").has_value() == (time.text == "min"));
  RC_ASSERT(!try_unit(p.text + turn, "rev/s"));
  RC_ASSERT(!try_unit(time.text, "rev/s"));
}

// Any words that make a unit at all make one that is finite and above 0, and goes both ways.
RC_GTEST_PROP(UnitProperty, ScalesAreFiniteAndGoBothWays, ()) {
  const auto word = [] {
    return prefix().text + one_of("m", "N", "Pa", "J", "s", "K", "g", "rad", "cycle", "degC",
                                  "degF", "Hz", "rpm", "%", "lg(re 1 m)", "in", "psi", "-3", "0",
                                  "1e200", "1e-200", "1e400", "2");
  };
  std::string text = word();
  const int more = *rc::gen::inRange(0, 4);
  for (int i = 0; i < more; ++i) text += one_of(" ", "/", "*", ".", "^2 ", "^-3 ", "/(1 ") + word();
  for (const char* si : {"m", "N", "Pa", "N m", "K", "1", "cycle", "rev/s", "rad/s", "m^3",
                         "m^3/(N m)", "N m/cycle"}) {
    const auto unit = try_unit(text, si);
    if (!unit) continue;
    RC_ASSERT(std::isnormal(unit->scale) && unit->scale > 0);
    RC_ASSERT(std::isfinite(unit->offset));
    RC_ASSERT(unit->offset == 0 || std::string(si) == "K");
    const double value = *rc::gen::inRange(-1000, 1000) / 7.0;
    const double back = from_si(*unit, to_si(*unit, value));
    RC_ASSERT(std::abs(back - value) <= 1e-13 * (std::abs(value) + unit->offset / unit->scale));
    // One over it is another dimension, but for pure numbers.
    if (!is_number(*unit)) RC_ASSERT(!try_unit("1/(" + text + ")", si));
  }
}

// A difference of temperatures has no offset: it is the scale times the number.
RC_GTEST_PROP(UnitProperty, DifferencesOfTemperatureHaveNoOffset, ()) {
  const std::string text = one_of("degC", "degF", "K", "°C", "mK", "degR");
  const Unit unit = read_unit(text, "K");
  const double from = *rc::gen::inRange(-100, 500), step = *rc::gen::inRange(1, 100);
  const double difference = to_si(unit, from + step) - to_si(unit, from);
  RC_ASSERT(std::abs(difference - unit.scale * step) < 1e-9);
  const double expected = text == "mK" ? 1e-3 : text == "degF" || text == "degR" ? 1 / 1.8 : 1;
  RC_ASSERT(same(unit.scale, expected));
}

// A quantity is its number times its unit, or it is refused.
RC_GTEST_PROP(UnitProperty, QuantitiesAreNumberTimesUnit, ()) {
  const double number = *rc::gen::inRange(-100000, 100000) / 8.0;
  const std::string unit = one_of("mm", "km", "in", "um", "thou");
  const Quantity read = read_quantity(fmt::format("{} {}", number, unit), "m");
  RC_ASSERT(read.value == number);
  RC_ASSERT(read.si() == number * read_unit(unit, "m").scale);
  const int tail = *rc::gen::inRange(0, 1000);
  const std::string gap = fmt::format("{} {:03} {}", number, tail, unit);
  bool refused = false;
  try {
    read_quantity(gap, "m");
  } catch (const InputError&) {
    refused = true;
  }
  RC_ASSERT(refused);
}

}  // namespace
}  // namespace wearwell
