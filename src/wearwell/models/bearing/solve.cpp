#include "wearwell/models/bearing/solve.h"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <string>

#include "wearwell/base/error.h"
#include "wearwell/models/bearing/scar.h"

namespace wearwell::bearing {
namespace {

using Input = std::optional<double> Bearing::*;
using Inputs = std::initializer_list<Input>;

struct Name {
  Input input;
  const char* text;
};
constexpr Name names[] = {{&Bearing::radius, "radius"},
                          {&Bearing::clearance, "clearance"},
                          {&Bearing::depth, "depth"},
                          {&Bearing::scar_width, "scar width"},
                          {&Bearing::rate, "rate"},
                          {&Bearing::pressure, "pressure"},
                          {&Bearing::force, "force"},
                          {&Bearing::length, "length"},
                          {&Bearing::revolutions, "revolutions"},
                          {&Bearing::speed, "speed"},
                          {&Bearing::time, "time"}};

std::string join(Inputs inputs) {
  std::string text;
  for (const Input input : inputs) {
    for (const Name& n : names) {
      if (n.input == input) text += (text.empty() ? "" : " and ") + std::string(n.text);
    }
  }
  return text;
}

const char* name(Quantity wanted) {
  switch (wanted) {
    case Quantity::rate:
      return "rate";
    case Quantity::depth:
      return "depth";
    case Quantity::pressure:
      return "pressure";
    case Quantity::length:
      return "length";
    case Quantity::revolutions:
      return "life in revolutions";
    case Quantity::time:
      return "life in time";
  }
  return "";
}

/// The inputs of one bearing, to check against the needs of one quantity.
struct Checked {
  const char* wanted;
  const Bearing& bearing;

  bool any(Inputs inputs) const {
    for (const Input input : inputs) {
      if (bearing.*input) return true;
    }
    return false;
  }

  /// All of `usual`, or all of `instead`.
  void need(Inputs usual, Inputs instead = {}) const {
    if (any(usual) && any(instead)) {
      throw InputError(fmt::format("both {} and {} are given; give one or the other", join(usual),
                                   join(instead)));
    }
    for (const Input input : any(instead) ? instead : usual) {
      const std::optional<double> value = bearing.*input;
      if (!value) {
        const std::string other = instead.size() == 0 ? "" : fmt::format(" (or {})", join(instead));
        throw InputError(fmt::format("{} is missing: the {} needs {}{}", join({input}), wanted,
                                     join(usual), other));
      }
      if (!(*value > 0) || std::isinf(*value))
        throw InputError(
            fmt::format("{} is {} in SI units; it must be positive", join({input}), *value));
    }
  }

  void refuse(Inputs inputs) const {
    for (const Input input : inputs) {
      if (bearing.*input) {
        throw InputError(
            fmt::format("{} is given, but the {} does not depend on it", join({input}), wanted));
      }
    }
  }

  void need_geometry() const {
    need({&Bearing::radius});
    need({&Bearing::clearance});
  }

