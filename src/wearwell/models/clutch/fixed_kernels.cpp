#include "wearwell/models/clutch/fixed_kernels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wearwell/models/clutch/fixed_sum.h"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace wearwell::clutch::fixed_kernels {
namespace {

using lanes::Reals;
using lanes::Wholes;

constexpr std::size_t cached_cells = 64;
/// Shorter runs are added across models instead of rows.
constexpr std::size_t short_run = 4;

constexpr double inverse_of_whole[degree + 1] = {0,       1,       1.0 / 2, 1.0 / 3, 1.0 / 4,
                                                 1.0 / 5, 1.0 / 6, 1.0 / 7, 1.0 / 8};

/// A block's columns, padded with ones.
struct Columns {
  alignas(64) double slip_speed[block], torque[block], temperature[block],
      closing_time[block], energy[block], speed[block], time[block];  ///< the last two: logarithms
};

void fill(const FixedCycles& cycles, std::size_t first, std::size_t rows, double energy_unit,
          Columns& to) {
  for (std::size_t i = 0; i < block; ++i) {
    const bool there = i < rows;
    to.slip_speed[i] = there ? cycles.slip_speed[first + i] : 1;
    to.torque[i] = there ? cycles.torque[first + i] : 1;
    to.temperature[i] = there ? cycles.temperature[first + i] : 1;
    to.closing_time[i] = there ? cycles.closing_time[first + i] : 1;
    to.energy[i] = there ? static_cast<double>(cycles.energy[first + i]) * energy_unit : 0;
  }
}

WEARWELL_LANES void find_logs(Columns& x, std::size_t rows) {
  for (std::size_t i = 0; i < rows; ++i) x.speed[i] = lanes::log(x.speed[i]);
  for (std::size_t i = 0; i < rows; ++i) x.time[i] = lanes::log(x.time[i]);
}

WEARWELL_LANES void find_power(const double* log, double power, std::size_t rows, double* to) {
  for (std::size_t i = 0; i < rows; ++i) to[i] = lanes::exp(power * log[i]);
}

WEARWELL_LANES void find_terms(const Columns& x, std::size_t rows, double* to) {
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = x.temperature[i], m = x.torque[i];
    const double products[terms] = {m,         m * m, m * m * m, t,        t * m,
                                    t * m * m, t * t, t * t * m, t * t * t};
    for (std::size_t p = 0; p < terms; ++p) to[p * block + i] = products[p];
  }
}

/// This number of vectors fits into registers.
constexpr std::size_t at_once = 8;

/// Rates of one model; then w + |w|, which is 2 w or 0, times energy.
WEARWELL_LANES bool find_rate(const Plan& plan, std::size_t model, const Columns& x,
                              std::size_t vectors, Workspace& work) {
  const Rate& rate = plan.rates[model];
  const lanes::Line* const speed = &work.speed[rate.speed * block_vectors];
  const lanes::Line* const time = &work.time[rate.time * block_vectors];
  lanes::Line* const settled = &work.settled[model * (block_vectors + 1)];
  // Volumes are non-negative, and their bits as integers have the same order; NaN is above all, or
  // negative.
  const auto most = __builtin_bit_cast(long long, rate.most);
  Wholes beyond{};
  for (std::size_t v = 0; v < vectors; v += at_once) {
    Reals w[at_once] = {}, distance[at_once];
    for (std::size_t j = 0; j < at_once; ++j)
      distance[j] = lanes::load(speed[v + j]) * lanes::load(time[v + j]);
    for (const Rate::Level& level : rate.levels) {
      for (std::size_t j = 0; j < at_once; ++j) w[j] = w[j] * distance[j] + level.constant;
      for (const Rate::Term& each : level.terms) {
        const lanes::Line* const term = &work.term[each.term * block_vectors + v];
        for (std::size_t j = 0; j < at_once; ++j) w[j] += each.coefficient * lanes::load(term[j]);
      }
    }
    for (std::size_t j = 0; j < at_once; ++j) {
      if (model == 0) lanes::store(&work.w[(v + j) * lanes::count], w[j]);
      const Reals energy = lanes::load(x.energy + (v + j) * lanes::count);
      const Reals volume = (w[j] + lanes::absolute(w[j])) * (energy * rate.scale);
      lanes::store(settled[v + j], volume);
      beyond |= (most - lanes::bits(volume)) | lanes::bits(volume);
    }
  }
  for (int i = 0; i < lanes::count; ++i) {
    if (beyond[i] < 0) return false;
  }
  return true;
}

