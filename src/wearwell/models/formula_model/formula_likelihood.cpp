#include "wearwell/models/formula_model/formula_likelihood.h"

#include <algorithm>
#include <cmath>

#include "wearwell/base/stop_scope.h"
#include "wearwell/math/compensated_sum.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/formula_drawn.h"
#include "wearwell/models/formula_model/formula_gathered.h"
#include "wearwell/models/formula_model/formula_hidden_path.h"
#include "wearwell/models/formula_model/formula_row_columns.h"
#include "wearwell/models/formula_model/joint_failures.h"
#include "wearwell/models/formula_model/linear_form.h"
#include "wearwell/models/formula_model/subpopulation_order.h"

// Longer than others: one likelihood: rows, integrals over effects, gradients of both.
namespace wearwell::formula_model {
namespace {

constexpr std::size_t rows_of_call = 256;

void note_growth(BoundColumn& bound) {
  bound.log_growth.resize(bound.unit.size());
  for (std::size_t u = 0; u + 1 < bound.begin.size(); ++u) {
    double before = 0;
    for (std::size_t i = bound.begin[u]; i < bound.begin[u + 1]; ++i) {
      if (!(bound.count[i] > 0)) continue;
      const double reading = bound.responses.rows[i].at;
      bound.log_growth[i] = std::log(reading - before);
      before = reading;
    }
  }
}

BoundColumn bind_column(const FormulaModel& model, const Measured& measured, std::size_t count) {
  constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> seen(model.data.table.rows, none);
  for (std::size_t i = 0; i < measured.observed.rows.size(); ++i) {
    seen[measured.observed.rows[i]] = i;
  }
  const bool paths = measured.program.has_paths(), whole = paths || measured.process;
  BoundColumn bound;
  bound.measured = &measured;
  std::vector<std::size_t> which;
  std::vector<Response> responses;
  which.reserve(model.order.size());
  responses.reserve(model.order.size());
  bound.unit.reserve(model.order.size());
  bound.term.reserve(model.order.size());
  bound.count.reserve(model.order.size());
  for (const std::size_t row : model.order) {
    check_stop();
    const bool observed = seen[row] != none && row < count;
    if (!observed && !paths) continue;
    which.push_back(row);
    bound.unit.push_back(model.unit_of_row[row]);
    bound.term.push_back(seen[row]);
    bound.count.push_back(observed ? measured.observed.counts[seen[row]] : 0);
    // A row without an observation only continues the path.
    responses.push_back(observed ? measured.observed.responses[seen[row]]
                                 : measured.observed.responses.front());
  }
  for (std::size_t u = 0; u <= model.units.size(); ++u) {
    bound.begin.push_back(static_cast<std::size_t>(
        std::lower_bound(bound.unit.begin(), bound.unit.end(), u) - bound.unit.begin()));
  }
  RowColumns columns(model, which, measured.program);
  bound.most_rows = rows_of_call;
  if (whole) {
    for (std::size_t u = 0; u < model.units.size(); ++u) {
      if (bound.begin[u] < bound.begin[u + 1]) columns.rows.paths.push_back(bound.begin[u]);
      bound.most_rows = std::max(bound.most_rows, bound.begin[u + 1] - bound.begin[u]);
    }
  }
  bound.data = measured.program.bind(columns.rows);
  bound.responses = ResponseColumn(std::move(responses));
  const bool noisy =
      std::count(measured.family_parameter.begin(), measured.family_parameter.end(), 2) > 0;
  if (measured.process && measured.process->process != Process::wiener && !noisy) {
    note_growth(bound);
  }
  return bound;
}

}  // namespace

std::vector<BoundColumn> bind_columns(const FormulaModel& model, std::size_t rows) {
  std::vector<BoundColumn> all;
  for (const Measured& each : model.measured) all.push_back(bind_column(model, each, rows));
  return all;
}

UnitRows::UnitRows(const FormulaModel& model, const std::vector<BoundColumn>& columns)
    : model_(model), columns_(columns), population_at_(model) {
  std::size_t most = 0, most_slopes = 0;
  for (const BoundColumn& column : columns) {
    most_slopes = std::max(most_slopes, column.measured->life.parameters() * column.most_rows);
    workspaces_.push_back(column.measured->program.workspace(column.most_rows));
    most = std::max(most, column.most_rows);
  }
  inner_.resize(model.shared.size());
  inner_gradient_.resize(model.shared.size());
  value_.resize(most);
  slope_.resize(std::max(most_slopes, most_response_parameters * most));
  for (std::size_t e = 0; e < model.effects.size(); ++e) {
    effect_[e].resize(most);
    by_effect_[e].resize(most);
    effect_at_[e] = effect_[e].data();
    by_effect_at_[e] = by_effect_[e].data();
  }
}

void UnitRows::move_to(const double* x) {
  x_ = x;
  population_ = population_at_(x);
  for (std::size_t i = 0; i < inner_.size(); ++i) inner_[i] = x[model_.shared[i]];
}

// Runs of requested units, in calls of as many rows as fit.
template <class Visit>
void UnitRows::visit(std::span<const std::uint8_t> wanted, const Visit& visit) {
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const BoundColumn& column = columns_[c];
    const bool paths = column.measured->program.has_paths() || column.measured->process;
    const std::size_t units = model_.units.size();
    for (std::size_t u = 0; u < units;) {
      if (!wanted[u]) {
        ++u;
        continue;
      }
      std::size_t last = u + 1;
      const std::size_t begin = column.begin[u];
      while (last < units && wanted[last] &&
             (!paths || column.begin[last + 1] - begin <= column.most_rows)) {
        ++last;
      }
      const std::size_t end = column.begin[last];
      for (std::size_t at = begin; at < end; at += column.most_rows) {
        check_stop();
        visit(Chunk{&column, c, at, std::min(end, at + column.most_rows)});
      }
      u = last;
    }
  }
}