  void need_depth() const {
    need({&Bearing::depth}, {&Bearing::scar_width});
    if (bearing.scar_width && bearing.contact != Contact::stationary)
      throw InputError("scar width is given, but only a stationary contact leaves a scar");
  }
};

void check(Quantity wanted, const Bearing& bearing) {
  using B = Bearing;
  const Checked inputs{name(wanted), bearing};
  inputs.need_geometry();
  if (wanted == Quantity::depth) {
    inputs.refuse({&B::depth, &B::scar_width});
  } else {
    inputs.need_depth();
  }
  if (wanted == Quantity::rate) {
    inputs.refuse({&B::rate});
  } else {
    inputs.need({&B::rate});
  }
  if (wanted == Quantity::pressure) {
    inputs.refuse({&B::pressure, &B::force, &B::length});
  } else if (wanted == Quantity::length) {
    inputs.refuse({&B::pressure, &B::length});
    inputs.need({&B::force});
  } else {
    inputs.need({&B::pressure}, {&B::force, &B::length});
  }
  if (wanted == Quantity::revolutions) {
    inputs.refuse({&B::revolutions, &B::speed, &B::time});
  } else if (wanted == Quantity::time) {
    inputs.refuse({&B::revolutions, &B::time});
    inputs.need({&B::speed});
  } else {
    inputs.need({&B::revolutions}, {&B::speed, &B::time});
  }
}

double pressure(const Bearing& b) {
  return b.pressure ? *b.pressure : *b.force / (2 * *b.radius * *b.length);
}

double revolutions(const Bearing& b) {
  return b.revolutions ? *b.revolutions : *b.speed * *b.time;
}

/// For a bearing of known depth, however it is given.
Solution from_depth(const Bearing& b) {
  Solution s;
  s.sigma = *b.clearance / *b.radius;
  s.delta =
      b.depth ? *b.depth / *b.radius : depth_from_scar(s.sigma, *b.scar_width / *b.radius).delta;
  s.wear_number = s.value = wear_number(b.contact, s.sigma, s.delta);
  return s;
}

}  // namespace

Solution geometry(const Bearing& b) {
  const Checked inputs{"wear number", b};
  inputs.need_geometry();
  inputs.need_depth();
  inputs.refuse({&Bearing::rate, &Bearing::pressure, &Bearing::force, &Bearing::length,
                 &Bearing::revolutions, &Bearing::speed, &Bearing::time});
  return from_depth(b);
}

Solution solve(Quantity wanted, const Bearing& b) {
  check(wanted, b);
  if (wanted == Quantity::depth) {
    Solution s;
    s.sigma = *b.clearance / *b.radius;
    s.wear_number = *b.rate * pressure(b) * revolutions(b);
    s.delta = depth_for(b.contact, s.sigma, s.wear_number);
    s.value = s.delta * *b.radius;
    return s;
  }
  Solution s = from_depth(b);
  switch (wanted) {
    case Quantity::depth:  // done above
    case Quantity::rate:
      s.value = s.wear_number / (pressure(b) * revolutions(b));
      break;
    case Quantity::pressure:
      s.value = s.wear_number / (*b.rate * revolutions(b));
      break;
    case Quantity::length:
      s.value = *b.force * *b.rate * revolutions(b) / (2 * *b.radius * s.wear_number);
      break;
    case Quantity::revolutions:
      s.value = s.wear_number / (*b.rate * pressure(b));
      break;
    case Quantity::time:
      s.value = s.wear_number / (*b.rate * pressure(b) * *b.speed);
      break;
  }
  return s;
}

Bearing sensitivity(Quantity wanted, const Bearing& b) {
  const Solution s = solve(wanted, b);
  const WearNumber w = wear_number_and_derivatives(b.contact, s.sigma, s.delta);
  const double by_sigma = w.d_sigma * s.sigma / w.value;
  const double by_delta = w.d_delta * s.delta / w.value;

  // Logarithmic derivatives of the balance (k p_a n) / w(sigma, delta) by every input; the solved
  // quantity compensates each.
  Bearing balance;
  balance.contact = b.contact;
  balance.radius = by_sigma + by_delta;
  balance.clearance = -by_sigma;
  balance.depth = -by_delta;
  if (b.scar_width) {
    const ScarDepth scar = depth_from_scar(s.sigma, *b.scar_width / *b.radius);
    balance.scar_width = -by_delta * scar.amplification;
    balance.clearance = -by_sigma - by_delta * scar.clearance_power;
    balance.radius = -*balance.scar_width - *balance.clearance;
  }
  if (b.force) balance.radius = *balance.radius - 1;  // p_a = F/(2 r L)
  balance.rate = balance.pressure = balance.force = 1;
  balance.length = -1;
  balance.revolutions = balance.speed = balance.time = 1;

  const Input answer = wanted == Quantity::rate          ? &Bearing::rate
                       : wanted == Quantity::depth       ? &Bearing::depth
                       : wanted == Quantity::pressure    ? &Bearing::pressure
                       : wanted == Quantity::length      ? &Bearing::length
                       : wanted == Quantity::revolutions ? &Bearing::revolutions
                                                         : &Bearing::time;
  Bearing result;
  result.contact = b.contact;
  for (const Name& n : names) {
    if (b.*n.input) result.*n.input = -*(balance.*n.input) / *(balance.*answer);
  }
  return result;
}

}  // namespace wearwell::bearing
