#include "wearwell/models/bearing/uncertain.h"

#include <fmt/format.h>

#include <boost/algorithm/string/predicate.hpp>
#include <charconv>
#include <cmath>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/trimmed.h"

namespace wearwell {
namespace {

using Distribution = Uncertain::Distribution;

bool is_bare_number(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, failure] = std::from_chars(text.data(), end, value);
  return failure == std::errc{} && rest == end;
}

/// A difference of two quantities, so an offset (degrees Celsius) does not apply.
double difference(const Quantity& q) {
  return q.value * q.unit.scale;
}

/// "0.100 +- 0.005 mm", split at the sign.
Uncertain read_plus_minus(const std::string& left, const std::string& right, std::string_view si) {
  Uncertain result;
  if (boost::algorithm::ends_with(right, "%")) {
    const Quantity mean = read_quantity(left, si);
    result.unit = mean.unit;
    result.mean = mean.si();
    result.sd = std::abs(difference(mean)) * read_quantity(right, "1").si();
  } else {
    const Quantity sd = read_quantity(right, si);
    // A mean without a unit has the unit of its standard deviation.
    const bool bare = is_bare_number(left) && sd.unit.text != "1";
    const Quantity mean = read_quantity(bare ? left + " " + sd.unit.text : left, si);
    refuse_two_readings(sd, mean.unit);
    result.unit = mean.unit;
    result.mean = mean.si();
    result.sd = difference(sd);
  }
  result.distribution = Distribution::normal;
  return result;
}

/// "1e-16 m^3/(N m) x/ 2": the median, and the factor by which one standard deviation of the logarithm
/// multiplies and divides it.
Uncertain read_factor(const std::string& left, const std::string& right, std::string_view si) {
  Uncertain result;
  const Quantity median = read_quantity(left, si);
  const double factor = read_quantity(right, "1").si();
  if (!(factor > 1 && std::isfinite(factor)))
    throw InputError(fmt::format("'{} x/ {}': the factor must be more than 1", left, right));
  const double log_sd = std::log(factor), variance = log_sd * log_sd;
  result.distribution = Distribution::lognormal;
  result.unit = median.unit;
  result.centre = median.si();
  result.mean = result.centre * std::exp(variance / 2);
  result.sd = std::abs(result.mean) * std::sqrt(std::expm1(variance));
  if (!(result.centre > 0))
    throw InputError(fmt::format("'{} x/ {}': a lognormal quantity must be above 0", left, right));
  return result;
}

/// "lognormal(0.1 mm, 0.005 mm)"
Uncertain read_law(const std::string& text, std::string_view si) {
  const auto open = text.find('('), comma = text.find(','), close = text.rfind(')');
  const bool whole = open != text.npos && comma != text.npos && close == text.size() - 1 &&
                     open < comma && comma < close;
  const std::string name(trimmed(text.substr(0, open)));
  if (!whole || (name != "normal" && name != "lognormal" && name != "uniform")) {
    throw InputError(
        fmt::format("'~ {}' is not a distribution; write normal(MEAN, SD), lognormal(MEAN, SD) or "
                    "uniform(LOWER, UPPER)",
                    text));
  }
  const Quantity first = read_quantity(text.substr(open + 1, comma - open - 1), si);
  const Quantity second = read_quantity(text.substr(comma + 1, close - comma - 1), si);
  refuse_two_readings(first, second.unit);
  refuse_two_readings(second, first.unit);
  Uncertain result;
  result.unit = first.unit;
  if (name == "uniform") {
    if (!(first.si() < second.si()))
      throw InputError(fmt::format("'~ {}': the first bound must be below the second", text));
    result.distribution = Distribution::uniform;
    result.mean = (first.si() + second.si()) / 2;
    result.sd = (second.si() - first.si()) / std::sqrt(12);
    return result;
  }
  result.distribution = name == "normal" ? Distribution::normal : Distribution::lognormal;
  result.mean = first.si();
  result.sd = difference(second);
  if (result.distribution == Distribution::lognormal && !(result.mean > 0))
    throw InputError(fmt::format("'~ {}': the mean of a lognormal must be above 0", text));
  return result;
}

}  // namespace

Uncertain read_uncertain(std::string_view text, std::string_view si) {
  const std::string written(trimmed(text));
  Uncertain result;
  std::size_t sign = 0, sign_size = 0, times = std::string::npos, times_size = 0;
  for (const std::string_view plus_minus : {"+-", "±", "+/-"}) {
    if (const auto at = written.find(plus_minus); at != written.npos) {
      sign = at;
      sign_size = plus_minus.size();
    }
  }
  for (const std::string_view over : {"x/", "×/", "×÷", "x÷"}) {
    // After a number or a unit, which never ends in "x", and before a number.
    if (const auto at = written.find(over);
        at != written.npos && at > 0 && written[at - 1] == ' ') {
      times = at;
      times_size = over.size();
    }
  }
  if (boost::algorithm::starts_with(written, "~")) {
    result = read_law(std::string(trimmed(written.substr(1))), si);
  } else if (times_size != 0) {
    result = read_factor(std::string(trimmed(written.substr(0, times))),
                         std::string(trimmed(written.substr(times + times_size))), si);
  } else if (sign_size != 0) {
    result = read_plus_minus(std::string(trimmed(written.substr(0, sign))),
                             std::string(trimmed(written.substr(sign + sign_size))), si);
  } else {
    const Quantity quantity = read_quantity(written, si);
    result.unit = quantity.unit;
    result.mean = quantity.si();
  }
  if (result.sd < 0)
    throw InputError(fmt::format("'{}' has a negative standard deviation", written));
  if (result.sd == 0) result.distribution = Distribution::exact;
  if (times_size == 0) result.centre = result.mean;
  result.text = written;
  return result;
}

double draw(const Uncertain& q, Rng& rng) {
  switch (q.distribution) {
    case Distribution::exact:
      break;
    case Distribution::normal:
      return q.mean + q.sd * rng.normal();
    case Distribution::lognormal: {
      const double variance = std::log1p(q.sd * q.sd / (q.mean * q.mean));  // of the logarithm
      return q.mean * std::exp(std::sqrt(variance) * rng.normal() - variance / 2);
    }
    case Distribution::uniform:
      return q.mean + q.sd * std::sqrt(12) * (rng.uniform() - 0.5);
  }
  return q.mean;
}

double equal_factor(const Uncertain& q) {
  return std::exp(std::sqrt(std::log1p(q.sd * q.sd / (q.mean * q.mean))));
}

}  // namespace wearwell
