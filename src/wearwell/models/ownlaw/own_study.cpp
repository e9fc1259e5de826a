#include "wearwell/models/ownlaw/own_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/base/error.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/ownlaw/identified.h"
#include "wearwell/models/ownlaw/life_paper.h"
#include "wearwell/models/ownlaw/own_density_unit.h"
#include "wearwell/models/ownlaw/own_drawn.h"
#include "wearwell/models/ownlaw/own_fit_data.h"
#include "wearwell/models/ownlaw/own_likelihood.h"
#include "wearwell/models/ownlaw/own_predictions.h"
#include "wearwell/models/ownlaw/own_reader.h"
#include "wearwell/models/ownlaw/own_start.h"

namespace wearwell {
namespace {

using ownlaw::Effect;
using ownlaw::Measured;
using ownlaw::Observed;
using ownlaw::OwnLaw;
using ownlaw::OwnRows;

std::string in_words(const OwnLaw& law) {
  std::vector<std::string> parts;
  for (const Measured& each : law.measured) {
    std::vector<std::string> slots;
    for (std::size_t o = 0; o < each.wanted.size(); ++o) {
      slots.push_back(
          fmt::format("{} = {}", each.form->slots[each.slot[o]].name, each.program.text(o)));
    }
    parts.push_back(
        fmt::format("{} is {} with {}", each.column, each.form->name, fmt::join(slots, ", ")));
  }
  for (std::size_t e = 0; e < law.effects.size(); ++e) {
    const Effect& effect = law.effects[e];
    parts.push_back(fmt::format("{} of each of {} {}s is {} about {} with {} {}", effect.name,
                                law.units.size(), *law.label,
                                effect.lognormal ? "lognormal" : "normal", effect.name,
                                effect.lognormal ? "log_sd" : "sd", law.population.text(e)));
  }
  if (law.correlated) {
    parts.push_back(
        fmt::format("their correlation is {}", law.population.text(law.effects.size())));
  }
  for (const ownlaw::DrawnEffect& each : law.drawn) {
    parts.push_back(fmt::format(
        "{} of each of {} {}s is {} about {}_middle with {} {}{}", each.name, each.seen, each.label,
        each.lognormal ? "lognormal" : "normal", each.name, each.lognormal ? "log_sd" : "sd",
        each.scatter, each.correlation ? ", correlation " + *each.correlation : ""));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

std::vector<std::string> meanings(const OwnLaw& law) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < law.parameters.size(); ++i) {
    const auto effect = std::find_if(law.effects.begin(), law.effects.end(),
                                     [&](const Effect& each) { return each.parameter == i; });
    all.push_back(effect == law.effects.end()
                      ? meaning_not_stated
                      : fmt::format("{} {}'s", effect->lognormal ? "median" : "mean", *law.label));
  }
  for (const ownlaw::DrawnEffect& each : law.drawn) {
    if (all[each.middle] == meaning_not_stated) {
      all[each.middle] = fmt::format("{} {}'s", each.lognormal ? "median" : "mean", each.label);
    }
    for (std::size_t i = 0; i <= each.seen; ++i) {
      all[each.first + i] = fmt::format("{} of this {}, from the middle", each.name, each.label);
    }
  }
  return all;
}

std::vector<std::string> notes(const OwnLaw& law) {
  static constexpr const char* words[] = {"exact", "censored to the right", "censored to the left",
                                          "known to an interval"};
  std::vector<std::string> all;
  for (const Measured& each : law.measured) {
    long long counts[4] = {}, sum = 0, truncated = 0;
    for (std::size_t i = 0; i < each.observed.responses.size(); ++i) {
      const Response& y = each.observed.responses[i];
      counts[static_cast<int>(y.seen)] += each.observed.counts[i];
      sum += each.observed.counts[i];
      truncated += y.entry > -infinity ? each.observed.counts[i] : 0;
    }
    std::vector<std::string> parts;
    for (int i = 0; i < 4; ++i) {
      if (counts[i] > 0) parts.push_back(fmt::format("{} {}", counts[i], words[i]));
    }
    std::string note =
        fmt::format("{}: {} observation{}{}", each.column, sum, sum == 1 ? "" : "s",
                    counts[0] == sum ? "" : fmt::format(": {}", fmt::join(parts, ", ")));
    if (truncated > 0) note += fmt::format("; {} seen only from an entry on", truncated);
    all.push_back(note);
    if (!each.form->counted && each.observed.failures == 0) {
      all.push_back(
          fmt::format("no row of {} is a failure: how long a life may be is said by the "
                      "priors alone",
                      each.column));
    }
  }
  if (law.varies()) all.push_back(fmt::format("{} {}s", law.units.size(), *law.label));
  for (const ownlaw::DrawnEffect& each : law.drawn) {
    all.push_back(
        fmt::format("{} of each of {} {}s is drawn, not integrated out: by NUTS, without "
                    "quadrature beside it. The mode is then one of all that is drawn together: "
                    "its scatters are no estimates",
                    each.name, each.seen, each.label));
  }
  return all;
}

bool saw_no_wear(const Observed& observed) {
  return std::all_of(observed.responses.begin(), observed.responses.end(), [](const Response& y) {
    return y.seen == Seen::below || (y.seen == Seen::exactly && y.at <= 0);
  });
}

// Of lives no failure, of wear along an axis no reading above zero.
NothingSeen nothing_seen(const OwnLaw& law) {
  const auto all = [&](auto property) {
    return std::all_of(law.measured.begin(), law.measured.end(), property);
  };
  const auto counted = [](const Measured& each) { return each.form->counted; };
  if (std::any_of(law.measured.begin(), law.measured.end(), counted)) return {};
  const Measured& first = law.measured.front();
  const int count = std::accumulate(first.observed.counts.begin(), first.observed.counts.end(), 0);
  const std::string give_prior =
      "State what is known of the parameters before the data; until something is observed, read "
      "every upper end as a statement of the prior.";
  if (!law.along && all([](const Measured& each) { return each.observed.failures == 0; })) {
    return {"no-failures",
            fmt::format("no failure was observed among {} observation{} of {}: the data only "
                        "exclude short lives, and the upper end of every life rests on the prior",
                        count, count == 1 ? "" : "s", first.column),
            give_prior};
  }
  if (law.along && all([](const Measured& each) { return saw_no_wear(each.observed); })) {
    return {"no-wear",
            fmt::format("no wear was observed: none of {} reading{} of {} lies above zero, so the "
                        "data only exclude fast wear, and the upper end of every life rests on "
                        "the prior",
                        count, count == 1 ? "" : "s", first.column),
            give_prior};
  }
  return {};
}

// What the likelihood is a density of, and what it stands on.
void tell_data(const OwnLaw& law, PosteriorStudy& study) {
  std::vector<std::string> names;
  for (const Measured& each : law.measured) {
    names.push_back(each.column);
    for (std::size_t i = 0; i < each.observed.responses.size(); ++i) {
      const Response& y = each.observed.responses[i];
      study.observed.push_back(y.at);
      if (y.seen != Seen::exactly || each.observed.counts[i] != 1 || y.entry > -infinity) {
        study.observed.insert(study.observed.end(), {static_cast<double>(y.seen), y.until,
                                                     static_cast<double>(each.observed.counts[i]),
                                                     y.entry > -infinity ? y.entry : 0});
      }
    }
  }
  study.quantity = fmt::format("{}", fmt::join(names, ", "));
  for (const ownlaw::NumberColumn& column : law.data.numbers) {
    const bool whole = std::all_of(column.values.begin(), column.values.end(),
                                   [](double x) { return std::isfinite(x); });
    const bool integers =
        std::all_of(column.unit.powers.begin(), column.unit.powers.end(),
                    [](const auto& power) { return power.second.denominator() == 1; });
    if (!whole || !integers) continue;
    // Of lengths a law does not say which are sizes and which are ways, that of a car's life, say. What is
    // measured along something else is a size.
    const bool size =
        law.along && std::any_of(law.measured.begin(), law.measured.end(),
                                 [&](const Measured& each) { return each.column == column.name; });
    study.data_columns.push_back({.name = column.name,
                                  .si = law::si_text(column.unit.powers),
                                  .unit = column.unit.unit,
                                  .values = column.values,
                                  .endless = !size});
  }
}

// The first expression that is no number where the search starts, with its row: a clearer word than that
// the posterior is not finite there.
void require_numbers(const OwnLaw& law) {
  if (law.varies()) return;
  std::vector<double> x;
  for (const std::size_t i : law.shared) x.push_back(law.parameters[i].start);
  for (const ownlaw::BoundColumn& bound : ownlaw::bind_columns(law, law.data.table.rows)) {
    const auto fault =
        bound.measured->program.first_fault(bound.data, 0, bound.data.rows(), {x, {}});
    if (!fault) continue;
    const std::size_t row = bound.measured->observed.rows[bound.term[fault->row]];
    throw InputError(
        fmt::format("{}{}: {} in '{}' ({}), at values of the parameters where the search starts",
                    law.data.table.source, fault->uniform ? "" : fmt::format(", row {}", row + 1),
                    fault->why, fault->expression, fault->where));
  }
}

}  // namespace

void read_law_study(const TomlReader& root, const Source& source, PosteriorStudy& study) {
  const std::shared_ptr<OwnLaw> law = ownlaw::read_own_law(root, source);
  if (study.stages) {
    root.required_table("update").fail(
        "stages",
        "is not for model \"law\"; fit the first rows as a study of their own (data.sql "
        "= \"select ... limit 6\")");
  }
  study.data_rows = law->data.table.rows;
  study.data_layout = law->data.table.layout;
  const auto rows = std::make_shared<const OwnRows>(law, study.data_rows, true);
  const auto likelihood = ownlaw::own_likelihood(rows);
  ownlaw::find_starts(*likelihood, law->parameters);
  std::vector<double> start;
  for (const Parameter& each : law->parameters) start.push_back(each.start);
  if (!(likelihood->value(start) > -infinity)) require_numbers(*law);

  study.parameters = law->parameters;
  study.equation = in_words(*law);
  study.meanings = meanings(*law);
  study.data_notes = notes(*law);
  study.density = ownlaw::density_unit(*law);
  study.nothing_seen = nothing_seen(*law);
  tell_data(*law, study);
  if (law->varies()) {
    study.observation = *law->label;
  } else if (law->has_process()) {
    study.observation = law->symbols.labels.size() == 1 ? law->symbols.labels.front().name : "unit";
  }
  study.likelihood = [law, rows, likelihood](std::size_t count) {
    if (count == law->data.table.rows) return likelihood;
    return ownlaw::own_likelihood(std::make_shared<const OwnRows>(law, count, true));
  };
  study.fit_data = ownlaw::fit_data(rows);
  study.checks = [rows](const Fit& fit) {
    return std::vector<Check>{ownlaw::identified(*rows, rows->law().parameters, fit)};
  };
  ownlaw::tell_drawn_effects(law, study);
  ownlaw::read_own_predictions(root, law, rows, study);
  ownlaw::show_life_paper(root, law, study);
}

}  // namespace wearwell
