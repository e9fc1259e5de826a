#include "wearwell/models/formula_model/classical_estimates.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "wearwell/models/formula_model/classical_quantities.h"

namespace wearwell::formula_model {
namespace {

// Longer lists of steps are thinned; more are not distinct in a plot or table.
constexpr std::size_t most_steps_listed = 10000;

// A share on its way to 0 or 1.
constexpr double at_bound = 1e-4;

// Items with a rank each; a rank costs a quantile of a beta distribution.
constexpr double most_ranked = 20000;

// In the unit of the report.
ClassicalEstimate reported(const ScaledQuantity& quantity, const ClassicalBounds& bounds) {
  ClassicalEstimate estimate;
  estimate.name = quantity.name;
  estimate.of = quantity.of;
  estimate.at = quantity.at;
  estimate.unit = quantity.unit.text;
  estimate.scale = quantity.scale;
  set_bounds(estimate, bounds, [&](double y) { return from_si(quantity.unit, quantity.si(y)); });
  if (quantity.increasing) return estimate;
  std::swap(estimate.lower, estimate.upper);
  std::swap(estimate.ratio_lower, estimate.ratio_upper);
  return estimate;
}

ClassicalBounds bounds_of(const MaximumLikelihood& maximum, const ScaledQuantity& quantity,
                          double level) {
  const MaximumLikelihood::Quantity own = quantity.make();
  const MaximumLikelihood::Comparison above =
      quantity.compare ? quantity.compare()
                       : [&own](const double* x, double value) { return own(x) - value; };
  return maximum.of(own, above, level);
}

// Without a maximum: a share goes to its bound, or failures are too few.
std::string reason_of_none(const FormulaModel& model, const std::vector<NormalScale>& scales,
                           const MaximumLikelihood& maximum) {
  for (std::size_t i = 0; i < scales.size(); ++i) {
    if (scales[i] != NormalScale::logit || maximum.highest().size() == 0) continue;
    const double share = maximum.highest()[static_cast<Eigen::Index>(i)];
    if (std::min(share, 1 - share) < at_bound)
      return fmt::format(
          "the likelihood rises until the share {} is {:.0f}, its bound, where estimates have no "
          "bounds; a study without this share fits these data as well",
          model.parameters[i].name, share);
  }
  return fmt::format(
      "the likelihood has no maximum: it rises without end along {}, because too few failures "
      "differ",
      model.parameters[static_cast<std::size_t>(maximum.rising())].name);
}

void add_notes_of_maximum(const AskedOfClassics& asked, const MaximumLikelihood& maximum,
                          ClassicalEstimates& result) {
  const FormulaModel& model = *asked.model;
  if (model.subpopulations)
    result.notes.push_back(
        "The likelihood of subpopulations has no bound where one of them shrinks to a single life; "
        "the estimate is the highest local maximum that searches from the posterior reach, with "
        "median lives in the order of the names. Likelihood-ratio bounds follow the profile "
        "outward "
        "from there: where it has several branches, they can be too narrow.");
  else if (maximum.higher_elsewhere())
    result.notes.push_back(
        model.measured.front().life.plain()
            ? "The likelihood has no bound elsewhere (a threshold near the first life); the "
              "estimate is its local maximum."
            : "The likelihood is higher elsewhere, towards the bound of a share or without bound; "
              "the estimate is its local maximum.");
}

// An interval of the likelihood ratio that contains 0 or 1 ends at that bound of the share.
void note_open_shares(ClassicalEstimates& result) {
  for (ClassicalEstimate& each : result.parameters) {
    if (each.scale != "logit") continue;
    const auto note = [&](ProfileEnd& end, int bound) {
      if (!end.open.starts_with("the likelihood allows")) return;
      end.open += fmt::format(", to the bound {} of a share", bound);
      result.notes.push_back(fmt::format(
          "{}: the likelihood-ratio interval has no end before {}, the bound of a share: the data "
          "do not exclude it.",
          each.name, bound));
    };
    note(each.ratio_lower, 0);
    note(each.ratio_upper, 1);
  }
}

// Lives beyond the share that fails at the maximum have no estimate.
void drop_never_reached(const AskedOfClassics& asked, ClassicalEstimates& result) {
  std::vector<std::string> names;
  std::erase_if(result.quantities, [&](const ClassicalEstimate& each) {
    if (std::isfinite(each.value)) return false;
    names.push_back(asked.lives.size() > 1 ? each.name + " of " + each.of : each.name);
    return true;
  });
  if (names.empty()) return;
  LifeAtPoint life = asked.lives.front().life->at_point();
  life.move_to(result.position.data());
  result.notes.push_back(
      fmt::format("Never reached at the maximum, where {:.4g} % fail at all: {}.",
                  100 * life.failing(), fmt::join(names, ", ")));
}

void add_estimates(const AskedOfClassics& asked, const Fit& fit, ClassicalEstimates& result) {
  const FormulaModel& model = *asked.model;
  std::vector<NormalScale> scales;
  for (const Parameter& each : model.parameters) scales.push_back(normal_scale(model, each));
  const MaximumLikelihood maximum =
      maximum_of(asked.likelihood, scales, model.parameters, fit.pooled);
  if (!maximum.found()) {
    result.problem = reason_of_none(model, scales, maximum);
    return;
  }
  add_notes_of_maximum(asked, maximum, result);
  result.position = maximum.position();
  result.log_likelihood = maximum.log_likelihood();
  std::vector<ScaledQuantity> all;
  for (std::size_t i = 0; i < scales.size(); ++i)
    all.push_back(scaled_parameter(model.parameters[i], i, scales[i]));
  for (ScaledQuantity& each : scaled_quantities(asked)) all.push_back(std::move(each));
  const WeightedDraws& draws = fit.exact ? fit.exact->nodes : fit.pooled;
  const double level = asked.level.within();
  std::vector<ClassicalEstimate> found(all.size());
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    found[i] = reported(all[i], i < scales.size()
                                    ? maximum.of_parameter(static_cast<Eigen::Index>(i), level)
                                    : bounds_of(maximum, all[i], level));
    const QuantityDistribution posterior = all[i].posterior(draws);
    found[i].posterior_lower = from_si(all[i].unit, posterior.quantile(asked.level.outside()));
    found[i].posterior_upper = from_si(all[i].unit, posterior.quantile(1 - asked.level.outside()));
  });
  const auto middle = found.begin() + static_cast<std::ptrdiff_t>(scales.size());
  result.parameters.assign(found.begin(), middle);
  result.quantities.assign(middle, found.end());
  if (model.measured.front().life.plain()) return;
  note_open_shares(result);
  drop_never_reached(asked, result);
}