void UnitRows::run(const Chunk& chunk, std::span<const double> z) {
  const BoundColumn& column = *chunk.column;
  const std::size_t n = chunk.end - chunk.begin, d = model_.effects.size();
  for (std::size_t e = 0; e < d; ++e) {
    std::size_t last = model_.units.size();
    double value = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t u = column.unit[chunk.begin + i];
      if (u != last) {
        value = held_ ? held_[held_by_unit_ ? u : e] : population_.value(model_, e, &z[u * d]);
      }
      last = u;
      effect_[e][i] = value;
    }
  }
  formula::Workspace& workspace = workspaces_[chunk.index];
  column.measured->program.forward(column.data, chunk.begin, chunk.end, {inner_, {effect_at_, d}},
                                   workspace);
  family_parameters_.assign(column.measured->life.parameters(), {&zero_, true});
  const auto& outputs = column.measured->program.outputs();
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    family_parameters_[column.measured->family_parameter[o]] = {workspace.values(o).data(),
                                                                outputs[o].uniform};
  }
}

void UnitRows::forward(const Chunk& chunk, std::span<const double> z, bool sloped) {
  run(chunk, z);
  const BoundColumn& column = *chunk.column;
  const std::size_t n = chunk.end - chunk.begin;
  if (column.measured->process) return forward_process(chunk, sloped);
  const LifeMixture& life = column.measured->life;
  const std::span<double> value(value_.data(), n),
      slope = sloped ? std::span(slope_.data(), life.parameters() * n) : std::span<double>();
  if (column.measured->reporting) {
    log_responses(life, *column.measured->reporting, column.responses, chunk.begin,
                  family_parameters_, value, slope);
  } else {
    log_responses(life, column.responses, chunk.begin, family_parameters_, value, slope);
  }
}

// Unit by unit, for rows with a reading: `visit(rows of the chunk, ProcessRows)`.
template <class Visit>
void UnitRows::visit_processes(const Chunk& chunk, const Visit& visit) {
  const BoundColumn& column = *chunk.column;
  const std::size_t n = chunk.end - chunk.begin;
  const bool noisy = !(family_parameters_[2].uniform && family_parameters_[2].at == &zero_);
  const bool growing = !column.log_growth.empty();
  static thread_local std::vector<std::size_t> rows;
  static thread_local std::vector<double> reading, mean, spread, noise, log_growth;
  for (auto* each : {&reading, &mean, &spread, &noise, &log_growth}) each->resize(n);
  rows.resize(n);
  for (std::size_t i = 0; i < n;) {
    const std::size_t unit = column.unit[chunk.begin + i];
    std::size_t m = 0;
    for (; i < n && column.unit[chunk.begin + i] == unit; ++i) {
      if (!(column.count[chunk.begin + i] > 0)) continue;
      rows[m] = i;
      reading[m] = column.responses.rows[chunk.begin + i].at;
      mean[m] = family_parameters_[0][i];
      spread[m] = family_parameters_[1][i];
      if (noisy) noise[m] = family_parameters_[2][i];
      if (growing) log_growth[m] = column.log_growth[chunk.begin + i];
      ++m;
    }
    const auto of = [m](const std::vector<double>& all, bool any = true) {
      return std::span(all).first(any ? m : 0);
    };
    visit(
        unit, std::span<const std::size_t>(rows).first(m),
        ProcessRows{of(reading), of(mean), of(spread), of(noise, noisy), of(log_growth, growing)});
  }
}