WEARWELL_LANES void find_variance(const Plan& plan, const Columns& x, std::size_t rows,
                                  Workspace& work) {
  const auto add = [&](const auto& law) __attribute__((always_inline)) {
    const double floor = plan.scatter_floor, scale = plan.variance_scale;
    for (std::size_t i = 0; i < rows; ++i) {
      const double given = law(i);
      // Not max(), which would hide NaN.
      const double step = (given < floor ? floor : given) * x.energy[i];
      work.variance[i] = step * step * scale;
    }
  };
  const double* const p = plan.scatter.p.data();
  const double* const w = work.w.data();
  switch (plan.scatter.kind) {
    case ScatterKind::exponential:
      return add([&](std::size_t i) { return p[0] * lanes::exp(p[1] * w[i]); });
    case ScatterKind::linear:
      return add([&](std::size_t i) { return p[0] + p[1] * w[i]; });
    case ScatterKind::quadratic:
      return add([&](std::size_t i) { return p[0] + w[i] * (p[1] + w[i] * p[2]); });
    case ScatterKind::conditions:
      return add([&](std::size_t i) {
        return p[0] + p[1] * x.temperature[i] + p[2] * x.slip_speed[i] + p[3] * x.torque[i] +
               p[4] * x.closing_time[i];
      });
  }
}

WEARWELL_LANES void find_decays(const double* share, const double* step, double middle,
                                std::size_t models, double* to) {
  for (std::size_t b = 0; b < models; ++b) to[b] = share[b] * lanes::exp(middle * step[b]);
}

WEARWELL_LANES void find_cell(const Plan& plan, std::int64_t number, double* c) {
  const double middle = 2 * static_cast<double>(number) + 1;  // in halves of a cell
  double* const slow = c + (degree + 1) * plan.stride;
  double* const fast = slow + plan.stride;
  find_decays(plan.slow.data(), plan.slow_step.data(), middle, plan.stride, slow);
  find_decays(plan.fast.data(), plan.fast_step.data(), middle, plan.stride, fast);
  for (std::size_t b = 0; b < plan.stride; b += lanes::count) {
    const Reals slow_step = lanes::load(&plan.slow_step[b]),
                fast_step = lanes::load(&plan.fast_step[b]);
    Reals by_slow = lanes::load(slow + b), by_fast = lanes::load(fast + b);
    lanes::store(c + b, 1.0 + by_slow + by_fast);
    for (std::size_t p = 1; p <= degree; ++p) {
      by_slow *= slow_step * inverse_of_whole[p];
      by_fast *= fast_step * inverse_of_whole[p];
      lanes::store(c + p * plan.stride + b, by_slow + by_fast);
    }
  }
}

/// A run along rows.
WEARWELL_LANES void add_rows(const Plan& plan, const double* c, std::size_t from, std::size_t to,
                             Workspace& work) {
  const auto rows = static_cast<long long>(to - from);
  for (std::size_t b = 0; b < plan.models; ++b) {
    double k[degree + 1];
    for (std::size_t p = 0; p <= degree; ++p) k[p] = c[p * plan.stride + b];
    const double* const settled = work.settled_of(b) + from;
    Wholes volumes{}, settleds{};
    for (long long i = 0; i < rows; i += lanes::count) {
      const Reals x = lanes::load(&work.at[from + static_cast<std::size_t>(i)]);
      Reals g = x * k[degree] + k[degree - 1];
      for (std::size_t p = degree - 1; p-- > 0;) g = g * x + k[p];
      if (b == 0) {
        lanes::store(&work.g[from + static_cast<std::size_t>(i)], g);
        continue;
      }
      const Reals w = lanes::load(settled + i);
      const Wholes mine = lanes::first(rows - i);
      volumes += (lanes::bits(w * g + lanes::to_whole) - lanes::to_whole_bits) & mine;
      settleds += (lanes::bits(w + lanes::to_whole) - lanes::to_whole_bits) & mine;
    }
    if (b == 0) continue;
    lanes::add(work.volumes[b].x, volumes);
    lanes::add(work.settleds[b].x, settleds);
  }
}

/// One row across models.
WEARWELL_LANES void add_row(const Plan& plan, const double* c, std::size_t row, Workspace& work) {
  const double at = work.at[row];
  double* const settled = work.one_row.data();
  for (std::size_t b = 1; b < plan.models; ++b) settled[b] = work.settled_of(b)[row];
  for (std::size_t b = 0; b < plan.stride; b += lanes::count) {
    Reals g = at * lanes::load(c + degree * plan.stride + b) +
              lanes::load(c + (degree - 1) * plan.stride + b);
    for (std::size_t p = degree - 1; p-- > 0;) g = g * at + lanes::load(c + p * plan.stride + b);
    if (b == 0) work.g[row] = g[0];
    const Reals w = lanes::load(settled + b);
    lanes::add(&work.row_volumes[b], lanes::bits(w * g + lanes::to_whole) - lanes::to_whole_bits);
    lanes::add(&work.row_settleds[b], lanes::bits(w + lanes::to_whole) - lanes::to_whole_bits);
  }
}

}  // namespace

