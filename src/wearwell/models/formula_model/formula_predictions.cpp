#include "wearwell/models/formula_model/formula_predictions.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/formula/no_columns.h"
#include "wearwell/models/formula_model/classical_request.h"
#include "wearwell/models/formula_model/formula_asked.h"
#include "wearwell/models/formula_model/formula_figures.h"
#include "wearwell/models/formula_model/formula_limit.h"
#include "wearwell/models/formula_model/formula_path_ahead.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/life_answers.h"
#include "wearwell/models/formula_model/life_groups.h"
#include "wearwell/models/formula_model/mode_answers.h"
#include "wearwell/models/formula_model/rate_change.h"
#include "wearwell/models/formula_model/subpopulation_answers.h"
#include "wearwell/models/formula_model/use_check.h"
#include "wearwell/models/formula_model/use_rate_answers.h"
#include "wearwell/study/life_levels.h"

namespace wearwell::formula_model {
namespace {

class Predictions {
 public:
  Predictions(const TomlReader& predict, std::shared_ptr<const FormulaModel> model,
              std::shared_ptr<const FormulaRows> rows, PosteriorStudy& study)
      : predict_(predict),
        asked_(predict, model, std::move(rows)),
        model_(std::move(model)),
        study_(study),
        common_(asked_.common),
        given_words_(asked_.given.words),
        noun_(asked_.noun) {}

  void read() {
    const bool asks_along = predict_.has("at") || predict_.has("limit");
    if (asks_along && !model_->along) {
      predict_.fail(predict_.has("limit") ? "limit" : "at",
                    "needs predict.along: the axis of wear and life");
    }
    if (predict_.has("units") && !predict_.has("at")) {
      predict_.fail("units",
                    "needs predict.at: the positions of future measurements of these units");
    }
    if (asks_along || model_->along)
      refuse_varied(asked_.given, predict_, "given", "a path along " + *model_->along);
    read_rate_change(predict_, *model_);
    if (predict_.has("limit")) {
      read_limit(asked_, study_);
      for (const char* key :
           {"survival_to", "hazard_at", "accelerated", "compared_with", "classical"}) {
        if (predict_.has(key)) {
          predict_.fail(key,
                        "is for a likelihood of a life; with predict.limit lives are those to the "
                        "failure threshold");
        }
      }
    } else if (!model_->along) {
      read_life();
    } else {
      for (const char* key :
           {"b_lives", "level", "credible_level", "survived", "lives_of", "classical", "sides"}) {
        if (predict_.has(key)) {
          predict_.fail(key, "needs predict.limit: the failure threshold that ends a life");
        }
      }
    }
    if (predict_.has("at")) read_path(asked_, study_);
    if (asks_along) add_path_figures(asked_, study_);
    read_quantities();
  }

 private:
  // ---- Likelihoods of a life.