void UnitRows::forward_process(const Chunk& chunk, bool sloped) {
  const std::size_t n = chunk.end - chunk.begin;
  static thread_local std::vector<double> value, slope;
  value.resize(n);
  slope.resize(sloped ? most_response_parameters * n : 0);
  std::fill_n(value_.begin(), n, 0.0);
  if (sloped) std::fill_n(slope_.begin(), most_response_parameters * n, 0.0);
  visit_processes(chunk, [&](std::size_t, auto rows, const ProcessRows& unit) {
    const std::size_t m = rows.size();
    const std::span<double> slopes =
        std::span(slope).first(sloped ? most_response_parameters * m : 0);
    process_terms(*chunk.column->measured->process, unit, std::span(value).first(m), slopes);
    for (std::size_t k = 0; k < m; ++k) {
      value_[rows[k]] = value[k];
      for (std::size_t s = 0; s < (sloped ? most_response_parameters : 0); ++s) {
        slope_[s * n + rows[k]] = slopes[s * m + k];
      }
    }
  });
}

std::vector<Standing> UnitRows::standings(std::span<const double> z, std::size_t c) {
  std::vector<Standing> all(model_.units.size());
  visit(std::vector<std::uint8_t>(model_.units.size(), 1), [&](const Chunk& chunk) {
    if (chunk.index != c) return;
    run(chunk, z);
    visit_processes(chunk, [&](std::size_t unit, auto, const ProcessRows& rows) {
      all[unit] = standing(*chunk.column->measured->process, rows);
    });
  });
  return all;
}

double UnitRows::unsettled_paths() {
  double worst = 0;
  visit(std::vector<std::uint8_t>(model_.units.size(), 1), [&](const Chunk& chunk) {
    const ProcessForm* form = chunk.column->measured->process;
    if (!form) return;
    run(chunk, {});
    visit_processes(chunk, [&](std::size_t, auto, const ProcessRows& unit) {
      if (is_hidden(*form, unit)) worst = std::max(worst, hidden_unsettled(*form, unit));
    });
  });
  return worst;
}

std::vector<NormalScore> UnitRows::step_scores(std::span<const double> z, std::size_t c) {
  std::vector<NormalScore> all(columns_[c].measured->observed.rows.size()), some;
  visit(std::vector<std::uint8_t>(model_.units.size(), 1), [&](const Chunk& chunk) {
    if (chunk.index != c) return;
    run(chunk, z);
    visit_processes(chunk, [&](std::size_t, auto rows, const ProcessRows& unit) {
      process_scores(*chunk.column->measured->process, unit, some);
      for (std::size_t k = 0; k < rows.size(); ++k) {
        all[chunk.column->term[chunk.begin + rows[k]]] = some[k];
      }
    });
  });
  return all;
}

double UnitRows::weight_of(const Chunk& chunk, std::size_t i, const double* weight) const {
  const double count = chunk.column->count[chunk.begin + i];
  return weight ? count * weight[chunk.column->unit[chunk.begin + i]] : count;
}

// The derivative of the sum over rows of weight times log density by each output.
void UnitRows::fill_adjoints(const Chunk& chunk, const double* weight) {
  const Measured& measured = *chunk.column->measured;
  const std::size_t n = chunk.end - chunk.begin;
  formula::Workspace& workspace = workspaces_[chunk.index];
  for (std::size_t o = 0; o < measured.program.outputs().size(); ++o) {
    const double* slope = slope_.data() + measured.family_parameter[o] * n;
    const std::span<double> adjoints = workspace.adjoints(o);
    if (measured.program.outputs()[o].uniform) {
      double sum = 0;
      for (std::size_t i = 0; i < n; ++i) sum += weight_of(chunk, i, weight) * slope[i];
      adjoints[0] = sum;
    } else {
      for (std::size_t i = 0; i < n; ++i) adjoints[i] = weight_of(chunk, i, weight) * slope[i];
    }
  }
  for (std::size_t e = 0; e < model_.effects.size(); ++e) {
    std::fill_n(by_effect_[e].begin(), n, 0.0);
  }
}