// Keeps evenly chosen steps, the first and the last among them.
void thin(std::vector<SurvivalStep>& steps) {
  if (steps.size() <= most_steps_listed) return;
  std::vector<SurvivalStep> kept;
  const double apart = static_cast<double>(steps.size() - 1) / (most_steps_listed - 1);
  for (std::size_t i = 0; i < most_steps_listed; ++i)
    kept.push_back(steps[static_cast<std::size_t>(std::lround(apart * static_cast<double>(i)))]);
  steps = std::move(kept);
}

ClassicalGroup classical_group(const AskedOfClassics& asked, const LifeGroup& group) {
  ClassicalGroup found{
      group.conditions.words, survival_estimate(group.responses, group.counts), 0, {}, group.life};
  thin(found.survival.steps);
  bool plain = true;
  double items = 0;
  for (std::size_t i = 0; i < group.responses.size(); ++i) {
    const Response& y = group.responses[i];
    found.longest = std::max(found.longest, y.seen == Censoring::interval ? y.until : y.at);
    plain = plain && (y.seen == Censoring::none || y.seen == Censoring::right) &&
            !(y.entry > -infinity);
    items += group.counts[i];
  }
  const std::vector<Measured>& measured = asked.model->measured;
  const ResponseForm& form = *measured.front().form;
  // The lines have the parameters of one family; a mode of another one has none.
  const bool one_mode = asked.model->modes && std::has_single_bit(group.modes);
  if (one_mode && measured[static_cast<std::size_t>(std::countr_zero(group.modes))].form != &form)
    return found;
  if (!plain || items > most_ranked || !form.paper.straight || !measured.front().life.plain())
    return found;
  for (const MedianRanks ranks : {MedianRanks::exact, MedianRanks::benard}) {
    const auto fit = rank_regression(ranked_failures(group.responses, group.counts, ranks),
                                     form.paper.distribution, form.positive);
    if (!fit) return found;
    const auto family_parameters = family_parameters_of(form.family, *fit);
    if (!family_parameters) return found;
    found.lines.push_back({ranks, *fit, *family_parameters, {}});
    for (const double percent : asked.percents)
      found.lines.back().b_lives.push_back(
          quantile(form.family, percent / 100, family_parameters->data()));
  }
  return found;
}