  void read_life() {
    const Measured& measured = model_->measured.front();
    if (!model_->use_rate) {
      for (const char* key : {"calendar", "warranty"})
        if (predict_.has(key))
          predict_.fail(key, "is for lives in use of units with an age, which needs [use_rate]");
    }
    LifeLevels levels = read_life_levels(predict_);
    if (levels.percents.empty()) levels.percents = {1, 10};
    const std::vector<double>& percents = levels.percents;
    const std::string si = formula::si_text(measured.powers);
    std::vector<Quantity> survival = predict_.quantities("survival_to", si);
    const auto survived = predict_.quantity("survived", si);
    if (survived && std::none_of(survival.begin(), survival.end(), [&](const Quantity& each) {
          return each.si() == survived->si();
        })) {
      survival.push_back(*survived);
    }
    const std::vector<Quantity> hazard = predict_.quantities("hazard_at", si);
    if (measured.form->counted) {
      for (const char* key :
           {"b_lives", "level", "credible_level", "mean_life", "survival_to", "survived",
            "hazard_at", "accelerated", "compared_with", "classical", "sides"}) {
        if (predict_.has(key)) predict_.fail(key, "is for lives, not for counts");
      }
      refuse_varied(asked_.given, predict_, "given", "a count");
      return;
    }
    const bool mean = predict_.boolean("mean_life").value_or(false);
    if (mean && !measured.form->positive)
      predict_.fail("mean_life",
                    "is for a family of positive values; the mean of this one is its location");
    const std::string given = predict_.has("given") ? "given" : "";
    const auto life = life_distribution(predict_, given, model_, common_);
    std::shared_ptr<const LifeDistribution> fast, other;
    Conditions under_fast, under_other;
    if (const auto compared = predict_.table("compared_with")) {
      if (measured.life.limited || measured.life.dead)
        predict_.fail(
            "compared_with",
            "is not possible with share_defective or share_dead_on_arrival, where lives have "
            "no ratio; compare two results by wearwell life --against");
      under_other = read_conditions(*compared, *model_);
      other = life_distribution(predict_, "compared_with", model_,
                                common_conditions(*model_, under_other));
    }
    if (const auto accelerated = predict_.table("accelerated")) {
      under_fast = read_conditions(*accelerated, *model_);
      fast = life_distribution(predict_, "accelerated", model_,
                               common_conditions(*model_, under_fast));
    }
    QuantityGroup group;
    const std::string what = measured.form->positive ? "life" : measured.column;
    group.requests.push_back(request(what, "new " + noun_, given_words_, measured.unit));
    group.requests.back().is_life = true;
    group.requests.back().safe_end = 0.05;
    group.requests.back().headline = model_->modes || model_->subpopulations;
    const auto bounded = [&](const std::string& name, const std::string& at, const Unit& unit) {
      group.requests.push_back(request(name, noun_, at, unit));
      ask_bounds(levels, group.requests.back());
      group.requests.back().safe_end = 0.05;
    };
    for (const double percent : percents) {
      bounded(b_life_name(percent), given_words_, measured.unit);
    }
    if (mean) bounded("mean life", given_words_, measured.unit);
    if (survived) {
      const std::string from =
          joined(given_words_, fmt::format("from {} on", description(*survived)));
      group.requests.push_back(
          request("remaining useful life", "new " + noun_, from, measured.unit));
      group.requests.back().is_life = true;
      group.requests.back().safe_end = 0.05;
      for (const double percent : percents) {
        bounded(b_life_name(percent, "remaining useful life"), from, measured.unit);
      }
      if (mean) bounded("mean remaining useful life", from, measured.unit);
    }
    for (const Quantity& each : survival) {
      bounded("survival to " + description(each), given_words_, Unit{"%", 0.01, 0});
    }
    if (other) {
      const std::string against = fmt::format("{} against {}", given_words_, under_other.words);
      const Unit percent{"%", 0.01, 0};
      bounded("probability to outlive", against, percent);
      for (const double each : percents)
        bounded(b_life_name(each) + " ratio", against, Unit{"1", 1, 0});
      for (const Quantity& each : survival)
        bounded("difference of survival to " + description(each), against, percent);
    }
    const Unit rate{per_unit(measured.unit), 1 / measured.unit.scale, 0};
    for (const Quantity& each : hazard) {
      group.requests.push_back(
          request("hazard at " + description(each), noun_, given_words_, rate));
    }
    if (fast) {
      group.requests.push_back(request("acceleration factor", noun_,
                                       fmt::format("{} over {}", given_words_, under_fast.words),
                                       Unit{"1", 1, 0}));
    }
    add_use_check(model_,
                  {{"given", asked_.given, life},
                   {"compared_with", under_other, other},
                   {"accelerated", under_fast, fast}},
                  study_);
    const AskedOfLife asked{
        life, fast, other, levels, mean, survived, survival, hazard, ObservedLives(asked_.rows)};
    group.from_draws = [asked](const WeightedDraws& draws) { return life_answers(asked, draws); };
    group.lives = [asked](const WeightedDraws& draws) { return predictive_lives(asked, draws); };
    study_.quantity_groups.push_back(std::move(group));
    if (model_->modes && model_->measured.size() > 1)
      add_mode_answers({predict_, model_, common_, given_words_, noun_, asked}, study_);
    const bool classical = predict_.boolean("classical").value_or(false);
    if (classical) {
      refuse_varied(common_, predict_, "classical", "predict.classical");
      add_classical_estimates({predict_, model_, common_, given_words_, noun_, asked}, study_);
    }
    if (model_->use_rate)
      add_use_rate_answers({predict_, model_, common_, given_words_, noun_, asked}, study_);
    if (!measured.life.plain())
      add_mixture_answers({predict_, model_, common_, given_words_, noun_, asked}, study_);
  }