void UnitRows::evaluate(std::span<const double> z, std::span<const std::uint8_t> wanted,
                        std::span<double> value, std::span<double> slope) {
  const std::size_t d = model_.effects.size();
  const bool sloped = !slope.empty();
  for (std::size_t u = 0; u < model_.units.size(); ++u) {
    if (!wanted[u]) continue;
    value[u] = 0;
    if (sloped) std::fill_n(slope.begin() + static_cast<std::ptrdiff_t>(u * d), d, 0.0);
  }
  visit(wanted, [&](const Chunk& chunk) {
    forward(chunk, z, sloped);
    const std::size_t n = chunk.end - chunk.begin;
    for (std::size_t i = 0; i < n; ++i) {
      const double count = chunk.column->count[chunk.begin + i];
      if (count != 0) value[chunk.column->unit[chunk.begin + i]] += count * value_[i];
    }
    if (!sloped) return;
    fill_adjoints(chunk, nullptr);
    chunk.column->measured->program.reverse(chunk.column->data, chunk.begin, chunk.end,
                                            {inner_, {effect_at_, d}}, workspaces_[chunk.index],
                                            inner_gradient_, {by_effect_at_, d});
    const double r = population_.correlation, rest = std::sqrt(1 - r * r);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t u = chunk.column->unit[chunk.begin + i];
      for (std::size_t e = 0; e < d; ++e) {
        const double by_own = by_effect_[e][i] * population_.scatter[e] *
                              (model_.effects[e].lognormal ? effect_[e][i] : 1);
        if (e == 0) {
          slope[u * d] += by_own;
        } else {
          slope[u * d] += by_own * r;
          slope[u * d + 1] += by_own * rest;
        }
      }
    }
  });
}

void UnitRows::add_gradient(std::span<const double> z, std::span<const double> weight,
                            std::span<double> gradient) {
  const std::size_t d = model_.effects.size();
  std::vector<std::uint8_t> wanted(model_.units.size());
  for (std::size_t u = 0; u < wanted.size(); ++u) wanted[u] = weight[u] > 0;
  std::fill(inner_gradient_.begin(), inner_gradient_.end(), 0.0);
  Population by;
  visit(wanted, [&](const Chunk& chunk) {
    forward(chunk, z, true);
    fill_adjoints(chunk, weight.data());
    chunk.column->measured->program.reverse(chunk.column->data, chunk.begin, chunk.end,
                                            {inner_, {effect_at_, d}}, workspaces_[chunk.index],
                                            inner_gradient_, {by_effect_at_, d});
    const double r = population_.correlation, rest = std::sqrt(1 - r * r);
    for (std::size_t i = 0; i < chunk.end - chunk.begin; ++i) {
      const double* own_z = &z[chunk.column->unit[chunk.begin + i] * d];
      for (std::size_t e = 0; e < d; ++e) {
        const double own = e == 0 ? own_z[0] : r * own_z[0] + rest * own_z[1];
        const bool lognormal = model_.effects[e].lognormal;
        const double adjoint = by_effect_[e][i], value = effect_[e][i];
        by.middle[e] += adjoint * (lognormal ? value / population_.middle[e] : 1);
        const double by_own = adjoint * (lognormal ? value : 1);
        by.scatter[e] += by_own * own;
        if (e == 1 && model_.correlated) {
          by.correlation += by_own * population_.scatter[e] * (own_z[0] - r / rest * own_z[1]);
        }
      }
    }
  });
  for (std::size_t i = 0; i < inner_.size(); ++i) gradient[model_.shared[i]] += inner_gradient_[i];
  if (d > 0) population_at_.add_gradient(x_, by, gradient);
}

void UnitRows::means_at(const double* effects, std::size_t c, std::span<double> mean,
                        std::span<double> sd, std::span<double> noise) {
  held_ = effects;
  visit(std::vector<std::uint8_t>(model_.units.size(), 1), [&](const Chunk& chunk) {
    if (chunk.index != c) return;
    run(chunk, {});
    for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
      mean[i] = family_parameters_[0][i - chunk.begin];
      sd[i] = family_parameters_[1][i - chunk.begin];
      if (!noise.empty()) noise[i] = family_parameters_[2][i - chunk.begin];
    }
  });
  held_ = nullptr;
}