// Why conditions have no line or no steps.
void add_notes(const AskedOfClassics& asked, ClassicalEstimates& result) {
  if (asked.groups.empty()) return;
  const ResponseForm& form = *asked.model->measured.front().form;
  const RankRegression any{0, 1, 1};
  const bool has_line = form.paper.straight && family_parameters_of(form.family, any).has_value();
  bool no_line = false, any_line = false, no_steps = false, early_end = false, thinned = false;
  for (const ClassicalGroup& each : result.groups) {
    const std::vector<SurvivalStep>& steps = each.survival.steps;
    no_line |= each.lines.empty();
    any_line |= !each.lines.empty();
    no_steps |= each.survival.method == SurvivalMethod::none;
    thinned |= steps.size() == most_steps_listed;
    early_end |= !steps.empty() && each.survival.method == SurvivalMethod::kaplan_meier &&
                 std::any_of(steps.begin(), steps.end() - 1,
                             [](const SurvivalStep& step) { return step.survival <= 0; });
  }
  if (!asked.model->measured.front().life.plain())
    result.notes.push_back(
        "Rank regression is for one distribution: lives of subpopulations, and of parts that are "
        "dead on arrival or cannot fail, are no straight line on probability paper.");
  else if (!has_line)
    result.notes.push_back(
        "Rank regression needs a family of two parameters that is a straight line on its "
        "probability paper: weibull, lognormal, loglogistic, log10-normal, normal or an "
        "extreme-value family, without a threshold.");
  else if (no_line)
    result.notes.push_back(fmt::format(
        "Rank regression needs at least two failures that differ, of exact lives and run-outs "
        "without delayed entries, up to {} items; {}.",
        most_ranked,
        any_line ? "conditions that are not in its table lack this" : "these data lack this"));
  if (no_steps)
    result.notes.push_back(
        "Delayed entries and intervals together have no nonparametric estimate here.");
  if (thinned)
    result.notes.push_back(fmt::format(
        "Of more than {} steps of a nonparametric estimate {} are listed, evenly chosen.",
        most_steps_listed, most_steps_listed));
  if (early_end)
    result.notes.push_back(
        "A Kaplan-Meier estimate is 0 from a life on at which every item then under observation "
        "failed, although others, with later entries, lived longer.");
}

}  // namespace

ClassicalEstimates classical_estimates(const AskedOfClassics& asked, const Fit& fit) {
  ClassicalEstimates result;
  result.notes = asked.notes;
  double failures = 0;
  for (const Measured& each : asked.model->measured)
    failures += static_cast<double>(each.observed.failures);
  if (asked.model->modes) failures = static_cast<double>(asked.model->lives.failures);
  if (failures > 0) {
    add_estimates(asked, fit, result);
  } else {
    result.problem =
        "no failure was observed, so the likelihood has no maximum; with a given shape a lower "
        "bound exists (Weibayes)";
  }
  for (const LifeGroup& each : asked.groups) result.groups.push_back(classical_group(asked, each));
  add_notes(asked, result);
  return result;
}

}  // namespace wearwell::formula_model
