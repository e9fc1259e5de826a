#include "wearwell/base/unit.h"

#include <fmt/format.h>
#include <udunits2.h>

#include <boost/algorithm/string/trim.hpp>
#include <charconv>
#include <cmath>
#include <memory>

#include "wearwell/base/error.h"

namespace wearwell {
namespace {

struct Free {
  void operator()(ut_system* system) const { ut_free_system(system); }
  void operator()(ut_unit* unit) const { ut_free(unit); }
  void operator()(cv_converter* converter) const { cv_free(converter); }
};
using System = std::unique_ptr<ut_system, Free>;
using UtUnit = std::unique_ptr<ut_unit, Free>;
using Converter = std::unique_ptr<cv_converter, Free>;

const ut_system* unit_system() {
  static const System system = [] {
    ut_set_error_message_handler(ut_ignore);
    System read{ut_read_xml(nullptr)};
    if (!read)
      throw MachineError("cannot read the UDUNITS-2 unit database; is libudunits2 installed?");
    return read;
  }();
  return system.get();
}

UtUnit parse(const std::string& text) {
  return UtUnit{ut_parse(unit_system(), text.c_str(), UT_UTF8)};
}

}  // namespace

Unit read_unit(std::string_view text, std::string_view si) {
  const std::string written = boost::algorithm::trim_copy(std::string(text));
  if (written == si) return Unit{written, 1, 0};
  if (is_logarithm(si)) {
    if (!is_logarithm(written)) {
      throw InputError(fmt::format("'{}' is not the logarithm of a quantity (write one like '{}')",
                                   written, si));
    }
    const auto inner = [](std::string_view log) { return log.substr(6, log.size() - 7); };
    const Unit unit = read_unit(inner(written), inner(si));
    if (unit.offset != 0) {
      throw InputError(fmt::format("'{}': the unit has an offset, and so no logarithm", written));
    }
    return Unit{written, 1, std::log10(unit.scale)};
  }
  const std::string expected{si};
  const UtUnit target = parse(expected);
  if (!target) throw std::logic_error(fmt::format("'{}' is not an SI unit", expected));
  const UtUnit unit = parse(written);
  if (!unit) {
    throw InputError(fmt::format("'{}' is not a unit (expected one like '{}')", written, expected));
  }
  const Converter converter{ut_get_converter(unit.get(), target.get())};
  if (!converter) {
    throw InputError(fmt::format("unit '{}' has the wrong dimension (expected one like '{}')",
                                 written, expected));
  }
  const double offset = cv_convert_double(converter.get(), 0.0);
  const double scale = cv_convert_double(converter.get(), 1.0) - offset;
  return Unit{written, scale, offset};
}

Quantity read_quantity(std::string_view text, std::string_view si) {
  const std::string written = boost::algorithm::trim_copy(std::string(text));
  double value = 0;
  const char* end = written.data() + written.size();
  const auto [rest, failure] = std::from_chars(written.data(), end, value);
  if (failure != std::errc{} || !std::isfinite(value)) {
    throw InputError(fmt::format("'{}' is not a number with a unit (like '1.5 {}')", written, si));
  }
  const std::string unit = boost::algorithm::trim_copy(std::string(rest, end));
  if (unit.empty() && si != "1") {
    throw InputError(
        fmt::format("'{}' has no unit (write one like '{} {}')", written, written, si));
  }
  return Quantity{value, read_unit(unit.empty() ? "1" : unit, si)};
}

}  // namespace wearwell
