#include "wearwell/models/formula_model/effect_lines.h"

#include <algorithm>
#include <cmath>

namespace wearwell::formula_model {
namespace {

constexpr double least_share = 1e-7;  // of a unit's posterior: smaller nodes are left out

// Nodes of the trapezoidal rule, which is exact for a normal distribution.
void fill_normal(double step, double reach, std::vector<double>& z, std::vector<double>& share) {
  const int most = static_cast<int>(reach / step);
  double sum = 0;
  for (int i = -most; i <= most; ++i) {
    z.push_back(i * step);
    share.push_back(std::exp(-0.5 * z.back() * z.back()));
    sum += share.back();
  }
  for (double& each : share) each /= sum;
}

}  // namespace

NormalNodes::NormalNodes(std::size_t effects, double reach, double step) : weight{1} {
  const int most = static_cast<int>(reach / step);
  for (std::size_t k = 0; k < effects; ++k) {
    std::vector<double> places, weights;
    for (std::size_t i = 0; i < weight.size(); ++i) {
      for (int j = -most; j <= most; ++j) {
        places.insert(places.end(), z.begin() + static_cast<std::ptrdiff_t>(i * k),
                      z.begin() + static_cast<std::ptrdiff_t>((i + 1) * k));
        places.push_back(j * step);
        weights.push_back(weight[i] * std::exp(-0.5 * j * j * step * step));
      }
    }
    z = std::move(places);
    weight = std::move(weights);
  }
  double sum = 0;
  for (const double each : weight) sum += each;
  for (double& each : weight) each /= sum;
}

EffectLines lines_of_new_unit(std::size_t effects, double step, double reach) {
  EffectLines lines;
  if (effects == 0) {
    lines.share = {1};
    lines.ends = {1};
    return lines;
  }
  if (effects == 1) {
    fill_normal(step, reach, lines.z, lines.share);
    lines.ends = {lines.count()};
    return lines;
  }
  constexpr double negligible = 1e-10;
  std::vector<double> along, across, share_along, share_across;
  fill_normal(step, reach, along, share_along);
  fill_normal(0.5, reach, across, share_across);
  for (std::size_t j = 0; j < across.size(); ++j) {
    for (std::size_t i = 0; i < along.size(); ++i) {
      const double share = share_along[i] * share_across[j];
      if (!(share > negligible) || std::hypot(along[i], across[j]) > reach) continue;
      lines.z.insert(lines.z.end(), {along[i], across[j]});
      lines.share.push_back(share);
    }
    if (lines.ends.empty() ? lines.count() > 0 : lines.count() > lines.ends.back()) {
      lines.ends.push_back(lines.count());
    }
  }
  return lines;
}

void turn(const EffectLines& lines, const double direction[2], EffectLines& turned) {
  turned = lines;
  double c = direction[0], s = direction[1];
  const double length = std::hypot(c, s);
  if (!(length > 0) || !std::isfinite(length)) {
    c = s = std::sqrt(0.5);
  } else {
    c /= length;
    s /= length;
  }
  for (std::size_t i = 0; i < lines.count(); ++i) {
    const double a = lines.z[2 * i], b = lines.z[2 * i + 1];
    turned.z[2 * i] = c * a - s * b;
    turned.z[2 * i + 1] = s * a + c * b;
  }
}

void lines_of_seen_unit(const latent::UnitIntegrals& integrals, std::size_t unit,
                        std::size_t effects, EffectLines& lines) {
  lines.z.clear();
  lines.share.clear();
  lines.ends.clear();
  if (effects > 1) {
    for (const latent::Sweep& sweep : integrals.sweeps) {
      if (!(sweep.weight[unit] > least_share)) continue;
      const double* z = &sweep.z[unit * effects];
      lines.z.insert(lines.z.end(), {z[0], z[1]});
      lines.share.push_back(sweep.weight[unit]);
      lines.ends.push_back(lines.count());
    }
    return;
  }
  static thread_local std::vector<std::pair<double, double>> nodes;
  nodes.clear();
  for (const latent::Sweep& sweep : integrals.sweeps) {
    if (sweep.weight[unit] > 0) nodes.emplace_back(sweep.z[unit], sweep.weight[unit]);
  }
  std::sort(nodes.begin(), nodes.end());
  // All nodes from the first to the last non-negligible one, so that steps between them stay even.
  const auto counts = [](const auto& node) { return node.second > least_share; };
  const auto first = std::find_if(nodes.begin(), nodes.end(), counts);
  const auto last = std::find_if(nodes.rbegin(), std::make_reverse_iterator(first), counts).base();
  for (auto each = first; each != last; ++each) {
    lines.z.push_back(each->first);
    lines.share.push_back(each->second);
  }
  if (lines.count() > 0) lines.ends.push_back(lines.count());
}

}  // namespace wearwell::formula_model
