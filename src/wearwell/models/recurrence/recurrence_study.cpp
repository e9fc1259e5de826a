#include "wearwell/models/recurrence/recurrence_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/input/fingerprint.h"
#include "wearwell/input/prior.h"
#include "wearwell/models/recurrence/recurrence_predictions.h"
#include "wearwell/present/plain.h"

namespace wearwell::recurrence {
namespace {

void read_phases(const std::optional<TomlReader>& conditions, const RecurrenceData& data,
                 Process& process) {
  const bool stated = conditions && conditions->has("phase_ends");
  if (process.kind != ProcessKind::phases) {
    if (stated) conditions->fail("phase_ends", "belongs to process = \"phases\"");
    return;
  }
  constexpr std::size_t most_phases = 20;
  if (!stated) return;
  for (const Quantity& end : conditions->quantities("phase_ends", data.si)) {
    const double last = process.phase_ends.empty() ? 0 : process.phase_ends.back();
    if (!(end.si() > last)) conditions->fail("phase_ends", "must be positive and ascending");
    if (!(end.si() < data.longest()))
      conditions->fail(
          "phase_ends",
          fmt::format("has a phase that begins at {}, but no unit was observed beyond {}",
                      given_quantity(end), age_text(data, data.longest())));
    process.phase_ends.push_back(end.si());
  }
  if (process.phase_ends.size() >= most_phases)
    conditions->fail("phase_ends", fmt::format("allows at most {} phases", most_phases));
  for (std::size_t k = 0; k < process.parameters(); ++k) {
    const bool observed =
        std::any_of(data.units.begin(), data.units.end(), [&](const UnitHistory& unit) {
          return process.time_in_phase(k, unit.end) > process.time_in_phase(k, unit.start);
        });
    if (!observed)
      conditions->fail("phase_ends",
                       fmt::format("has a phase {} in which no unit was observed", k + 1));
  }
}

// Grouped failures of an interval are of one phase.
void require_whole_intervals(const std::optional<TomlReader>& conditions,
                             const RecurrenceData& data, const Process& process) {
  for (const double end : process.phase_ends) {
    for (const Gap& gap : data.gaps) {
      if (*gap.count == 0 || !(gap.from < end && end < gap.to)) continue;
      conditions->fail(
          "phase_ends",
          fmt::format("{} lies within the interval from {} to {} of unit '{}', whose failures are "
                      "counted together (data.grouped); a phase ends where an interval ends",
                      age_text(data, end), age_text(data, gap.from), age_text(data, gap.to),
                      data.units[gap.unit].name));
    }
  }
}

Process read_process(const TomlReader& root, const RecurrenceData& data) {
  Process process;
  const auto kind = root.choice("process", {"power_law", "renewal", "phases"});
  if (!kind)
    root.fail("process",
              "is missing: \"power_law\" (minimal repair, as bad as old), \"renewal\" (as good as "
              "new) or "
              "\"phases\" (of a growth test)");
  const bool grouped = data.units.front().grouped;
  if (grouped && *kind == "renewal")
    root.fail("process",
              "\"renewal\" needs the age of each failure, not a number by interval (data.grouped)");
  process.kind = *kind == "renewal"  ? ProcessKind::renewal
                 : *kind == "phases" ? ProcessKind::phases
                                     : ProcessKind::power_law;
  process.reference = data.longest();
  process.rounding = data.rounding;
  const auto conditions = root.table("conditions");
  if (const auto age = conditions ? conditions->quantity("reference_age", data.si) : std::nullopt) {
    if (process.kind != ProcessKind::power_law)
      conditions->fail(
          "reference_age",
          "belongs to process = \"power_law\": a renewal process has none, nor have phases");
    if (!(age->si() > 0)) conditions->fail("reference_age", "must be positive");
    process.reference = age->si();
  }
  read_phases(conditions, data, process);
  if (grouped) require_whole_intervals(conditions, data, process);
  if (process.minimal_repair()) return process;
  for (const UnitHistory& unit : data.units) {
    if (unit.start > 0)
      root.fail(
          "process",
          fmt::format(
              "\"renewal\" needs the time since the last repair, but unit '{}' was not observed "
              "before its start of observation; leave out data.columns.start if it was as good "
              "as new then and ages count from there",
              unit.name));
  }
  return process;
}

// Defaults: beta of machines lies between 0.3 and 3 (Rigdon and Basu 2000); the number of failures and the time between them
// are only known to some powers of ten.
void read_parameters(const TomlReader& root, const Asked& asked, PosteriorStudy& study) {
  const auto priors = root.table("prior");
  const RecurrenceData& data = asked.data;
  const auto failures = static_cast<double>(std::max<std::size_t>(1, data.failures()));
  double exposure = 0;
  for (const UnitHistory& unit : data.units) exposure += unit.end - unit.start;
  const auto read = [&](ParameterSpec spec, DefaultPrior fallback) {
    spec.fallback = std::move(fallback);
    study.parameters.push_back(read_prior(root, priors, spec));
  };
  const double size = rounded_up(from_si(data.unit, data.longest()));
  const auto of_size = [&](double share) {
    return DefaultPrior{"lognormal", Lognormal{to_si(data.unit, share * size), 3}, data.unit.text};
  };
  if (asked.process.kind == ProcessKind::phases) {
    const std::size_t phases = asked.process.parameters();
    for (std::size_t k = 0; k < phases; ++k) {
      read({fmt::format("MTBF_{}", k + 1), data.si, 0, INFINITY, exposure / failures},
           of_size(0.1));
      study.meanings.push_back(fmt::format(
          "mean time between failures in phase {}{}", k + 1,
          k + 1 < phases ? ", until " + age_text(data, asked.process.phase_ends[k]) : ""));
    }
    study.equation = fmt::format(
        "failures are a Poisson process (minimal repair) with a constant intensity, one over its "
        "MTBF, in each of {} phase{}",
        phases, phases == 1 ? "" : "s");
    return;
  }
  read({"beta", "1", 0, INFINITY, 1}, {"lognormal", Lognormal{1, 0.7}, "1"});
  if (asked.process.minimal_repair()) {
    read({"M_T", "1", 0, INFINITY, failures * asked.process.reference / exposure},
         {"lognormal", Lognormal{1, 3}, "1"});
    const std::string age = age_text(data, asked.process.reference);
    study.meanings = {"shape of the power law",
                      fmt::format("expected failures of one unit until {}", age)};
    study.equation = fmt::format(
        "M(t) = M_T (t/T)^beta failures until age t, T = {}; minimal repair: failures are a "
        "Poisson process",
        age);
  } else {
    read({"eta", data.si, 0, INFINITY, exposure / failures}, of_size(1));
    study.meanings = {"shape of the distribution between failures",
                      "characteristic life between failures"};
    study.equation =
        "times between failures are independent, Weibull with shape beta and scale eta; a repair "
        "makes a unit as good as new";
  }
}

// The growth from the first phase to the last, for the verdict.
std::string growth_clause(const Process& process, const WeightedDraws& draws) {
  const std::size_t last = process.parameters() - 1;
  if (last == 0) return "";
  const QuantityDistribution ratio(draws, [last](const double* x) { return x[last] / x[0]; });
  const double longer = 1 - ratio.cdf(1);
  return fmt::format(
      "with a probability of {} the mean time between failures is {} in the last phase than in the "
      "first; the ratio is {} "
      "(median)",
      probability_text(longer >= 0.5 ? longer : 1 - longer), longer >= 0.5 ? "longer" : "shorter",
      plain_number(ratio.quantile(0.5), 3));
}

// The trend, for the verdict.
std::string trend_clause(const Process& process, const WeightedDraws& draws) {
  if (process.kind == ProcessKind::phases) return growth_clause(process, draws);
  const QuantityDistribution beta(draws, [](const double* x) { return x[0]; });
  const double rising = 1 - beta.cdf(1);
  const std::string probability = probability_text(rising >= 0.5 ? rising : 1 - rising);
  if (!process.minimal_repair())
    return fmt::format(
        "with a probability of {} a unit is the {} likely to fail the longer it has run since its "
        "last "
        "repair (beta {} 1)",
        probability, rising >= 0.5 ? "more" : "less", rising >= 0.5 ? ">" : "<");
  return fmt::format("with a probability of {} failures become {} frequent with age (beta {} 1)",
                     probability, rising >= 0.5 ? "more" : "less", rising >= 0.5 ? ">" : "<");
}

// The scores of a unit's gaps are martingale differences: tests along a driver hold where it is known when the gap begins,
// so it is the age then, not the age of the event. Means of units would not hold, as a unit's number of gaps depends on them.
FitData fit_data_of(const Asked& asked) {
  FitData fit;
  fit.scores = process_scores(asked.process, asked.data);
  Driver age{asked.process.minimal_repair() ? "age" : "age at the last repair", {}};
  for (const Gap& gap : asked.data.gaps) {
    age.value.push_back(gap.from);
    fit.unit.push_back(gap.unit);
    fit.names.push_back(fmt::format("the event at {} of unit '{}'", age_text(asked.data, gap.to),
                                    asked.data.units[gap.unit].name));
  }
  fit.drivers = {age};
  fit.noun = "event";
  return fit;
}

}  // namespace

void read_recurrence_study(const TomlReader& root, const Source& source, PosteriorStudy& study) {
  Asked asked;
  asked.data = read_recurrence_data(root, source);
  const RecurrenceData& data = asked.data;
  asked.process = read_process(root, data);
  asked.growth_test = read_growth_test(root, data, asked.process);
  if (study.stages)
    root.required_table("update").fail("stages", "is not possible for model \"repairable\"");
  read_parameters(root, asked, study);
  read_predictions(root, asked, study);
  study.data_rows = data.gaps.size();
  study.quantity = data.units.front().grouped ? "intervals" : "events";
  for (const Gap& gap : data.gaps) {
    study.observed.insert(study.observed.end(), {static_cast<double>(gap.unit), gap.from, gap.to,
                                                 gap.count    ? static_cast<double>(*gap.count)
                                                 : gap.failed ? 1.0
                                                              : 0.0});
    const double term = gap.failed ? std::log(data.unit.scale) : 0;
    study.density.terms.push_back(term);
    study.density.total += term;
  }
  study.density.text = data.unit.text;
  asked.density = study.density;
  asked.parameters = study.parameters;
  study.data_columns = data.columns;
  study.data_layout = data.layout;
  const std::size_t failures = data.failures();
  const auto without = std::count_if(data.units.begin(), data.units.end(),
                                     [](const UnitHistory& unit) { return unit.failures.empty(); });
  study.data_notes = {fmt::format("{} unit{}, {} failure{}; {} without a failure",
                                  data.units.size(), data.units.size() == 1 ? "" : "s", failures,
                                  failures == 1 ? "" : "s", without)};
  if (data.units.front().grouped)
    study.data_notes.push_back(
        "failures are counted by interval: each row has those since the row before of its unit");
  if (failures == 0)
    study.nothing_seen = {
        "no-failures",
        "no failure was observed: the data only exclude frequent failures, and the longest times "
        "between failures rest on the prior",
        "Observe the units longer, or state what you know of similar units in [prior]."};
  study.likelihood = [asked](std::size_t) { return process_likelihood(asked.process, asked.data); };
  study.fit_data = fit_data_of(asked);
  study.curve = [process = asked.process](const WeightedDraws& draws) {
    return trend_clause(process, draws);
  };
  study.figures = [asked](const Fit& fit) {
    return recurrence_figures(asked, fit.exact ? fit.exact->nodes : fit.pooled);
  };
  study.addition = [asked](const Fit& fit) { return recurrence_addition(asked, fit); };
}

}  // namespace wearwell::recurrence
