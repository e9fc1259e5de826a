#include "wearwell/models/formula_model/formula_extreme_value.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/linear_form.h"
#include "wearwell/models/formula_model/unit_rule.h"

namespace wearwell::formula_model {
namespace {

bool is_mirrored(const ResponseForm& form) {
  return form.family == ResponseFamily::largest_extreme_value || form.name == "frechet";
}

bool has_extreme_form(const ResponseForm& form) {
  return form.family == ResponseFamily::weibull || form.family == ResponseFamily::exponential ||
         form.family == ResponseFamily::smallest_extreme_value || is_mirrored(form);
}

// Whether the row's log-likelihood is -(life/scale)^shape, and log of its derivative if it failed.
bool fits(const Response& row, const ResponseForm& form) {
  const Censoring censored = is_mirrored(form) ? Censoring::left : Censoring::right;
  const double least = form.positive ? 0 : -infinity;
  if (row.seen != Censoring::none && row.seen != censored) return false;
  if (!(row.at > least && row.at < infinity)) return false;
  if (!(row.entry > least)) return true;
  return !is_mirrored(form) && row.entry <= row.at;
}

// How a lognormal or normal effect moves with s z, from its median: its value, s z being `t` or `t` widths.
double moved(bool lognormal, double middle, double width, double t) {
  return lognormal ? middle * std::exp(t) : middle + width * t;
}

double width_of_effect(const Population& population) {
  const double middle = population.middle[0];
  return middle != 0 ? std::abs(middle) : population.scatter[0];
}

// Whether the log scale (of positive lives) is linear in the logarithm of a lognormal effect or in a
// normal one, and the second parameter does not depend on it.
bool is_log_linear(UnitRows& rows, bool positive) {
  constexpr double places[] = {0, 1, -3, -0.5, 4};
  const Population& population = rows.population();
  const bool lognormal = rows.model().effects[0].lognormal;
  const std::size_t n = rows.columns()[0].unit.size();
  std::vector<double> first[5], second[5];
  for (int k = 0; k < 5; ++k) {
    first[k].resize(n);
    second[k].resize(n);
    const double at =
        moved(lognormal, population.middle[0], width_of_effect(population), places[k]);
    rows.means_at(&at, 0, first[k], second[k]);
    for (double& each : first[k]) each = positive ? std::log(each) : each;
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (int k = 1; k < 5; ++k) {
      const double slope = first[1][i] - first[0][i], by = slope * places[k];
      const double size = std::abs(first[0][i]) + std::abs(by) + (positive ? 1 : 0);
      if (!(std::abs(first[k][i] - first[0][i] - by) <= 1e-12 * size)) return false;
      if (second[k][i] != second[0][i]) return false;
    }
  }
  return true;
}

}  // namespace

bool has_extreme_values(const FormulaModel& model, const std::vector<BoundColumn>& columns) {
  if (model.effects.size() != 1 || columns.size() != 1 || has_cases(model)) return false;
  const Measured& measured = *columns[0].measured;
  if (!has_extreme_form(*measured.form) || measured.process || !measured.life.plain()) return false;
  if (measured.reporting || model.modes || model.use_rate || model.has_exposure()) return false;
  for (std::size_t i = 0; i < columns[0].unit.size(); ++i) {
    if (columns[0].count[i] > 0 && !fits(columns[0].responses.rows[i], *measured.form))
      return false;
  }
  UnitRows rows(model, columns);
  for (const std::vector<double>& x : trial_points(model)) {
    rows.move_to(x.data());
    if (!is_log_linear(rows, measured.form->positive)) return false;
  }
  return true;
}

ExtremeValueUnits::ExtremeValueUnits(UnitRows& rows)
    : rows_(rows),
      model_(rows.model()),
      column_(rows.columns()[0]),
      positive_(column_.measured->form->positive),
      by_shape_(positive_),
      one_shape_(column_.measured->form->family == ResponseFamily::exponential),
      side_(is_mirrored(*column_.measured->form) ? -1 : 1),
      unit_(model_.units.size()) {
  const std::size_t n = column_.unit.size();
  const auto scaled = [&](double life) { return positive_ ? std::log(life) : life; };
  for (const Response& each : column_.responses.rows) {
    const bool entered = each.entry > (positive_ ? 0 : -infinity);
    row_.push_back(
        {scaled(each.at), entered ? scaled(each.entry) : 0, each.seen == Censoring::none, entered});
  }
  for (auto* each : {&place_, &probed_, &second_, &log_scale_, &slope_, &log_hazard_, &share_,
                     &by_place_, &by_probed_, &by_second_}) {
    each->resize(n);
  }
}

void ExtremeValueUnits::move() {
  const Population& population = rows_.population();
  const bool lognormal = model_.effects[0].lognormal;
  width_ = lognormal ? 1 : width_of_effect(population);
  base_ = population.middle[0];
  probe_ = moved(lognormal, base_, width_, 1);
  rows_.means_at(&probe_, 0, probed_, second_);
  rows_.means_at(&base_, 0, place_, second_);
  read_rows();
  gather_rows();
}

double ExtremeValueUnits::offset(double log_life, std::size_t i) const {
  return side_ * second_[i] * (log_life - log_scale_[i]);
}

// The slope of the log scale, and the log hazard of each row at z = 0; `second_` becomes the shape.
void ExtremeValueUnits::read_rows() {
  const std::size_t n = row_.size();
  log_scale_ = place_;
  slope_ = probed_;
  if (positive_) {
    log_all(log_scale_.data(), log_scale_.data(), n);
    log_all(slope_.data(), slope_.data(), n);
  }
  for (std::size_t i = 0; i < n; ++i) {
    slope_[i] -= log_scale_[i];
    second_[i] = one_shape_ ? 1 : by_shape_ ? second_[i] : 1 / second_[i];
    log_hazard_[i] = offset(row_[i].log_life, i);
  }
}

void ExtremeValueUnits::gather_rows() {
  constexpr double alike =
      1e-9;  // shapes and slopes of the rows of a unit differ by rounding alone
  const double scatter = rows_.population().scatter[0] / width_;
  collapsed_ = true;
  for (std::size_t u = 0; u < unit_.size(); ++u) {
    Unit& unit = unit_[u];
    unit = {0, {0, 0, 0}, -infinity, 0, 0};
    bool any = false;
    for (std::size_t i = column_.begin[u]; i < column_.begin[u + 1]; ++i) {
      if (!(column_.count[i] > 0)) continue;
      const double shape = second_[i], slope = slope_[i];
      if (!(shape > 0 && std::isfinite(shape) && std::isfinite(log_hazard_[i]) &&
            std::isfinite(slope))) {
        collapsed_ = false;
        return;
      }
      if (!any) unit.shape = shape, unit.slope = slope;
      any = true;
      if (std::abs(shape - unit.shape) > alike * unit.shape ||
          std::abs(slope - unit.slope) > alike * std::abs(unit.slope)) {
        collapsed_ = false;
        return;
      }
      unit.highest = std::max(unit.highest, log_hazard_[i]);
    }
    for (std::size_t i = column_.begin[u]; i < column_.begin[u + 1]; ++i)
      share_[i] = log_hazard_[i] - unit.highest;
    unit.form.rate = side_ * unit.shape * unit.slope * scatter;
  }
  exp_all(share_.data(), share_.data(), share_.size());
  for (std::size_t u = 0; u < unit_.size(); ++u) {
    Unit& unit = unit_[u];
    double sum = 0, log_shape = 0, last = 0;
    for (std::size_t i = column_.begin[u]; i < column_.begin[u + 1]; ++i) {
      const double count = column_.count[i];
      if (!(count > 0)) continue;
      const Row& row = row_[i];
      const double before = row.entered ? offset(row.log_entry, i) - log_hazard_[i] : -infinity;
      sum += count * share_[i] * -std::expm1(before);
      if (!row.failed) continue;
      if (second_[i] != last) log_shape = std::log(last = second_[i]);
      unit.form.failures += count;
      unit.constant += count * (log_shape + log_hazard_[i] - (positive_ ? row.log_life : 0));
    }
    unit.form.log_sum = sum > 0 ? unit.highest + std::log(sum) : -infinity;
  }
}

std::optional<double> ExtremeValueUnits::sum(std::span<double> gradient) {
  if (!collapsed_) return {};
  const bool sloped = !gradient.empty();
  double sum = 0;
  Population by;
  for (std::size_t u = 0; u < unit_.size(); ++u) {
    const Unit& unit = unit_[u];
    const auto integral = unit.form.log_integral(nodes_);
    if (!integral) return {};
    sum += unit.constant + *integral;
    if (!sloped) continue;
    Means means;
    for (std::size_t k = 0; k < nodes_.count; ++k) {
      const double z = nodes_.z[k], hazard = nodes_.f[k] * nodes_.hazard[k];
      means.z += nodes_.f[k] * z;
      means.hazard += hazard;
      means.hazard_z += hazard * z;
    }
    add_means(u, means, by);
  }
  if (!sloped || !std::isfinite(sum)) return sum;
  const std::size_t n = row_.size();
  rows_.add_population_gradient(by, gradient);
  const std::span<const double> by_second = by_second_;
  rows_.add_mean_gradient(&base_, 0, {by_place_.data(), n},
                          one_shape_ ? std::span<const double>() : by_second, gradient);
  rows_.add_mean_gradient(&probe_, 0, {by_probed_.data(), n}, {}, gradient);
  return sum;
}

// The mean derivatives of a unit's rows under its posterior, for one observation each.
void ExtremeValueUnits::add_means(std::size_t u, const Means& means, Population& by) {
  const Unit& unit = unit_[u];
  const bool lognormal = model_.effects[0].lognormal;
  const double scatter = rows_.population().scatter[0] / width_, rate = unit.form.rate;
  const double share_of_sum = std::exp(unit.highest - unit.form.log_sum);
  double slope = 0, slope_z = 0;  // by the log scale
  for (std::size_t i = column_.begin[u]; i < column_.begin[u + 1]; ++i) {
    const double count = column_.count[i];
    if (!(count > 0)) continue;
    const Row& row = row_[i];
    const double failed = row.failed ? 1 : 0, shape = second_[i];
    const double share = share_[i] * share_of_sum, w = log_hazard_[i];
    double own = share, by_shape = failed * (1 + w - rate * means.z) -
                                   share * (w * means.hazard - rate * means.hazard_z);
    if (row.entered) {
      const double before = offset(row.log_entry, i);
      const double entry = std::exp(before - unit.form.log_sum);
      own -= entry;
      by_shape += entry * (before * means.hazard - rate * means.hazard_z);
    }
    const double by_scale = -side_ * shape * (failed - own * means.hazard);
    const double by_scale_z = -side_ * shape * (failed * means.z - own * means.hazard_z);
    slope += count * by_scale;
    slope_z += count * by_scale_z;
    by_place_[i] = (by_scale - scatter * by_scale_z) / (positive_ ? place_[i] : 1);
    by_probed_[i] = scatter * by_scale_z / (positive_ ? probed_[i] : 1);
    by_second_[i] = by_shape_ ? by_shape / shape : -by_shape * shape;
  }
  by.middle[0] += slope * unit.slope / (lognormal ? base_ : width_);
  by.scatter[0] += slope_z * unit.slope / width_;
}

bool ExtremeValueUnits::each(std::vector<double>& log_likelihood) {
  if (!collapsed_) return false;
  log_likelihood.resize(unit_.size());
  for (std::size_t u = 0; u < unit_.size(); ++u) {
    const auto integral = unit_[u].form.log_integral(nodes_);
    if (!integral) return false;
    log_likelihood[u] = unit_[u].constant + *integral;
  }
  return true;
}

bool ExtremeValueUnits::integrate(latent::UnitIntegrals& result) {
  if (!collapsed_) return false;
  result.restart(unit_.size(), 1);
  for (std::size_t u = 0; u < unit_.size(); ++u) {
    const auto integral = unit_[u].form.log_integral(nodes_, ExtremeValueUnit::fine);
    if (!integral) return false;
    result.log_likelihood[u] = unit_[u].constant + *integral;
    for (std::size_t k = 0; k < nodes_.count; ++k) result.put(u, k, &nodes_.z[k], nodes_.f[k]);
  }
  result.finish();
  return true;
}

}  // namespace wearwell::formula_model