void UnitRows::means_of_units(std::span<const double> effects, std::size_t c,
                              std::span<double> mean) {
  held_ = effects.data();
  held_by_unit_ = true;
  visit(std::vector<std::uint8_t>(model_.units.size(), 1), [&](const Chunk& chunk) {
    if (chunk.index != c) return;
    run(chunk, {});
    for (std::size_t i = chunk.begin; i < chunk.end; ++i)
      mean[i] = family_parameters_[0][i - chunk.begin];
  });
  held_ = nullptr;
  held_by_unit_ = false;
}

void UnitRows::add_mean_gradient(const double* effects, std::size_t c,
                                 std::span<const double> by_mean, std::span<const double> by_sd,
                                 std::span<double> gradient, std::span<const double> by_noise) {
  held_ = effects;
  std::fill(inner_gradient_.begin(), inner_gradient_.end(), 0.0);
  visit(std::vector<std::uint8_t>(model_.units.size(), 1), [&](const Chunk& chunk) {
    if (chunk.index != c) return;
    run(chunk, {});
    const std::size_t n = chunk.end - chunk.begin;
    std::fill_n(slope_.begin(), most_response_parameters * n, 0.0);
    std::size_t family_parameter = 0;
    for (const std::span<const double> by : {by_mean, by_sd, by_noise}) {
      if (!by.empty()) {
        std::copy_n(by.begin() + static_cast<std::ptrdiff_t>(chunk.begin), n,
                    slope_.begin() + static_cast<std::ptrdiff_t>(family_parameter * n));
      }
      ++family_parameter;
    }
    fill_adjoints(chunk, nullptr);
    chunk.column->measured->program.reverse(
        chunk.column->data, chunk.begin, chunk.end, {inner_, {effect_at_, model_.effects.size()}},
        workspaces_[chunk.index], inner_gradient_, {by_effect_at_, model_.effects.size()});
  });
  held_ = nullptr;
  for (std::size_t i = 0; i < inner_.size(); ++i) gradient[model_.shared[i]] += inner_gradient_[i];
}

double UnitRows::accurate_sum() {
  CompensatedSum sum;
  visit(std::vector<std::uint8_t>(model_.units.size(), 1), [&](const Chunk& chunk) {
    forward(chunk, {}, false);
    for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
      const double count = chunk.column->count[i];
      if (count != 0) sum.add(count * value_[i - chunk.begin]);
    }
  });
  return sum.total();
}

std::vector<std::vector<double>> UnitRows::each_term(std::span<const double> z) {
  std::vector<std::vector<double>> all;
  for (const BoundColumn& column : columns_) {
    all.emplace_back(column.measured->observed.rows.size());
  }
  visit(std::vector<std::uint8_t>(model_.units.size(), 1), [&](const Chunk& chunk) {
    forward(chunk, z, false);
    for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
      if (chunk.column->count[i] > 0) {
        all[chunk.index][chunk.column->term[i]] = value_[i - chunk.begin];
      }
    }
  });
  return all;
}

std::vector<std::vector<double>> UnitRows::each_family_parameter(std::span<const double> z) {
  std::vector<std::vector<double>> all;
  for (const BoundColumn& column : columns_) {
    all.emplace_back(column.measured->life.parameters() * column.measured->observed.rows.size());
  }
  visit(std::vector<std::uint8_t>(model_.units.size(), 1), [&](const Chunk& chunk) {
    run(chunk, z);
    const std::size_t count = chunk.column->measured->life.parameters();
    for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
      if (!(chunk.column->count[i] > 0)) continue;
      for (std::size_t s = 0; s < count; ++s) {
        all[chunk.index][chunk.column->term[i] * count + s] =
            family_parameters_[s][i - chunk.begin];
      }
    }
  });
  return all;
}

namespace {

class FormulaLikelihood : public LogDensity {
 public:
  explicit FormulaLikelihood(std::shared_ptr<const FormulaRows> rows)
      : rows_(std::move(rows)),
        model_(&rows_->model()),
        all_(model_->units.size(), 1),
        ones_(model_->units.size(), 1) {}

  int dimension() const override { return static_cast<int>(model_->parameters.size()); }