  // ---- Functions of the parameters.

  // Where the study states none: that of a measured column of the same dimension, or of a number in SI.
  Unit unit_of_quantity(const formula::Powers& powers) const {
    if (powers.empty()) return {"1", 1, 0};
    for (const Measured& each : model_->measured)
      if (each.form && each.form->positive && each.powers == powers && each.unit.offset == 0)
        return each.unit;
    return {formula::description(powers), 1, 0};
  }

  void read_quantities() {
    const auto table = predict_.table("quantities");
    if (!table) return;
    for (const std::string& name : table->keys()) {
      std::string text;
      std::optional<std::string> unit;
      const bool plain = table->is_text(name);
      if (plain) {
        text = table->required_text(name);
      } else {
        const TomlReader own = table->required_table(name);
        text = own.required_text("value");
        unit = own.required_text("unit");
      }
      const formula::Wanted wanted{"[predict.quantities] " + name, text, {}, {}, true};
      const auto program = std::make_shared<const formula::Program>(
          compile_at(*table, name, model_->written, wanted, model_->symbols));
      const formula::Powers& powers = program->outputs()[0].powers;
      Unit shown = unit_of_quantity(powers);
      if (unit) {
        try {
          const formula::AnyUnit own = formula::read_any_unit(*unit);
          if (own.powers != powers) {
            throw InputError(fmt::format("'{}' is {}, but {} is {}", *unit,
                                         formula::description(own.powers), name,
                                         formula::description(powers)));
          }
          shown = own.unit;
        } catch (const InputError& error) {
          table->required_table(name).fail("unit", error.what());
        }
      }
      study_.quantities.push_back({name,
                                   "population",
                                   "",
                                   shown,
                                   true,
                                   false,
                                   [](double y) { return y; },
                                   function_of(program),
                                   {}});
      study_.quantities.back().with_mean = true;
    }
  }

  Function function_of(std::shared_ptr<const formula::Program> program) const {
    struct Own {
      formula::Data data;
      formula::Workspace workspace;
    };
    auto own = std::make_shared<tbb::enumerable_thread_specific<std::unique_ptr<Own>>>();
    const std::size_t size = model_->parameters.size();
    return [=, model = model_](const double* x) {
      std::unique_ptr<Own>& mine = own->local();
      if (!mine) {
        mine.reset(
            new Own{formula::bind_no_columns(*program, model->symbols), program->workspace(1)});
      }
      program->forward(mine->data, 0, 1, {{x, size}, {}}, mine->workspace);
      return mine->workspace.values(0)[0];
    };
  }

  const TomlReader& predict_;
  const Asked asked_;
  std::shared_ptr<const FormulaModel> model_;
  PosteriorStudy& study_;
  const Conditions& common_;
  const std::string &given_words_, &noun_;
};

}  // namespace

void read_own_predictions(const TomlReader& root, std::shared_ptr<const FormulaModel> model,
                          std::shared_ptr<const FormulaRows> rows, PosteriorStudy& study) {
  if (const auto predict = root.table("predict")) {
    Predictions(*predict, std::move(model), std::move(rows), study).read();
  }
}

}  // namespace wearwell::formula_model
