#include "wearwell/models/clutch/fixed_sum.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "wearwell/base/error.h"
#include "wearwell/models/clutch/fixed_kernels.h"

namespace wearwell::clutch {

namespace k = fixed_kernels;

struct FixedSum::Plan : k::Plan {};

struct FixedSum::Workspace : k::Workspace {
  FixedTotals totals;
};

void FixedCycles::clear() {
  for (auto* each : {&slip_speed, &torque, &temperature, &closing_time, &at}) each->clear();
  for (auto* each : {&energy, &cell}) each->clear();
  ends.clear();
}

namespace {

/// Highest powers of the slip distance first.
k::Rate rate_of(const WearPolynomial& w, std::vector<double>& speeds, std::vector<double>& times) {
  const auto index = [](std::vector<double>& all, double x) {
    const auto at = std::find(all.begin(), all.end(), x);
    const auto place = static_cast<std::size_t>(at - all.begin());
    if (at == all.end()) all.push_back(x);
    return place;
  };
  std::map<std::array<int, 3>, double> sums;
  int highest = 0;
  for (const auto& m : w.monomials) {
    sums[{m.ds, m.temperature, m.torque}] += m.coefficient;
    highest = std::max(highest, m.ds);
  }
  k::Rate rate;
  rate.speed = index(speeds, w.r);
  rate.time = index(times, w.q);
  for (int power = highest; power >= 0; --power) {
    rate.levels.push_back({sums[{power, 0, 0}], {}});
    for (const auto& [powers, value] : sums) {
      if (powers[0] == power && powers[1] + powers[2] > 0)
        rate.levels.back().terms.push_back({k::term(powers[1], powers[2]), value});
    }
  }
  return rate;
}

void add_run_in(k::Plan& plan, std::size_t b, const RunIn& run_in, double half_cell) {
  plan.slow[b] = run_in.slow;
  plan.fast[b] = run_in.fast;
  plan.slow_step[b] = -half_cell / run_in.slow_energy;
  plan.fast_step[b] = -half_cell / run_in.fast_energy;
}

/// A summand rounded to an integer.
std::int64_t whole(double x) {
  if (!(std::abs(x) < 9.2e18)) throw InputError("the wear of a cycle is out of range of the sums");
  return std::llrint(x);
}

Wide wide(double x) {
  if (std::abs(x) < 9.2e18) return std::llrint(x);
  if (!(std::abs(x) < 1e38)) throw InputError("the wear of a cycle is out of range of the sums");
  return static_cast<Wide>(x);  // an integer of its own
}

void add_to(Wide& sum, Wide x) {
  if (__builtin_add_overflow(sum, x, &sum))
    throw InputError("the wear of a unit is out of range of the sums");
}

}  // namespace

FixedSum::FixedSum(const WearModel& model, bool replicates)
    : units_(fixed_units(model)),
      replicates_(replicates ? model.replicates.size() : 0),
      plan_(std::make_unique<Plan>()) {
  constexpr int least_shift = 12, most_shift = 62;
  double decay = std::min(model.run_in.slow_energy, model.run_in.fast_energy);
  for (std::size_t b = 0; b < replicates_; ++b)
    decay = std::min(
        {decay, model.replicates[b].run_in.slow_energy, model.replicates[b].run_in.fast_energy});
  // A cell is at most a quarter of the shortest decay.
  shift_ = std::min(std::ilogb(decay / 4 / units_.energy), most_shift);
  if (!(decay > 0) || shift_ < least_shift)
    throw InputError("the model's run-in decays within less energy than the sums resolve");
  two_cells_ = std::ldexp(1, 1 - shift_);
  k::Plan& plan = *plan_;
  const double half_cell = std::ldexp(units_.energy, shift_ - 1);
  plan.models = replicates_ + 1;
  plan.stride = (plan.models + lanes::count - 1) / lanes::count * lanes::count;
  for (auto* each : {&plan.slow, &plan.fast, &plan.slow_step, &plan.fast_step})
    each->assign(plan.stride, 0);
  std::vector<double> largest_g;
  for (std::size_t b = 0; b < plan.models; ++b) {
    const Replicate* other = b > 0 ? &model.replicates[b - 1] : nullptr;
    const RunIn& run_in = other ? other->run_in : model.run_in;
    plan.rates.push_back(
        rate_of(other ? other->w : model.polynomial(), plan.speed_powers, plan.time_powers));
    add_run_in(plan, b, run_in, half_cell);
    plan.rates.back().scale = 0.5 / (b > 0 ? units_.volume : units_.fine);
    // With run-in still well below the limit of rounding by addition, with a run of rows in 64
    // bits.
    plan.rates.back().most =
        b > 0 ? 0x1p50 / (2 + std::abs(run_in.slow) + std::abs(run_in.fast)) : INFINITY;
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const double low = model.lowest.*inputs[i].value, high = model.highest.*inputs[i].value;
    const double slack = validity_slack * (high - low);
    plan.from[i] = low - slack;
    plan.to[i] = high + slack;
    plan.input_scale[i] = 1 / units_.inputs[i];
  }
  plan.energy_unit = units_.energy;
  plan.variance_scale = 1 / units_.variance;
  plan.scatter = model.scatter;
  plan.scatter_floor = model.scatter_floor;
}

FixedSum::~FixedSum() = default;

void FixedSum::place(Wide before, std::int64_t& cell, double& at) const {
  cell = static_cast<std::int64_t>(before >> shift_);
  const auto inside = static_cast<std::int64_t>(before & ((Wide{1} << shift_) - 1));
  at = static_cast<double>(inside) * two_cells_ - 1;
}

std::shared_ptr<FixedSum::Workspace> FixedSum::workspace() const {
  auto made = std::make_shared<Workspace>();
  made->prepare(*plan_);
  made->totals.sums.assign(sums(), 0);
  return made;
}

/// The 128-bit sums: the model itself, and its scatter.
void FixedSum::middle(const FixedCycles& cycles, std::size_t first, std::size_t from,
                      std::size_t to, Workspace& workspace) const {
  FixedTotals& totals = workspace.totals;
  Wide energy = 0, volume = 0, variance = 0, settled = 0;
  for (std::size_t i = from; i < to; ++i) {
    energy += cycles.energy[first + i];
    const double w = workspace.settled_of(0)[i];
    add_to(volume, wide(w * workspace.g[i]));
    add_to(settled, wide(w));
    add_to(variance, wide(workspace.variance[i]));
  }
  add_to(totals.sums[energy_sum], energy);
  add_to(totals.sums[volume_sum], volume);
  add_to(totals.sums[variance_sum], variance);
  add_to(totals.sums[settled_sum], settled);
}

void FixedSum::quick(const FixedCycles& cycles, std::size_t first, std::size_t from, std::size_t to,
                     Workspace& workspace) const {
  for (std::size_t i = from; i < to;) {
    std::size_t end = i + 1;
    while (end < to && cycles.cell[first + end] == cycles.cell[first + i]) ++end;
    const k::Cell& cell = workspace.cell(*plan_, cycles.cell[first + i]);
    k::add_run(*plan_, cell, i, end, workspace);
    i = end;
  }
  long long sums[4] = {};
  k::add_inputs(*plan_, cycles, first + from, first + to, sums, workspace.totals.counts.data());
  for (std::size_t i = 0; i < 4; ++i) workspace.totals.sums[input_sums + i] += sums[i];
}

/// The same with a check of every summand: some do not fit the range of `quick`.
void FixedSum::careful(const FixedCycles& cycles, std::size_t first, std::size_t from,
                       std::size_t to, Workspace& workspace) const {
  auto& sums = workspace.totals.sums;
  const std::vector<double>* columns[] = {&cycles.slip_speed, &cycles.torque, &cycles.temperature,
                                          &cycles.closing_time};
  for (std::size_t i = from; i < to; ++i) {
    const k::Cell& cell = workspace.cell(*plan_, cycles.cell[first + i]);
    const double x = cycles.at[first + i];
    const auto g = [&](std::size_t b) {
      double sum = cell.c[k::degree * plan_->stride + b];
      for (std::size_t p = k::degree; p-- > 0;) sum = sum * x + cell.c[p * plan_->stride + b];
      return sum;
    };
    workspace.g[i] = g(0);
    for (std::size_t b = 1; b <= replicates_; ++b) {
      const double w = workspace.settled_of(b)[i];
      sums[replicate_sums + b - 1] += whole(w * g(b));
      sums[replicate_sums + replicates_ + b - 1] += whole(w);
    }
    for (std::size_t c = 0; c < 4; ++c)
      sums[input_sums + c] += whole((*columns[c])[first + i] * plan_->input_scale[c]);
  }
  long long ignored[4];
  k::add_inputs(*plan_, cycles, first + from, first + to, ignored, workspace.totals.counts.data());
}

void FixedSum::add(const FixedCycles& cycles, Workspace& workspace,
                   const std::function<void(std::size_t, const FixedTotals&)>& take) const {
  FixedTotals& totals = workspace.totals;
  std::size_t segment = 0;
  for (std::size_t first = 0; first < cycles.size(); first += k::block) {
    const std::size_t rows = std::min(k::block, cycles.size() - first);
    const bool fits = k::find_rates(*plan_, cycles, first, rows, workspace);
    for (std::size_t i = 0; i < rows;) {
      const std::size_t end = std::min(rows, cycles.ends[segment] - first);
      if (fits) {
        quick(cycles, first, i, end, workspace);
      } else {
        careful(cycles, first, i, end, workspace);
      }
      middle(cycles, first, i, end, workspace);
      totals.counts[counted] += static_cast<std::int64_t>(end - i);
      for (std::size_t r = i; r < end; ++r) totals.counts[negative] += workspace.w[r] < 0;
      i = end;
      if (first + i < cycles.ends[segment]) continue;
      Wide* const replicates = totals.sums.data() + replicate_sums;
      workspace.take_sums(replicates_, replicates, replicates + replicates_);
      take(segment++, totals);
      totals.counts = {};
      std::fill(totals.sums.begin(), totals.sums.end(), 0);
    }
  }
}

}  // namespace wearwell::clutch