  double value(std::span<const double> x) const override {
    Scratch& scratch = mine();
    if (model_->has_random_effects()) {
      if (scratch.linear) {
        scratch.rows.move_to(x.data());
        scratch.linear->move();
        if (const auto sum = scratch.linear->sum()) return number(*sum);
      }
      if (const auto sum = quick_sum(scratch, x, {})) return number(*sum);
      return number(rows_->integrate(x.data()).sum());
    }
    UnitRows& rows = scratch.to_sum();
    rows.move_to(x.data());
    scratch.value.resize(model_->units.size());
    rows.evaluate({}, all_, scratch.value, {});
    double sum = 0;
    for (const double each : scratch.value) sum += each;
    return number(sum);
  }

  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    Scratch& scratch = mine();
    std::fill(gradient.begin(), gradient.end(), 0.0);
    if (scratch.linear) {
      scratch.rows.move_to(x.data());
      scratch.linear->move();
      if (const auto all = scratch.linear->sum(gradient)) return number(*all);
    }
    if (const auto all = quick_sum(scratch, x, gradient)) return number(*all);
    const double sum = model_->has_random_effects() ? number(rows_->integrate(x.data()).sum())
                                                    : FormulaLikelihood::value(x);
    if (!(sum > -infinity)) return sum;
    if (!model_->has_random_effects()) {
      scratch.to_sum().add_gradient({}, ones_, gradient);
      return sum;
    }
    if (scratch.linear) {
      scratch.linear->add_gradient(scratch.integrals, gradient);
      return sum;
    }
    if (scratch.steps) {
      scratch.steps->add_gradient(scratch.integrals, gradient);
      return sum;
    }
    // The derivative of a log integral is the mean of the integrand's under the unit's posterior.
    constexpr double negligible = 1e-13;
    for (latent::Sweep& sweep : scratch.integrals.sweeps) {
      bool any = false;
      for (double& weight : sweep.weight) {
        if (!(weight > negligible)) weight = 0;
        any |= weight > 0;
      }
      if (any) scratch.rows.add_gradient(sweep.z, sweep.weight, gradient);
    }
    return sum;
  }

  // By unit if units vary, else by observation, column by column.
  std::vector<double> pointwise(std::span<const double> x) const override {
    if (!model_->draws_units()) return each_factor(x);
    return without_drawn_effects(*model_, x, *this,
                                 [this](std::span<const double> at) { return each_factor(at); });
  }

  std::vector<double> each_factor(std::span<const double> x) const {
    Scratch& scratch = mine();
    if (scratch.linear) {
      scratch.rows.move_to(x.data());
      scratch.linear->move();
      if (std::vector<double> each; scratch.linear->each(each)) return each;
    }
    if (std::vector<double> each; quick_each(scratch, x, each)) return each;
    if (model_->has_random_effects()) return rows_->integrate(x.data()).log_likelihood;
    scratch.rows.move_to(x.data());
    if (model_->by_unit()) {
      if (model_->units.size() < 2) return {};  // nothing else is left to predict it from
      scratch.value.resize(model_->units.size());
      scratch.rows.evaluate({}, all_, scratch.value, {});
      return scratch.value;
    }
    std::vector<double> all;
    for (const auto& column : scratch.rows.each_term({})) {
      all.insert(all.end(), column.begin(), column.end());
    }
    return all;
  }

  std::vector<int> pointwise_counts() const override {
    std::vector<int> counts;
    if (model_->by_unit()) return counts;
    for (const Measured& each : model_->measured) {
      counts.insert(counts.end(), each.observed.counts.begin(), each.observed.counts.end());
    }
    return counts;
  }

  double unsettled(std::span<const double> x) const override {
    return model_->has_random_effects() ? rows_->integrate(x.data()).unsettled : 0;
  }

 protected:
  using Scratch = FormulaRows::Scratch;
  Scratch& mine() const { return rows_->mine(); }

 private:
  static double number(double value) { return value < infinity ? value : -infinity; }

  // By a table or by sums over steps or lives, each unit by its own rule.
  static std::optional<double> quick_sum(Scratch& scratch, std::span<const double> x,
                                         std::span<double> gradient) {
    std::optional<double> sum;
    with_quick_units(scratch, x, [&](auto& units) { sum = units.sum(gradient); });
    return sum;
  }
  static bool quick_each(Scratch& scratch, std::span<const double> x, std::vector<double>& each) {
    bool done = false;
    with_quick_units(scratch, x, [&](auto& units) { done = units.each(each); });
    return done;
  }
  template <class Visit>
  static void with_quick_units(Scratch& scratch, std::span<const double> x, const Visit& visit) {
    if (!scratch.tabled && !scratch.steps && !scratch.extreme) return;
    scratch.rows.move_to(x.data());
    const auto at = [&](auto& units) {
      units.move();
      visit(units);
    };
    if (scratch.tabled) return at(*scratch.tabled);
    if (scratch.extreme) return at(*scratch.extreme);
    at(*scratch.steps);
  }

