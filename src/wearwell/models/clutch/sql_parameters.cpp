#include "wearwell/models/clutch/sql_parameters.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/models/clutch/clutch_sql.h"

namespace wearwell::clutch {
namespace {

std::string name_of(const std::array<int, 3>& powers) {
  constexpr const char* names[] = {"ds", "Td", "Mz"};
  std::string text;
  for (std::size_t i = 0; i < 3; ++i) {
    for (int n = 0; n < powers[i]; ++n) text += (text.empty() ? "" : "*") + std::string(names[i]);
  }
  return text.empty() ? "1" : text;
}

class Builder {
 public:
  void add(std::size_t replicate, const std::string& name, double value) {
    out.all.push_back({replicate, name, value, fmt::format("k{}_{}", replicate, count_++)});
  }

  void add(std::size_t replicate, const WearPolynomial& w, const RunIn& run_in) {
    count_ = 0;
    add(replicate, "r", w.r);
    add(replicate, "q", w.q);
    const auto pair = std::find_if(out.pairs.begin(), out.pairs.end(), [&](const auto& each) {
      return each.second == std::pair(w.r, w.q);
    });
    out.pair_of.push_back(static_cast<std::size_t>(pair - out.pairs.begin()));
    if (pair == out.pairs.end()) out.pairs.push_back({replicate, {w.r, w.q}});
    std::map<std::array<int, 3>, double> sums;
    for (const auto& m : w.monomials) sums[{m.ds, m.temperature, m.torque}] += m.coefficient;
    out.monomials.emplace_back();
    for (const auto& [powers, value] : sums) {
      add(replicate, name_of(powers), value);
      out.monomials.back()[powers] = name_of(powers);
    }
    add(replicate, "slow", run_in.slow);
    add(replicate, "fast", run_in.fast);
    add(replicate, "slow_energy", run_in.slow_energy);
    add(replicate, "fast_energy", run_in.fast_energy);
    // A factor applied once per row, where a division takes longer.
    add(replicate, "slow_rate", -1 / run_in.slow_energy);
    add(replicate, "fast_rate", -1 / run_in.fast_energy);
  }

  SqlParameters out;

 private:
  int count_ = 0;
};

/// c[0] + x (c[1] + x (c[2] + x c[3])), without empty terms.
std::string nested(const std::array<std::string, 4>& c, const std::string& x) {
  std::string text;
  for (int p = 3; p >= 0; --p) {
    const std::string& own = c[static_cast<std::size_t>(p)];
    if (text.empty()) {
      text = own;
    } else {
      text = fmt::format("{} * {}", x, text);
      if (!own.empty()) text = fmt::format("({} + {})", own, text);
    }
  }
  return text;
}

}  // namespace

const std::string& SqlParameters::column(std::size_t replicate, const std::string& name) const {
  return std::find_if(all.begin(), all.end(),
                      [&](const SqlParameter& each) {
                        return each.replicate == replicate && each.name == name;
                      })
      ->column;
}

SqlParameters sql_parameters(const WearModel& model, bool replicates, bool inlined) {
  Builder builder;
  builder.add(0, model.polynomial(), model.run_in);
  for (std::size_t i = 0; i < model.scatter.p.size(); ++i)
    builder.add(0, fmt::format("sigma{}", i + 1), model.scatter.p[i]);
  builder.add(0, "sigma_floor", model.scatter_floor);
  builder.add(0, "plate_sd", model.plate_sd);
  builder.add(0, "worn_out", model.worn_out);
  for (const Input& input : inputs) {
    const double low = model.lowest.*input.value, high = model.highest.*input.value;
    const double slack = validity_slack * (high - low);
    builder.add(0, fmt::format("{}_from", input.name), low - slack);
    builder.add(0, fmt::format("{}_to", input.name), high + slack);
  }
  for (std::size_t b = 0; replicates && b < model.replicates.size(); ++b)
    builder.add(b + 1, model.replicates[b].w, model.replicates[b].run_in);
  if (inlined)
    for (SqlParameter& each : builder.out.all) each.column = fmt::format("float8 '{}'", each.value);
  return std::move(builder.out);
}

std::string horner(const SqlParameters& parameters, std::size_t replicate,
                   const std::string& prefix) {
  std::array<std::string, 4> by_ds;
  for (int a = 0; a < 4; ++a) {
    std::array<std::string, 4> by_temperature;
    for (int t = 0; t < 4; ++t) {
      std::array<std::string, 4> by_torque;
      for (int m = 0; m < 4; ++m) {
        const auto& known = parameters.monomials[replicate];
        const auto at = known.find({a, t, m});
        if (at != known.end())
          by_torque[static_cast<std::size_t>(m)] =
              prefix + parameters.column(replicate, at->second);
      }
      by_temperature[static_cast<std::size_t>(t)] = nested(by_torque, "torque");
    }
    by_ds[static_cast<std::size_t>(a)] = nested(by_temperature, "temperature");
  }
  const std::string text = nested(by_ds, fmt::format("ds{}", parameters.pair_of[replicate]));
  return text.empty() ? "0e0" : text;
}

FixedUnits fixed_units(const WearModel& model) {
  constexpr int bits = 38, fine_bits = 60;
  const auto unit = [](double size, int below) {
    return std::ldexp(1, static_cast<int>(std::floor(std::log2(size))) - below);
  };
  OperatingPoint middle;
  for (const Input& input : inputs)
    middle.*input.value = 0.5 * (model.lowest.*input.value + model.highest.*input.value);
  const double energy = closing_energy(middle), w = model.polynomial()(middle);
  constexpr double least = 1e-7;  // of a life, in one cycle
  const double volume = std::max(std::isfinite(w) ? w * energy : 0, least * model.worn_out);
  const double sigma = model.sigma(std::max(w, 0.0), middle);
  const double sd = std::max(std::isfinite(sigma) ? sigma * energy : 0, least * volume);
  FixedUnits units{unit(energy, bits),
                   unit(volume, bits),
                   unit(volume, fine_bits),
                   unit(sd * sd, fine_bits),
                   {}};
  for (std::size_t i = 0; i < inputs.size(); ++i)
    units.inputs[i] = unit(std::max(std::abs(model.highest.*inputs[i].value), 1.0), bits);
  return units;
}

}  // namespace wearwell::clutch
