#include "wearwell/prob/response_block.h"

#include <cmath>

#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

// The normal law of y, or of its logarithm, row by row: `location` and `scale` are of that.
struct NormalRow {
  double value, by_location, by_scale;
};

NormalRow normal_row(double y, double location, double scale) {
  const double inverse = 1 / scale, z = (y - location) * inverse;
  return {-0.5 * z * z - std::log(scale) - half_log_two_pi, z * inverse, (z * z - 1) * inverse};
}

bool positive(double x) {
  return x > 0 && x < infinity;
}

// Of two parameters, its logarithms at hand.
void weibull_responses(const ResponseColumn& column, std::size_t begin,
                       std::span<const SlotValues> slots, std::span<double> value,
                       std::span<double> slope, const auto& refuse) {
  const std::size_t n = value.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double scale = slots[0][i], shape = slots[1][i];
    if (!(positive(scale) && positive(shape))) {
      refuse(i);
      continue;
    }
    const double log_y = column.log_at[begin + i], off = log_y - std::log(scale);
    const double z = shape * off, e = std::exp(z);
    value[i] = z - e + std::log(shape) - log_y;
    if (!slope.empty()) {
      slope[i] = (e - 1) * shape / scale;
      slope[n + i] = (1 - e) * off + 1 / shape;
      slope[2 * n + i] = shape / std::exp(log_y) * (e - 1 + 1 / shape);
    }
  }
}

}  // namespace

ResponseColumn::ResponseColumn(std::vector<Response> responses) : rows(std::move(responses)) {
  plain = true;
  bool all_positive = true;
  for (const Response& each : rows) {
    plain = plain && each.seen == Seen::exactly && each.entry == -infinity && each.trials == 0;
    all_positive = all_positive && each.at > 0;
  }
  if (!plain) return;
  for (const Response& each : rows) at.push_back(each.at);
  if (!all_positive) return;
  for (const Response& each : rows) log_at.push_back(std::log(each.at));
}

void log_responses(ResponseFamily family, const ResponseColumn& column, std::size_t begin,
                   std::span<const SlotValues> slots, std::span<double> value,
                   std::span<double> slope) {
  const std::size_t n = value.size();
  const bool sloped = !slope.empty();
  const auto refuse = [&](std::size_t i) {
    value[i] = -infinity;
    if (!sloped) return;
    for (std::size_t s = 0; s < slots.size(); ++s) slope[s * n + i] = 0;
  };
  if (column.plain && family == ResponseFamily::normal) {
    for (std::size_t i = 0; i < n; ++i) {
      const double mean = slots[0][i], sd = slots[1][i];
      if (!(positive(sd) && std::isfinite(mean))) {
        refuse(i);
        continue;
      }
      const NormalRow row = normal_row(column.at[begin + i], mean, sd);
      value[i] = row.value;
      if (sloped) {
        slope[i] = row.by_location;
        slope[n + i] = row.by_scale;
      }
    }
    return;
  }
  const bool logs = column.log_at.size() == column.rows.size();
  if (logs && (family == ResponseFamily::lognormal || family == ResponseFamily::log10_normal)) {
    const double unit = family == ResponseFamily::lognormal ? 1 : ln10;
    for (std::size_t i = 0; i < n; ++i) {
      const double median = slots[0][i], sd = unit * slots[1][i];
      if (!(positive(median) && positive(sd))) {
        refuse(i);
        continue;
      }
      const double log_y = column.log_at[begin + i];
      const NormalRow row = normal_row(log_y, std::log(median), sd);
      value[i] = row.value - log_y;
      if (sloped) {
        slope[i] = row.by_location / median;
        slope[n + i] = unit * row.by_scale;
      }
    }
    return;
  }
  if (logs && family == ResponseFamily::weibull && slots[2].uniform && *slots[2].at == 0) {
    weibull_responses(column, begin, slots, value, slope, refuse);
    return;
  }
  double s[most_response_slots] = {};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < slots.size(); ++k) s[k] = slots[k][i];
    if (!sloped) {
      value[i] = log_response_value(family, column.rows[begin + i], s);
      continue;
    }
    const ResponseTerm term = log_response(family, column.rows[begin + i], s);
    if (!(term.value > -infinity)) {
      refuse(i);
      continue;
    }
    value[i] = term.value;
    for (std::size_t k = 0; k < slots.size(); ++k) slope[k * n + i] = term.slope[k];
  }
}

}  // namespace wearwell