  std::shared_ptr<const FormulaRows> rows_;
  const FormulaModel* model_;
  std::vector<std::uint8_t> all_;
  std::vector<double> ones_;
};

// Of paths observed with errors, row by row on a lattice.
class HiddenLikelihood final : public FormulaLikelihood {
 public:
  using FormulaLikelihood::FormulaLikelihood;
  bool is_slow() const override { return true; }
  double unsettled(std::span<const double> x) const override {
    constexpr double fine = 1e-4;
    UnitRows& rows = mine().rows;
    rows.move_to(x.data());
    const double open = rows.unsettled_paths();
    return open > fine ? open : 0;
  }
};

// Of units with an unknown use, each an integral over rates: a lattice of four parameters would take minutes.
class UseRateLikelihood final : public FormulaLikelihood {
 public:
  using FormulaLikelihood::FormulaLikelihood;
  bool is_slow() const override { return true; }
};

// Of exchangeable subpopulations: with the order that tells them apart.
class OrderedLikelihood final : public FormulaLikelihood {
 public:
  explicit OrderedLikelihood(const std::shared_ptr<const FormulaRows>& rows)
      : FormulaLikelihood(rows), model_(rows->model()) {}

  double value(std::span<const double> x) const override {
    const double all = FormulaLikelihood::value(x);
    return all > -infinity ? all + own_order().value(x) : all;
  }
  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    const double all = FormulaLikelihood::value_and_gradient(x, gradient);
    return all > -infinity ? all + own_order().value(x, gradient) : all;
  }

 private:
  SubpopulationOrder& own_order() const {
    std::unique_ptr<SubpopulationOrder>& order = order_.local();
    if (!order) order = std::make_unique<SubpopulationOrder>(model_);
    return *order;
  }

  const FormulaModel& model_;
  mutable tbb::enumerable_thread_specific<std::unique_ptr<SubpopulationOrder>> order_;
};

// Of failure modes: those one by one, and what failures of unknown mode and within intervals add.
class ModesLikelihood final : public FormulaLikelihood {
 public:
  ModesLikelihood(std::shared_ptr<const FormulaRows> rows, std::size_t count)
      : FormulaLikelihood(rows), rows_(std::move(rows)), count_(count) {}

  double value(std::span<const double> x) const override {
    const double apart = FormulaLikelihood::value(x);
    if (!(apart > -infinity)) return apart;
    JointFailures& joint = own_joint();
    joint.evaluate(x);
    return sum_of(apart, joint.sum());
  }

  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    const double apart = FormulaLikelihood::value_and_gradient(x, gradient);
    if (!(apart > -infinity)) return apart;
    JointFailures& joint = own_joint();
    joint.evaluate(x, gradient);
    return sum_of(apart, joint.sum());
  }

  // By row: the product over the modes.
  std::vector<double> pointwise(std::span<const double> x) const override {
    UnitRows& rows = mine().rows;
    rows.move_to(x.data());
    const FormulaModel& model = rows_->model();
    std::vector<double> all(count_);
    const std::vector<std::vector<double>> terms = rows.each_term({});
    for (std::size_t k = 0; k < terms.size(); ++k) {
      for (std::size_t i = 0; i < terms[k].size(); ++i) {
        const std::size_t row = model.measured[k].observed.rows[i];
        if (row < count_) all[row] += terms[k][i];
      }
    }
    JointFailures& joint = own_joint();
    const std::span<const double> factors = joint.evaluate(x);
    for (std::size_t i = 0; i < factors.size(); ++i) all[joint.failures()[i].row] += factors[i];
    return all;
  }

  std::vector<int> pointwise_counts() const override {
    const std::vector<int>& counts = rows_->model().lives.counts;
    return {counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(count_)};
  }

  double unsettled(std::span<const double> x) const override {
    constexpr double fine = 1e-6;
    JointFailures& joint = own_joint();
    joint.evaluate(x);
    return joint.open() > fine ? joint.open() : 0;
  }

 private:
  static double sum_of(double apart, double joint) {
    const double sum = apart + joint;
    return sum < infinity ? sum : -infinity;
  }
  JointFailures& own_joint() const {
    std::unique_ptr<JointFailures>& joint = joint_.local();
    if (!joint) joint = std::make_unique<JointFailures>(rows_->model(), count_);
    return *joint;
  }

  std::shared_ptr<const FormulaRows> rows_;
  std::size_t count_;
  mutable tbb::enumerable_thread_specific<std::unique_ptr<JointFailures>> joint_;
};

}  // namespace