std::size_t term(int temperature, int torque) {
  constexpr std::size_t first[] = {0, 3, 6, 8};
  return first[temperature] + static_cast<std::size_t>(torque) - (temperature == 0 ? 1 : 0);
}

void Workspace::prepare(const Plan& plan) {
  speed.resize(plan.speed_powers.size() * block_vectors);
  time.resize(plan.time_powers.size() * block_vectors);
  term.resize(terms * block_vectors);
  settled.resize(plan.models * (block_vectors + 1));
  volumes.assign(plan.stride, {});
  settleds.assign(plan.stride, {});
  row_volumes.assign(plan.stride, 0);
  row_settleds.assign(plan.stride, 0);
  one_row.assign(plan.stride, 0);
  cells.resize(cached_cells);
  for (Cell& each : cells) each.c.resize((degree + 3) * plan.stride);
}

const Cell& Workspace::cell(const Plan& plan, std::int64_t number) {
  Cell& found = cells[static_cast<std::size_t>(number) % cells.size()];
  if (found.number != number) {
    find_cell(plan, number, found.c.data());
    found.number = number;
  }
  return found;
}

bool find_rates(const Plan& plan, const FixedCycles& cycles, std::size_t first, std::size_t rows,
                Workspace& work) {
  Columns x;
  fill(cycles, first, rows, plan.energy_unit, x);
  constexpr std::size_t step = at_once * lanes::count;
  const std::size_t vectors = (rows + step - 1) / step * at_once;
  bool fits = true;
  for (std::size_t i = 0; i < rows; ++i) {
    work.at[i] = cycles.at[first + i];
    const double values[] = {x.slip_speed[i], x.torque[i], x.temperature[i], x.closing_time[i]};
    for (std::size_t c = 0; c < 4; ++c)
      fits &= std::abs(values[c]) * plan.input_scale[c] < lanes::largest_whole / 2;
    // The vector logarithm is not defined for denormals.
    x.speed[i] = std::max(x.slip_speed[i], std::numeric_limits<double>::min());
    x.time[i] = std::max(x.closing_time[i], std::numeric_limits<double>::min());
  }
  const std::size_t filled = vectors * lanes::count;
  std::fill(x.speed + rows, x.speed + filled, 1);
  std::fill(x.time + rows, x.time + filled, 1);
  find_logs(x, filled);
  for (std::size_t p = 0; p < plan.speed_powers.size(); ++p)
    find_power(x.speed, plan.speed_powers[p], filled, work.speed[p * block_vectors].x);
  for (std::size_t p = 0; p < plan.time_powers.size(); ++p)
    find_power(x.time, plan.time_powers[p], filled, work.time[p * block_vectors].x);
  find_terms(x, filled, work.term.front().x);
  for (std::size_t b = 0; b < plan.models; ++b) fits &= find_rate(plan, b, x, vectors, work);
  find_variance(plan, x, rows, work);
  return fits;
}

void add_run(const Plan& plan, const Cell& cell, std::size_t from, std::size_t to,
             Workspace& work) {
  if (to - from >= short_run) {
    work.has_runs = true;
    add_rows(plan, cell.c.data(), from, to, work);
    return;
  }
  for (std::size_t i = from; i < to; ++i) add_row(plan, cell.c.data(), i, work);
}

WEARWELL_LANES void add_inputs(const Plan& plan, const FixedCycles& cycles, std::size_t from,
                               std::size_t to, long long* sums, std::int64_t* counts) {
  const double* const columns[] = {cycles.slip_speed.data(), cycles.torque.data(),
                                   cycles.temperature.data(), cycles.closing_time.data()};
  std::array<std::uint8_t, block> any{};
  for (std::size_t c = 0; c < 4; ++c) {
    const double* const x = columns[c] + from;
    const double low = plan.from[c], high = plan.to[c], scale = plan.input_scale[c];
    long long sum = 0;
    std::int64_t out = 0;
    for (std::size_t i = 0; i < to - from; ++i) {
      const double shifted = x[i] * scale + lanes::to_whole;
      sum += __builtin_bit_cast(long long, shifted) - lanes::to_whole_bits;
      const bool outside = (x[i] < low) | (x[i] > high);
      out += outside;
      any[i] |= outside;
    }
    sums[c] = sum;
    counts[outside_first + c] += out;
  }
  for (std::size_t i = 0; i < to - from; ++i) counts[outside_any] += any[i];
}

}  // namespace wearwell::clutch::fixed_kernels
