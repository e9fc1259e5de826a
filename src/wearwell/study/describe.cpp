#include "wearwell/study/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/printable.h"
#include "wearwell/present/number.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/answers.h"
#include "wearwell/study/data_in_words.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

// A family with its parameters in the unit of the parameter: "lognormal, median 3, sd of the
// logarithm 0.5".
std::string family_text(const Parameter& parameter) {
  const Family& family = parameter.prior.family;
  const ResponseForm& form = form_of(family.id);
  std::string words(form.title);
  for (std::size_t i = 0; i < form.family_parameters.size(); ++i) {
    const ParameterForm& family_parameter = form.family_parameters[i];
    const double si = family.parameter[i];
    const std::string number = family_parameter.kind == ParameterKind::location
                                   ? fmt::format("{:.6g}", from_si(parameter.unit, si))
                               : family_parameter.kind == ParameterKind::scale
                                   ? fmt::format("{:.6g}", si / parameter.unit.scale)
                                   : fmt::format("{:.4g}", si);
    words += ", ";
    words += family_parameter.phrase.empty()
                 ? fmt::format("{} {}", family_parameter.name, number)
                 : fmt::format(fmt::runtime(family_parameter.phrase), number);
  }
  return words;
}

std::string rows_text(const PosteriorStudy& study) {
  return plain_given(static_cast<double>(study.data_rows));
}

}  // namespace

std::string prior_text(const Parameter& parameter) {
  const Distribution& distribution = parameter.prior;
  std::string words = family_text(parameter);
  const auto value = [&](double si) { return fmt::format("{:.6g}", from_si(parameter.unit, si)); };
  if (std::isfinite(distribution.lower) && std::isfinite(distribution.upper)) {
    words +=
        fmt::format(", between {} and {}", value(distribution.lower), value(distribution.upper));
  } else if (std::isfinite(distribution.lower)) {
    words += ", above " + value(distribution.lower);
  } else if (std::isfinite(distribution.upper)) {
    words += ", below " + value(distribution.upper);
  }
  return parameter.unit.text == "1" ? words : words + " " + parameter.unit.text;
}

std::string study_description(const PosteriorStudy& study) {
  std::string out = fmt::format("{}\n  {}\n\nData\n  {}: {} rows of {}\n", printable(study.title),
                                powers_text(study.equation, Script::terminal), study.data_file,
                                rows_text(study), study.quantity);
  if (!study.data_layout.text.empty()) out += fmt::format("  {}\n", study.data_layout.text);
  out += columns_text(study.data_columns);
  for (const std::string& note : study.data_notes)
    out += fmt::format("  {}\n", powers_text(note, Script::terminal));
  out += "\nUnknowns\n";
  std::size_t width = 0;
  for (const Parameter& p : study.parameters) width = std::max(width, p.name.size());
  for (std::size_t i = 0; i < study.parameters.size(); ++i) {
    const Parameter& p = study.parameters[i];
    out += fmt::format("  {:<{}}  {}{}\n  {:<{}}  prior: {}\n", p.name, width, study.meanings[i],
                       p.unit.text == "1" ? "" : fmt::format(" [{}]", p.unit.text), "", width,
                       powers_text(prior_text(p), Script::terminal) +
                           (p.is_default ? " (default; state your own if you know more)" : ""));
  }
  out += "\nWill be fitted\n";
  out += study.stages && study.data_rows <= most_stages
             ? fmt::format("  after each of 1, 2, ... {} rows\n", rows_text(study))
             : fmt::format("  from all {} rows\n", rows_text(study));
  FitSettings settings = fit_settings(study, {});
  const std::string note = method_note(study, {});
  if (!note.empty()) settings.method = Method::nuts;
  const RunSettings& run = settings.run;
  if (settings.method == Method::exact) {
    out += "  by quadrature";
  } else {
    out += fmt::format("  by {}, {} chains of {} draws after {} of warm-up{}",
                       method_name(settings.method), run.chains, plain_given(run.draws),
                       plain_given(run.warmup),
                       study.parameters.size() <= max_exact_dimension ? ", and by quadrature" : "");
  }
  out += fmt::format("; seed {}\n", run.seed);
  if (!note.empty()) out += wrapped(note, 2, 4);
  if (!study.predictions.empty() || !study.quantities.empty() || !study.quantity_groups.empty() ||
      study.life) {
    out += "\nWill be predicted\n";
  }
  for (const PredictionRequest& p : study.predictions) {
    out += fmt::format("  {} [{}]{} at {} {}\n", study.quantity, p.unit.text,
                       p.with_item ? " of " + p.measured_of : "", plain_given(p.at),
                       p.at_unit.empty() ? p.at_name : p.at_unit);
  }
  std::vector<QuantityRequest> quantities = study.quantities;
  for (const QuantityGroup& group : study.quantity_groups) {
    quantities.insert(quantities.end(), group.requests.begin(), group.requests.end());
  }
  for (const QuantityRequest& q : quantities) {
    const std::string what = q.name + (q.unit.text == "1" ? "" : " [" + q.unit.text + "]");
    out += fmt::format(
        "  {} of {}{}{}\n", numbers_text(what, Script::terminal),
        item_text(q.of, q.credible_level.has_value()),
        q.at.empty() ? "" : " " + numbers_text(q.at, Script::terminal),
        q.credible_level && !q.name.ends_with("remaining useful life")
            ? fmt::format("; {} with {:.4g} % credibility, and the value of the next item",
                          q.sides == BoundSides::lower   ? "lower bound"
                          : q.sides == BoundSides::upper ? "upper bound"
                                                         : "interval",
                          100 * *q.credible_level)
            : "");
  }
  if (study.life) {
    const LifeRequest& life = *study.life;
    out += fmt::format(
        "  {} until the {} reaches {} {}, and when to inspect {} at a risk of {:.4g} %\n",
        life.unit_name, study.quantity, plain_given(life.limit.value), life.limit.unit.text,
        life.now > 0 ? fmt::format("after {} {}", plain_given(life.now), life.unit_name)
                     : "a new one",
        100 * life.risk);
  }
  return printable_lines(out);
}

}  // namespace wearwell
