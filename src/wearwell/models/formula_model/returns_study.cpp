#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/formula_conditions.h"
#include "wearwell/models/formula_model/returns_report.h"
#include "wearwell/present/plain.h"
#include "wearwell/prognosis/money.h"

namespace wearwell::formula_model {
namespace {

constexpr int most_ahead = 600;

// "12 month" as a number of periods.
int read_ahead(const TomlReader& predict, const Unit& period) {
  const auto next = predict.quantity("next", "s");
  if (!next) return 0;
  const double periods = next->si() / period.scale;
  constexpr double close = 1e-6;
  if (!(periods > 0.5) || std::abs(periods - std::round(periods)) > close || periods > most_ahead)
    predict.fail("next",
                 fmt::format("must be whole {0}s, 1 to {1}: \"12 {0}\"", period.text, most_ahead));
  return static_cast<int>(std::lround(periods));
}

void read_predict(const TomlReader& predict, const Source& source, AskedReturns& asked) {
  const FieldReturns& returns = *asked.returns;
  asked.ahead = std::max(asked.ahead, read_ahead(predict, returns.period));
  if (const auto cost = predict.text("cost_per_return")) {
    prognosis::Currency currency;
    try {
      asked.cost = prognosis::amount("cost_per_return", *cost, currency);
    } catch (const InputError& error) {
      std::string message = error.what();
      predict.fail("cost_per_return",
                   message.substr(std::min(message.size(), message.find(": ") + 2)));
    }
    asked.currency = currency.text;
  }
  const auto planned = predict.table("planned_sales");
  if (!planned) return;
  asked.planned = read_planned_sales(*planned, read_table(*planned, source), returns.triangle.names,
                                     returns.triangle.last);
  if (asked.ahead == 0)
    predict.fail("planned_sales", fmt::format("needs predict.next, the time of the forecast: next "
                                              "= \"12 {}\"",
                                              returns.period.text));
}

void require_single_life(const TomlReader& root, const FormulaModel& model) {
  if (model.modes) return;  // whose families are positive
  const Measured& measured = model.measured.front();
  const TomlReader likelihood = root.required_table("likelihood");
  if (model.measured.size() > 1)
    root.fail("likelihood", "needs one life for [data.returns], but has several columns");
  if (measured.process || measured.form->counted || !measured.form->positive)
    likelihood.required_table(measured.column)
        .fail("family", "must be a family of positive lives for [data.returns]");
}

}  // namespace

AskedReturns read_asked_returns(const TomlReader& root, const Source& source,
                                const std::shared_ptr<const FormulaModel>& model) {
  require_single_life(root, *model);
  AskedReturns asked;
  asked.returns = read_field_returns(root, source);
  asked.ahead = asked.returns->held_out;
  if (const auto predict = root.table("predict")) read_predict(*predict, source, asked);
  for (const Measured& measured : model->measured)
    asked.risks.push_back(risk_of(
        make_path(model, root, "likelihood", measured.wanted, false, Conditions()), measured));
  if (model->modes) asked.modes = model->modes->modes;
  return asked;
}

void add_returns(const TomlReader& root, const Source& source,
                 const std::shared_ptr<const FormulaModel>& model, PosteriorStudy& study) {
  if (!root.required_table("data").has("returns")) return;
  if (study.addition)
    root.required_table("predict").fail(
        "classical", "is for a table of lives, not for a triangle of returns in [data.returns]");
  const AskedReturns asked = read_asked_returns(root, source, model);
  const std::shared_ptr<const FieldReturns>& returns = asked.returns;
  study.observation = "cell";  // of the triangle: returns of one age, or survivors
  const std::vector<std::string> notes = notes_of_returns(*returns);
  study.data_notes.insert(study.data_notes.begin(), notes.begin(), notes.end());
  const int oldest = returns->last() - returns->triangle.sales.front().at;
  if (asked.ahead > 0)
    study.reaches.push_back(
        {fmt::format("the forecast over the next {} {}", asked.ahead, asked.period(asked.ahead)),
         fmt::format("the oldest unit was observed until age {} {}",
                     plain_given(returns->age_in_use(oldest)), returns->period.text),
         to_si(returns->period, returns->age_in_use(oldest + asked.ahead)),
         to_si(returns->period, returns->age_in_use(oldest))});
  const auto draws_of = [](const Fit& fit) -> const WeightedDraws& {
    return fit.exact ? fit.exact->nodes : fit.pooled;
  };
  if (asked.ahead > 0)
    study.curve = [asked](const WeightedDraws& draws) { return returns_clause(asked, draws); };
  study.figures = [asked, draws_of, before = study.figures](const Fit& fit) {
    auto figures = before ? before(fit) : std::map<std::string, std::vector<html::Figure>>();
    std::vector<html::Figure> own = returns_figures(asked, draws_of(fit));
    std::vector<html::Figure>& shown = figures["verdict"];
    shown.insert(shown.begin(), own.begin(), own.end());
    return figures;
  };
  study.addition = [asked, draws_of](const Fit& fit) {
    return returns_addition(asked, draws_of(fit));
  };
}

}  // namespace wearwell::formula_model