FormulaRows::FormulaRows(std::shared_ptr<const FormulaModel> model, std::size_t rows,
                         bool again_and_again)
    : model_(std::move(model)), rows_(rows), columns_(bind_columns(*model_, rows)) {
  linear_ = is_linear(*model_, columns_);
  proportional_ = is_proportional(*model_, columns_);
  extreme_ = has_extreme_values(*model_, columns_);
  if (again_and_again && !linear_) tabled_ = tabled_form(*model_, columns_);
  if (again_and_again) gathered_ = gathered_columns(*model_, columns_);
}

void FormulaRows::keep_gathered_at(const double* x) {
  // Of the log likelihood: far below what moves a posterior. A plain sum of ten million terms is rounded by more.
  constexpr double close = 1e-4;
  if (gathered_.empty()) return;
  const auto sum = [&](const std::vector<BoundColumn>& columns) {
    UnitRows rows(*model_, columns);
    rows.move_to(x);
    return rows.accurate_sum();
  };
  if (std::abs(sum(gathered_) - sum(columns_)) <= close) return;
  gathered_.clear();
  scratch_.clear();
}

const latent::UnitIntegrals& FormulaRows::integrate(const double* x) const {
  Scratch& scratch = mine();
  scratch.rows.move_to(x);
  if (scratch.linear) {
    scratch.linear->move();
    if (!scratch.linear->integrate(scratch.integrals)) {
      latent::integrate(*scratch.linear, scratch.integrals);
    }
  } else if (scratch.steps) {
    scratch.steps->move();
    if (!scratch.steps->integrate(scratch.integrals)) {
      latent::integrate(*scratch.steps, scratch.integrals);
    }
  } else if (scratch.tabled) {
    scratch.tabled->move();
    latent::integrate(*scratch.tabled, scratch.integrals);
  } else if (scratch.extreme) {
    scratch.extreme->move();
    if (!scratch.extreme->integrate(scratch.integrals)) {
      latent::integrate(scratch.rows, scratch.integrals);
    }
  } else {
    latent::integrate(scratch.rows, scratch.integrals);
  }
  return scratch.integrals;
}

FormulaRows::Scratch& FormulaRows::mine() const {
  std::unique_ptr<Scratch>& scratch = scratch_.local();
  if (!scratch) {
    scratch.reset(new Scratch{UnitRows(*model_, columns_), {}, {}, {}, {}, {}, {}, {}});
    if (!gathered_.empty()) scratch->gathered = std::make_unique<UnitRows>(*model_, gathered_);
    if (linear_) scratch->linear = std::make_unique<LinearUnits>(scratch->rows);
    if (proportional_) scratch->steps = std::make_unique<StepUnits>(scratch->rows);
    if (extreme_) scratch->extreme = std::make_unique<ExtremeValueUnits>(scratch->rows);
    if (tabled_) {
      std::call_once(table_made_, [&] { table_ = make_table(scratch->rows, *tabled_); });
      if (table_) scratch->tabled = std::make_unique<TabledUnits>(scratch->rows, *tabled_, table_);
    }
  }
  return *scratch;
}

std::shared_ptr<const LogDensity> formula_likelihood(std::shared_ptr<const FormulaRows> rows) {
  if (rows->model().has_hidden_paths()) {
    return std::make_shared<HiddenLikelihood>(std::move(rows));
  }
  if (rows->model().modes) {
    const std::size_t count = rows->rows();
    return std::make_shared<ModesLikelihood>(std::move(rows), count);
  }
  if (rows->model().use_rate && !rows->model().use_rate->in_time.observed.rows.empty())
    return std::make_shared<UseRateLikelihood>(std::move(rows));
  if (rows->model().subpopulations && rows->model().subpopulations->exchangeable)
    return std::make_shared<OrderedLikelihood>(rows);
  return std::make_shared<FormulaLikelihood>(std::move(rows));
}

}  // namespace wearwell::formula_model
