#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/exposure_parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <regex>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/shell_word.h"
#include "wearwell/base/trimmed.h"
#include "wearwell/input/prior.h"
#include "wearwell/models/formula_model/fail_at_place.h"
#include "wearwell/models/formula_model/formula_drawn.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_order.h"
#include "wearwell/models/formula_model/linear_form.h"
#include "wearwell/models/formula_model/lines_by_level.h"
#include "wearwell/models/formula_model/ramp_stress.h"
#include "wearwell/models/formula_model/step_stress.h"
#include "wearwell/models/formula_model/use_rate_model.h"
#include "wearwell/models/formula_model/written_mixture.h"
#include "wearwell/prob/log_location_scale.h"
#include "wearwell/study/family_study.h"

// Longer than others: the sections of one study file, each of which needs the names of earlier
// ones.
namespace wearwell::formula_model {
namespace {

const std::vector<std::string> special_names = {"status", "lower", "upper", "entry", "count"};

struct Bounds {
  double lower = -INFINITY, upper = INFINITY;

  void take(double least, double most) {
    lower = std::max(lower, least);
    upper = std::min(upper, most);
  }
};

// Keys of a prior whose values have the dimension of its parameter, for every distribution.
const std::vector<std::string>& dimensional_keys() {
  static const auto all = [] {
    std::map<std::string, bool> family_parameters;
    for (const ResponseForm& form : prior_forms()) {
      for (const ParameterForm& family_parameter : form.family_parameters) {
        const bool dimensional = family_parameter.kind == ParameterKind::location ||
                                 family_parameter.kind == ParameterKind::scale;
        bool& always =
            family_parameters.try_emplace(std::string(family_parameter.name), true).first->second;
        always = always && dimensional;
      }
    }
    std::vector<std::string> keys = {"unit"};
    for (const auto& [name, always] : family_parameters)
      if (always) keys.push_back(name);
    keys.insert(keys.end(), {"lower", "upper"});
    return keys;
  }();
  return all;
}

// "mean and sd", for each parameterization of a name.
std::vector<std::string> needed_parameters(const std::string& family) {
  std::vector<std::string> ways;
  const auto add = [&](const ResponseForm& form) {
    if (form.name != family) return;
    std::vector<std::string_view> needed;
    for (const ParameterForm& family_parameter : form.family_parameters) {
      if (!family_parameter.optional) needed.push_back(family_parameter.name);
    }
    std::string way = fmt::format("{}", fmt::join(needed, " and "));
    if (ways.empty() || ways.back() != way) ways.push_back(std::move(way));
  };
  for (const ResponseForm& each : response_forms()) add(each);
  for (const ProcessForm& each : process_forms()) add(each.form);
  return ways;
}

class Reader {
 public:
  // For more than two effects of the units: the `integrated` ones are integrated out.
  Reader(const TomlReader& root, const Source& source, std::size_t integrated)
      : root_(root),
        source_(source),
        integrated_(integrated),
        model_(std::make_shared<FormulaModel>()) {}

  std::shared_ptr<FormulaModel> read() {
    read_texts();
    if (use_rate_) refuse_with_use_rate(root_, written_, *use_rate_);
    model_->data = read_own_data(root_, source_, label_names());
    read_use_rate();
    read_exposure();
    read_modes();
    read_mixture();
    choose_units();
    read_along();
    read_symbols();
    refuse_ranges_in_celsius();
    read_parameters();
    add_drawn_effects(root_, drawn_, *model_);
    read_effects();
    compile_population();
    add_ramp_exposure();
    require_step_exposure();
    compile_measured();
    order_rows(*model_, root_);
    require_rising(*model_);
    require_status(*model_, root_);
    require_failures(*model_);
    return model_;
  }

 private:
  // All expressions, since the use of a name determines its meaning.
  void read_texts() {
    if (const auto lines = root_.table("formula")) {
      for (const std::string& name : lines->keys()) {
        model_->written.push_back({name, expression(*lines, name)});
        texts_.push_back(model_->written.back().text);
      }
      model_->lines = model_->written;
    }
    model_->subpopulations = read_subpopulations(root_);
    subpopulations_ = model_->subpopulations.has_value();
    const TomlReader likelihoods = root_.required_table("likelihood");
    const auto failure_modes = root_.table("failure_modes");
    for (const std::string& column : likelihoods.keys()) {
      const TomlReader table = likelihoods.required_table(column);
      const std::vector<std::string> keys = table.keys();
      const bool no_family = std::find(keys.begin(), keys.end(), "family") == keys.end();
      if (failure_modes && keys.empty()) {  // each mode has its own
        written_.push_back(empty_likelihood(column));
      } else if (subpopulations_ && no_family) {
        written_.push_back(empty_likelihood(column));
        read_shares(table, written_.back());
      } else {
        written_.push_back(read_likelihood(table, column, "likelihood." + column));
      }
    }
    if (failure_modes && written_.size() > 1)
      root_.fail("failure_modes", "needs one measured column, the life; [likelihood] has several");
    for (const std::string& mode :
         failure_modes ? modes_with_tables(*failure_modes) : std::vector<std::string>()) {
      of_modes_.push_back(read_likelihood(failure_modes->required_table(mode),
                                          written_.front().column, "failure_modes." + mode));
      of_modes_.back().mode = mode;
    }
    if (const auto rate = root_.table(UseRate::name))
      use_rate_ = read_likelihood(*rate, UseRate::name, UseRate::name);
    read_texts_of_subpopulations();
    if (written_.empty()) {
      root_.fail("likelihood", "is empty; give one table for each measured column");
    }
    if (const auto random_effects = root_.table("random_effects")) {
      for (const std::string& label : random_effects->keys()) {
        read_random_effects(random_effects->required_table(label), label);
      }
    }
    if (const auto predict = root_.table("predict")) {
      if (const auto quantities = predict->table("quantities")) {
        for (const std::string& key : quantities->keys()) {
          texts_.push_back(quantities->is_text(key)
                               ? quantities->required_text(key)
                               : quantities->required_table(key).required_text("value"));
        }
      }
    }
  }

  // "best", or a list: who writes it wants a ranking.
  void refuse_several_families(const TomlReader& table) const {
    static const std::set<std::string> ranking = {"all", "auto", "best"};
    const std::vector<std::string> keys = table.keys();
    if (std::find(keys.begin(), keys.end(), "family") == keys.end()) return;
    if (table.is_text("family") && !ranking.count(table.required_text("family"))) return;
    const std::string file = shell_word(source_.study.path.string());
    if (table.is_text("family"))
      table.fail("family",
                 fmt::format("is one family: write the one that the parameters are of. To "
                             "rank several for the same data, then run: wearwell compare "
                             "{} --families all",
                             file));
    std::vector<std::string> ranked = table.texts("family");
    std::erase_if(ranked, [](const std::string& each) {
      const auto known = exchangeable_families();
      return std::find(known.begin(), known.end(), each) == known.end();
    });
    table.fail(
        "family",
        ranked.size() < 2 || ranked.front() != table.texts("family").front()
            ? fmt::format("is one family; those that `wearwell compare STUDY --families` "
                          "ranks are {}",
                          fmt::join(exchangeable_families(), ", "))
            : fmt::format("is one family. To rank several for the same data, with parameters "
                          "of the first, run: wearwell compare {} --families {}",
                          file, fmt::join(ranked, ",")));
  }

  // The family that `standard` names.
  static const LogLocationScale* log_location_scale(const TomlReader& table,
                                                    const std::string& family) {
    if (family != LogLocationScale::name) return nullptr;
    std::vector<std::string> standards;
    for (const LogLocationScale& each : log_location_scale_families)
      standards.emplace_back(each.standard);
    const auto standard = table.choice("standard", standards);
    if (!standard)
      table.fail(
          "standard",
          fmt::format("is missing: the distribution of the standardized logarithm, one of {}",
                      fmt::join(standards, ", ")));
    return &*std::find_if(log_location_scale_families.begin(), log_location_scale_families.end(),
                          [&](const auto& each) { return each.standard == *standard; });
  }

  WrittenLikelihood read_likelihood(const TomlReader& table, const std::string& column,
                                    const std::string& place) {
    std::vector<std::string> names;
    for (const ResponseForm& form : response_forms()) {
      if (names.empty() || names.back() != form.name) names.emplace_back(form.name);
    }
    for (const ProcessForm& each : process_forms()) {
      if (names.back() != each.form.name) names.emplace_back(each.form.name);
    }
    names.emplace_back(LogLocationScale::name);
    refuse_several_families(table);
    auto family = table.choice("family", names);
    if (!family) table.fail("family", fmt::format("is missing: {}", fmt::join(names, ", ")));
    const LogLocationScale* const named = log_location_scale(table, *family);
    if (named) family = named->family;
    // Not by table.has, which would mark a key that the form does not have as used.
    const std::vector<std::string> keys = table.keys();
    const auto key_of = [&](std::string_view name) {
      return std::string(!named                  ? name
                         : name == named->scale  ? "scale"
                         : name == named->spread ? "sigma"
                                                 : name);
    };
    const auto among_keys = [&](std::string_view name) {
      return std::find(keys.begin(), keys.end(), key_of(name)) != keys.end();
    };
    const bool steps = among_keys("steps"), ramp = among_keys("ramp");
    if (steps && ramp) table.fail("ramp", "and steps describe one test; give one of them");
    const auto has = [&](std::string_view name) {
      return among_keys(name) ||
             ((steps || ramp) && name == "threshold" && !scale_parameter(*family).empty());
    };
    const ResponseForm* form = given_form(response_forms(), *family, has);
    const ProcessForm* process = nullptr;
    for (const ProcessForm& each : process_forms()) {
      if (process || form || !given_form({&each.form, 1}, *family, has)) continue;
      process = &each;
    }
    if (process) form = &process->form;
    if (!form) {
      table.fail("family", named ? fmt::format("{} needs scale and sigma", LogLocationScale::name)
                                 : fmt::format("{} needs {}", *family,
                                               fmt::join(needed_parameters(*family), ", or ")));
    }
    WrittenLikelihood result = empty_likelihood(column);
    result.place = place;
    result.form = form;
    result.process = process;
    for (std::size_t s = 0; s < form->family_parameters.size(); ++s) {
      const std::string name(form->family_parameters[s].name);
      if (!among_keys(name) || !table.has(key_of(name))) continue;
      std::string text = expression(table, key_of(name));
      if (named && name == named->spread) {
        result.sigma = text;
        if (named->inverse) text = fmt::format("1/({})", text);
      }
      result.family_parameters.emplace_back(s, std::move(text));
      texts_.push_back(result.family_parameters.back().second);
    }
    if (steps || ramp) add_exposure(table, *family, steps, result);
    if (form->family == ResponseFamily::binomial) result.trials = table.required_text("trials");
    if (place.starts_with("likelihood.")) read_shares(table, result);
    return result;
  }

  // The threshold of cumulative exposure; that of a ramp is written later (add_ramp_exposure).
  void add_exposure(const TomlReader& table, const std::string& family, bool steps,
                    WrittenLikelihood& likelihood) {
    const std::string scale = scale_parameter(family);
    std::string text;
    for (const auto& [at, each] : likelihood.family_parameters)
      if (likelihood.form->family_parameters[at].name == scale) text = each;
    if (steps) model_->steps = read_step_stress(table, family, text);
    if (!steps) model_->ramp = read_ramp_stress(table, family, text);
    const auto& parameters = likelihood.form->family_parameters;
    likelihood.family_parameters.emplace_back(parameters.size() - 1,
                                              steps ? threshold_of(*model_->steps) : "0");
  }

  void read_exposure() {
    if (!model_->has_exposure()) return;
    const char* const key = model_->steps ? "steps" : "ramp";
    const WrittenLikelihood& life = written_.front();
    const TomlReader table = root_.required_table("likelihood").required_table(life.column);
    for (const char* other : {"failure_modes", "random_effects", "subpopulations"})
      if (root_.has(other)) table.fail(key, fmt::format("is not possible with [{}]", other));
    for (const char* share : {"share_defective", "share_dead_on_arrival"})
      if (table.has(share)) table.fail(share, fmt::format("is not possible with {}", key));
    if (written_.size() > 1) table.fail(key, "needs one measured column, the life");
    if (special_columns(model_->data).entry)
      table.fail(key, fmt::format("is not possible with data.columns.entry: a {} test begins at 0",
                                  model_->steps ? "step-stress" : "ramp"));
    if (const auto predict = root_.table("predict"); predict && predict->has("along"))
      predict->fail("along",
                    model_->steps
                        ? "is not possible with steps, which are in the order of their ages"
                        : "is not possible with ramp");
    if (model_->steps && !model_->data.label(model_->steps->label))
      table.fail("steps", "must name the column of the specimens under data.columns");
    if (!model_->data.number(life.column)) fail_without_column(life);
    if (model_->steps) add_durations(*model_->steps, life.column, model_->data);
    if (model_->ramp) add_ramp(table, *model_->ramp, life.column, model_->data);
  }

  // Once the names in expressions are known.
  void add_ramp_exposure() {
    if (!model_->ramp) return;
    WrittenLikelihood& life = written_.front();
    const TomlReader table = table_of(life);
    Measured given;
    add_wanted(life, model_->data.number(life.column)->unit.powers, given);
    std::size_t scale = 0;
    while (life.form->family_parameters[given.family_parameter[scale]].name !=
           model_->ramp->parameter)
      ++scale;
    try {
      life.family_parameters.back().second = threshold_of(table, *model_->ramp, model_->lines,
                                                          given.wanted, scale, model_->row_symbols);
    } catch (const InputError& error) {
      fail_at_place(root_, table, error.what());
    }
  }

  // What changes between the steps of a specimen: the life itself excepted.
  std::vector<ChangingStress> stresses_of_steps(const std::string& life) const {
    std::vector<ChangingStress> all;
    const auto& symbols = model_->row_symbols;
    for (std::size_t i = 0; i < symbols.columns.size(); ++i) {
      const std::string& name = symbols.columns[i].name;
      const NumberColumn* column = model_->data.number(name);
      if (!column || name == life || name == model_->steps->duration) continue;
      if (changes_between_steps(*model_->steps, column->values, model_->data))
        all.push_back({name, static_cast<int>(i)});
    }
    for (std::size_t i = 0; i < symbols.labels.size(); ++i) {
      const std::string& name = symbols.labels[i].name;
      const LabelColumn* label = model_->data.label(name);
      if (!label || name == model_->steps->label) continue;
      const std::vector<double> levels(label->at.begin(), label->at.end());
      if (changes_between_steps(*model_->steps, levels, model_->data))
        all.push_back({name, static_cast<int>(i), true});
    }
    return all;
  }

  void require_step_exposure() {
    if (!model_->steps) return;
    const WrittenLikelihood& life = written_.front();
    const TomlReader table = table_of(life);
    Measured given;
    add_wanted(life, model_->data.number(life.column)->unit.powers, given);
    const std::string scale = scale_parameter(table.required_text("family"));
    std::optional<formula::WrittenGraph> written;
    try {
      written = formula::written_graph(model_->lines, given.wanted, model_->row_symbols);
    } catch (const InputError& error) {
      fail_at_place(root_, table, error.what());
    }
    std::set<std::size_t> may;
    for (std::size_t i = 0; i < given.family_parameter.size(); ++i) {
      const std::string_view name = life.form->family_parameters[given.family_parameter[i]].name;
      if (name == scale || name == "threshold") may.insert(i);
    }
    for (const ChangingStress& each : stresses_of_steps(life.column))
      require_scale_alone(table, "steps", scale, *written, given.wanted, may, each);
  }

  void read_use_rate() {
    if (!use_rate_) return;
    if (!model_->data.number(written_.front().column)) fail_without_column(written_.front());
    add_use_rates(root_, written_.front().column, model_->data);
    written_.push_back(*use_rate_);
  }

  // The table of a likelihood.
  TomlReader table_of(const WrittenLikelihood& written) const {
    const std::size_t dot = written.place.find('.');
    const TomlReader table = root_.required_table(written.place.substr(0, dot));
    return dot == std::string::npos ? table : table.required_table(written.place.substr(dot + 1));
  }

  // After the life in use and the rate.
  void add_life_in_time() {
    model_->use_rate = life_in_time(root_, model_->measured[0], model_->measured[1], model_->data);
    Measured& in_time = model_->use_rate->in_time;
    if (model_->measured[0].program.has_paths() || model_->measured[1].program.has_paths())
      root_.fail(UseRate::name,
                 "is not possible with expressions that depend on earlier rows (cum, or a state)");
    in_time.program = formula::compile(model_->lines, in_time.wanted, model_->row_symbols);
    if (!in_time.observed.rows.empty()) model_->measured.push_back(in_time);
  }

  void read_shares(const TomlReader& table, WrittenLikelihood& written) {
    read_shares_of_life(table, written);
    if (written.defective) texts_.push_back(*written.defective);
    if (written.dead) texts_.push_back(*written.dead);
  }

  // Tables of single subpopulations, and the shares.
  void read_texts_of_subpopulations() {
    if (!subpopulations_) return;
    const TomlReader section = root_.required_table("subpopulations");
    for (const std::string& name : subpopulations_with_tables(section, *model_->subpopulations)) {
      of_subpopulations_.push_back(read_likelihood(section.required_table(name),
                                                   written_.empty() ? "" : written_.front().column,
                                                   "subpopulations." + name));
      of_subpopulations_.back().mode = name;
    }
    for (const auto& each : model_->subpopulations->share)
      if (each) texts_.push_back(*each);
  }

  // Replaces the likelihood by that of the mixture, and the lines that depend on the subpopulation by copies.
  void read_mixture() {
    refuse_with_shares(root_, written_);
    if (!subpopulations_) return;
    refuse_with_subpopulations(root_, written_, texts_);
    const LinesByLevel lines(root_, Subpopulations::label, model_->subpopulations->names,
                             model_->lines);
    model_->lines = lines.lines();
    written_.front() =
        mixture_of(root_, *model_->subpopulations, written_.front(), of_subpopulations_, lines);
  }

  // A difference of temperatures has no zero in degrees Celsius: 100 degC would be 373 K.
  void refuse_ranges_in_celsius() const {
    static const std::regex call(R"((coffin_manson|norris_landzberg)\s*\(\s*(\w+)\s*,\s*(\w+))");
    for (const std::string& text : texts_) {
      for (std::sregex_iterator it(text.begin(), text.end(), call), end; it != end; ++it) {
        for (const std::string& name : std::vector<std::string>{(*it)[2], (*it)[3]}) {
          const NumberColumn* column = model_->data.number(name);
          if (column && column->unit.unit.offset != 0)
            root_.required_table("data").required_table("columns").fail(
                name, fmt::format("is the range of {}, a difference of temperatures: give it in K, "
                                  "not in {}",
                                  (*it)[1].str(), column->unit.unit.text));
          const auto constants = root_.table("constants");
          if (constants && constants->is_text(name) &&
              formula::read_any_quantity(constants->required_text(name)).quantity.unit.offset != 0)
            constants->fail(name, fmt::format("is the range of {}, a difference of temperatures: "
                                              "give it in K",
                                              (*it)[1].str()));
        }
      }
    }
  }

  // Replaces the one likelihood by those of the failure modes, and the lines that depend on the mode by
  // copies.
  void read_modes() {
    if (!root_.has("failure_modes")) return;
    const TomlReader section = root_.required_table("failure_modes");
    refuse_with_modes(section);
    const WrittenLikelihood common = written_.front();
    std::vector<WrittenLikelihood> all = of_modes_;
    if (common.form) all.push_back(common);
    for (const WrittenLikelihood& each : all) {
      if (each.process || each.form->counted || !each.form->positive)
        section.fail("", fmt::format("needs families of positive lives, but {} is {}", each.place,
                                     each.form->name));
    }
    const SpecialColumns special = special_columns(model_->data);
    if (!measured_column(common, special)) fail_without_column(common);
    if (all.empty())
      section.fail("", "has no distribution: give [likelihood] or each mode a family");
    const Observed lives =
        read_observed(model_->data, common.column, *all.front().form, special, {}, false);
    model_->modes = read_failure_modes(root_, model_->data, lives);
    const FailureModes& modes = *model_->modes;
    ObservedModes by_mode = observed_by_mode(modes, lives);
    observed_of_modes_ = std::move(by_mode.of);
    model_->joint = std::move(by_mode.joint);
    model_->lives = lives;
    for (std::size_t i = 0; i < lives.rows.size(); ++i) {
      if (modes.possible[lives.rows[i]] == 0) model_->lives.responses[i].seen = Censoring::right;
    }
    const LinesByLevel lines(root_, modes.name, modes.modes, model_->lines);
    model_->lines = lines.lines();
    written_.clear();
    for (std::size_t k = 0; k < modes.modes.size(); ++k) {
      const auto own = std::find_if(of_modes_.begin(), of_modes_.end(),
                                    [&](const auto& each) { return each.mode == modes.modes[k]; });
      if (own == of_modes_.end() && !common.form)
        section.fail(
            "", fmt::format("mode '{}' has no distribution: give it a table [failure_modes.{}], or "
                            "[likelihood.{}] a family for all modes without one",
                            modes.modes[k], modes.modes[k], common.column));
      written_.push_back(own == of_modes_.end() ? common : *own);
      written_.back().mode = modes.modes[k];
      for (auto& [family_parameter, text] : written_.back().family_parameters)
        text = lines.text(text, k);
    }
    if (common.form && of_modes_.size() == modes.modes.size())
      root_.required_table("likelihood")
          .fail(common.column,
                "is not used, because each failure mode has a table of its own; leave it empty");
  }

  void refuse_with_modes(const TomlReader& section) const {
    if (root_.has("random_effects"))
      root_.fail("random_effects", "is not possible with [failure_modes]");
    if (const auto predict = root_.table("predict")) {
      for (const char* key : {"along", "at", "limit", "units", "lives_of"}) {
        if (predict->has(key))
          predict->fail(key, "is for readings along an axis, not for lives with [failure_modes]");
      }
    }
    const std::regex compared("\\b" + section.required_text("column") + R"(\s*(==|!=))");
    for (const std::string& text : texts_) {
      if (std::regex_search(text, compared))
        section.fail("column", fmt::format("'{}' compares the failure mode; give the mode a table "
                                           "[failure_modes.NAME] with its own expressions",
                                           text));
    }
  }

  const NumberColumn* measured_column(const WrittenLikelihood& written,
                                      const SpecialColumns& special) const {
    const NumberColumn* column = model_->data.number(written.column);
    return !column && special.lower ? model_->data.number(*special.lower) : column;
  }

  [[noreturn]] void fail_without_column(const WrittenLikelihood& written) const {
    const std::vector<std::string> names = number_names();
    root_.required_table("likelihood")
        .fail(written.column,
              fmt::format("is not a numeric column under data.columns{}",
                          names.empty() ? ""
                                        : fmt::format(" (nearest: '{}')",
                                                      nearest_name(written.column, names))));
  }

  void read_random_effects(const TomlReader& table, const std::string& label) {
    WrittenEffects written{label, {}, {}};
    for (const std::string& name : table.keys()) {
      if (name == "correlation") continue;
      const TomlReader effect = table.required_table(name);
      const auto kind = effect.choice("distribution", {"lognormal", "normal"});
      if (!kind) effect.fail("distribution", "is missing: \"lognormal\" or \"normal\"");
      const bool lognormal = *kind == "lognormal";
      const std::string key = lognormal ? "log_sd" : "sd";
      if (!effect.has(key)) {
        effect.fail(key, fmt::format("is missing: a {} distribution of units needs it", *kind));
      }
      written.effects.push_back({name, expression(effect, key), lognormal});
      texts_.push_back(written.effects.back().scatter);
    }
    if (written.effects.empty()) table.fail("", "has no parameter with a random effect");
    if (table.has("correlation")) {
      if (written.effects.size() != 2)
        table.fail("correlation", "needs two parameters with random effects");
      written.correlation = expression(table, "correlation");
      texts_.push_back(*written.correlation);
    }
    varies_.push_back(std::move(written));
  }

  // Whether paths are integrated out themselves: then effects of their units are drawn.
  bool has_hidden_paths() const {
    return std::any_of(written_.begin(), written_.end(), [](const WrittenLikelihood& each) {
      return each.process && each.process->process != Process::wiener &&
             std::any_of(each.family_parameters.begin(), each.family_parameters.end(),
                         [](const auto& family_parameter) {
                           return family_parameter.first == 2;  // noise
                         });
    });
  }

  // The label that identifies units, and the effects that are drawn.
  void choose_units() {
    if (varies_.empty()) return;
    const std::size_t unit = label_of_units(root_, model_->data, varies_);
    const WrittenEffects& units = varies_[unit];
    model_->label = units.label;
    correlation_ = units.correlation;
    effects_ = units.effects;
    if (effects_.size() > most_unit_effects) {
      root_.required_table("random_effects")
          .required_table(units.label)
          .fail(effects_[most_unit_effects].name,
                fmt::format(
                    "is one too many: at most {} parameters may have random effects over {} to {}",
                    most_unit_effects, units.label, units.label));
    }
    for (std::size_t v = 0; v < varies_.size(); ++v) {
      if (v != unit) drawn_.push_back(varies_[v]);
    }
    const bool hidden = has_hidden_paths();
    if (effects_.size() <= latent_effects && !hidden) return;
    const std::size_t kept = hidden                                 ? 0
                             : effects_.size() == most_unit_effects ? latent_effects
                                                                    : integrated_;
    WrittenEffects rest{units.label, {}, {}};
    if (hidden) std::swap(rest.correlation, correlation_);
    rest.effects.assign(effects_.begin() + static_cast<std::ptrdiff_t>(kept), effects_.end());
    effects_.resize(kept);
    drawn_.push_back(std::move(rest));
  }

  // If rows follow each other, the one column without a unit that no expression uses identifies the
  // units; it would have no purpose otherwise.
  std::optional<std::string> idle_column() const {
    static const std::regex path(R"(\bcum\s*\(|\bd\s*\(\s*\w+\s*\)\s*/)");
    bool follows = std::any_of(written_.begin(), written_.end(),
                               [](const auto& each) { return each.process != nullptr; });
    std::string all;
    for (const std::string& text : texts_) all += text + "\n";
    for (const formula::Line& line : model_->lines) all += line.name + "\n";
    follows |= std::regex_search(all, path);
    if (!follows) return {};
    if (const auto predict = root_.table("predict")) {
      all += predict->text("along").value_or("") + "\n";
    }
    for (const WrittenLikelihood& each : written_) {
      all += each.column + "\n" + each.trials.value_or("") + "\n";
    }
    for (const std::string& each : special_names) all += each + "\n";
    const TomlReader columns = root_.required_table("data").required_table("columns");
    std::optional<std::string> found;
    for (const std::string& name : columns.keys()) {
      if (!columns.is_text(name) && columns.required_table(name).has("unit")) continue;
      if (std::regex_search(all, std::regex("\\b" + name + "\\b"))) continue;
      if (found) return {};
      found = name;
    }
    return found;
  }

  std::vector<std::string> label_names() {
    std::vector<std::string> names;
    for (const WrittenEffects& each : varies_) names.push_back(each.label);
    names.emplace_back("status");
    if (model_->steps) names.push_back(model_->steps->label);
    if (const auto unit = idle_column(); unit && varies_.empty()) names.push_back(*unit);
    static const std::regex indexed(R"(([A-Za-z_]\w*)\s*\[\s*([A-Za-z_]\w*)\s*\])");
    static const std::regex compared(R"re(([A-Za-z_]\w*)\s*(==|!=)\s*")re");
    static const std::regex compared_back(R"re("\s*(==|!=)\s*([A-Za-z_]\w*))re");
    static const std::regex unit_before(R"([0-9.)]\s*$)");
    for (const std::string& text : texts_) {
      for (std::sregex_iterator it(text.begin(), text.end(), indexed), end; it != end; ++it) {
        indexed_[(*it)[1]] = (*it)[2];
        names.push_back((*it)[2]);
      }
      for (std::sregex_iterator it(text.begin(), text.end(), compared), end; it != end; ++it) {
        names.push_back((*it)[1]);
      }
      for (std::sregex_iterator it(text.begin(), text.end(), compared_back), end; it != end; ++it) {
        names.push_back((*it)[2]);
      }
    }
    return names;
  }

  // The axis of wear and life, along which the rows of a unit are sorted.
  void read_along() {
    if (const auto predict = root_.table("predict")) model_->along = predict->text("along");
    if (model_->along && !model_->data.number(*model_->along)) {
      const std::vector<std::string> names = number_names();
      root_.required_table("predict").fail(
          "along", fmt::format("'{}' is not a numeric column under data.columns{}", *model_->along,
                               names.empty() ? ""
                                             : fmt::format(" (nearest: '{}')",
                                                           nearest_name(*model_->along, names))));
    }
    if (model_->along) return;
    static const std::regex rate(R"(d\(\s*\w+\s*\)\s*/\s*d\(\s*(\w+)\s*\))");
    for (const formula::Line& line : model_->lines) {
      std::smatch match;
      if (std::regex_match(line.name, match, rate) && model_->data.number(match[1])) {
        model_->along = match[1];
      }
    }
  }

  std::vector<std::string> number_names() const {
    std::vector<std::string> names;
    for (const NumberColumn& each : model_->data.numbers) names.push_back(each.name);
    return names;
  }

  bool is_measured(const std::string& name) const {
    return std::any_of(written_.begin(), written_.end(),
                       [&](const auto& each) { return each.column == name; });
  }

  bool is_age(const std::string& name) const {
    return use_rate_ && root_.required_table(UseRate::name).required_text("age") == name;
  }

  void read_symbols() {
    for (const NumberColumn& column : model_->data.numbers) {
      const bool special =
          std::find(special_names.begin(), special_names.end(), column.name) != special_names.end();
      model_->symbols.columns.push_back(
          {column.name, column.unit.powers,
           special || is_measured(column.name) || is_age(column.name)});
    }
    for (const LabelColumn& label : model_->data.labels) {
      if (label.name != "status") model_->symbols.labels.push_back({label.name, label.levels});
    }
    if (model_->modes)
      model_->symbols.labels.push_back({model_->modes->name, model_->modes->modes});
    if (subpopulations_)
      model_->symbols.labels.push_back({Subpopulations::label, model_->subpopulations->names});
    if (const auto constants = root_.table("constants")) {
      for (const std::string& name : constants->keys()) {
        if (!constants->is_text(name)) {
          model_->symbols.constants.push_back(
              {name, {}, constants->required_quantity(name, "1").si()});
          continue;
        }
        try {
          const formula::AnyQuantity q = formula::read_any_quantity(constants->required_text(name));
          model_->symbols.constants.push_back({name, q.powers, q.quantity.si()});
        } catch (const InputError& error) {
          constants->fail(name, error.what());
        }
      }
    }
  }

  // The sign of a parameter, from the places where it stands alone.
  std::map<std::string, Bounds> natural_bounds() const {
    std::map<std::string, Bounds> bounds;
    const auto base = [](const std::string& text) {
      const std::string_view name = trimmed(text);
      return std::string(trimmed(name.substr(0, name.find('['))));
    };
    for (const WrittenLikelihood& written : written_) {
      for (const WrittenLikelihood& each : parts_of(written)) {
        for (const auto& [family_parameter, text] : each.family_parameters) {
          const ParameterKind kind = each.form->family_parameters[family_parameter].kind;
          if (kind == ParameterKind::probability) bounds[base(text)].take(0, 1);
          if (kind == ParameterKind::scale || kind == ParameterKind::number)
            bounds[base(text)].take(0, INFINITY);
        }
        if (each.sigma) bounds[base(*each.sigma)].take(0, INFINITY);
      }
      for (const WrittenShare& each : written.shares) bounds[base(each.text)].take(0, 1);
    }
    for (const WrittenEffects& random_effects : varies_) {
      for (const WrittenEffect& each : random_effects.effects) {
        if (each.lognormal) bounds[each.name].take(0, INFINITY);
        bounds[std::string(trimmed(each.scatter))].take(0, INFINITY);
      }
      if (random_effects.correlation)
        bounds[std::string(trimmed(*random_effects.correlation))].take(-1, 1);
    }
    return bounds;
  }

  formula::Powers powers_of_prior(const TomlReader& priors, const std::string& key) const {
    const TomlReader table = priors.required_table(key);
    for (const std::string& each : dimensional_keys()) {
      if (!table.has(each) || !table.is_text(each)) continue;
      try {
        return each == "unit" ? formula::read_any_unit(table.required_text(each)).powers
                              : formula::read_any_quantity(table.required_text(each)).powers;
      } catch (const InputError& error) {
        table.fail(each, error.what());
      }
    }
    return {};
  }

  Parameter read_one(const TomlReader& priors, const std::string& key, const std::string& name,
                     const formula::Powers& powers, const Bounds& bounds) const {
    std::string si;
    try {
      si = formula::si_text(powers);
    } catch (const InputError& error) {
      priors.fail(key, error.what());
    }
    Parameter parameter = read_prior(priors, {key, si, bounds.lower, bounds.upper, 1});
    parameter.name = name;
    if (parameter.prior.proper) {
      parameter.start = quantile(parameter.prior, 0.5);
    } else if (parameter.prior.lower < parameter.unit.scale &&
               parameter.unit.scale < parameter.prior.upper) {
      parameter.start = parameter.scale = parameter.unit.scale;
    }
    return parameter;
  }

  void read_parameters() {
    const TomlReader priors = root_.required_table("prior");
    const std::map<std::string, Bounds> natural = natural_bounds();
    const auto bounds_of = [&](const std::string& name) {
      const auto at = natural.find(name);
      return at == natural.end() ? Bounds() : at->second;
    };
    std::set<std::string> done;
    for (const std::string& key : priors.keys()) {
      const std::string base(trimmed(std::string_view(key).substr(0, key.find('['))));
      const auto at = indexed_.find(base);
      if (at == indexed_.end()) {
        if (base != key) {
          priors.fail(key,
                      fmt::format("no expression uses {}[...]; write a parameter with one value "
                                  "per level as {}[material], where 'material' is a label",
                                  base, base));
        }
        const formula::Powers powers = powers_of_prior(priors, key);
        model_->parameters.push_back(read_one(priors, key, key, powers, bounds_of(key)));
        model_->symbols.parameters.push_back({key, powers});
        continue;
      }
      if (!done.insert(base).second) continue;
      read_levels(priors, base, at->second, bounds_of(base));
    }
  }

  // k[material]: one prior for all under `k` (or "k[material]"), or one each under "k[PTFE]".
  void read_levels(const TomlReader& priors, const std::string& base, const std::string& label,
                   const Bounds& bounds) {
    const LabelColumn* column = model_->data.label(label);
    const std::vector<std::string>* const unstated =  // levels that no row states
        model_->modes && model_->modes->name == label       ? &model_->modes->modes
        : subpopulations_ && label == Subpopulations::label ? &model_->subpopulations->names
                                                            : nullptr;
    if (!column && !unstated) {
      const auto& labels = model_->data.labels;
      const bool is_level = std::any_of(labels.begin(), labels.end(), [&](const LabelColumn& each) {
        return std::find(each.levels.begin(), each.levels.end(), label) != each.levels.end();
      });
      priors.fail(
          base,
          is_level
              ? fmt::format("an expression has {0}[{1}]; write {0}['{1}'] for the value at the "
                            "level '{1}'",
                            base, label)
              : fmt::format("is indexed by [{}], but '{}' is not a label under data.columns", label,
                            label));
    }
    if (std::any_of(drawn_.begin(), drawn_.end(),
                    [&](const WrittenEffects& each) { return each.label == label; })) {
      priors.fail(base, fmt::format("has an independent value for each {}, and a random effect in "
                                    "[random_effects.{}]; remove one of the two",
                                    label, label));
    }
    std::optional<formula::Powers> powers;
    const std::string common = priors.has(base) ? base : fmt::format("{}[{}]", base, label);
    for (const std::string& level : unstated ? *unstated : column->levels) {
      const std::string name = fmt::format("{}[{}]", base, level);
      const std::string key = priors.has(name) ? name : common;
      if (!priors.has(key)) {
        priors.fail("", fmt::format("no prior for {}; give one for all levels as {}, or one each",
                                    name, base));
      }
      const formula::Powers own = powers_of_prior(priors, key);
      if (powers && *powers != own) {
        priors.fail(key, fmt::format("is in {}, but in {} at another level",
                                     formula::description(own), formula::description(*powers)));
      }
      powers = own;
      model_->parameters.push_back(read_one(priors, key, name, own, bounds));
    }
    model_->symbols.parameters.push_back({base, *powers, formula::Scope::per_level, label});
  }

  void read_effects() {
    model_->row_symbols = model_->symbols;
    if (!model_->label) {
      model_->shared.resize(model_->parameters.size());
      std::iota(model_->shared.begin(), model_->shared.end(), 0);
      return;
    }
    const TomlReader random_effects = root_.required_table("random_effects");
    const TomlReader table = random_effects.required_table(*model_->label);
    if (!model_->data.label(*model_->label)) {
      random_effects.fail(
          *model_->label,
          "is not a column under data.columns; random effects vary over the levels of a label");
    }
    const std::vector<std::size_t> begin = formula::slots(model_->symbols);
    std::set<std::size_t> own;
    for (std::size_t s = 0; s < model_->symbols.parameters.size(); ++s) {
      const formula::ParameterSymbol& symbol = model_->symbols.parameters[s];
      const auto effect = std::find_if(effects_.begin(), effects_.end(),
                                       [&](const auto& each) { return each.name == symbol.name; });
      if (effect == effects_.end()) continue;
      if (symbol.scope != formula::Scope::one) {
        table.fail(
            symbol.name,
            "has one value for each level of a label; it cannot have a random effect as well");
      }
      model_->effects.push_back({symbol.name, s, begin[s], effect->lognormal});
      model_->row_symbols.parameters[s].scope = formula::Scope::per_row;
      own.insert(begin[s]);
    }
    for (const WrittenEffect& effect : effects_) {
      const bool known = std::any_of(model_->effects.begin(), model_->effects.end(),
                                     [&](const Effect& each) { return each.name == effect.name; });
      if (!known) table.fail(effect.name, "is not a parameter: it has no prior");
    }
    for (std::size_t i = 0; i < model_->parameters.size(); ++i) {
      if (!own.count(i)) model_->shared.push_back(i);
    }
    model_->units = model_->data.label(*model_->label)->levels;
    if (model_->units.size() < 2) {
      random_effects.fail(
          *model_->label,
          fmt::format("all rows of {} are of one {}; its variation needs at least 2",
                      model_->data.table.source, *model_->label));
    }
    put_drawn_effects_in_rows(*model_);
  }

  void compile_population() {
    if (!model_->label) return;
    const TomlReader table = root_.required_table("random_effects").required_table(*model_->label);
    std::vector<formula::Wanted> wanted;
    for (const Effect& effect : model_->effects) {
      const auto written =
          std::find_if(effects_.begin(), effects_.end(),
                       [&](const WrittenEffect& each) { return each.name == effect.name; });
      const formula::Powers powers =
          effect.lognormal ? formula::Powers() : model_->symbols.parameters[effect.symbol].powers;
      wanted.push_back({fmt::format("[random_effects.{}] {} {}", *model_->label, effect.name,
                                    effect.lognormal ? "log_sd" : "sd"),
                        written->scatter, powers,
                        effect.lognormal ? "the sd of a logarithm" : effect.name, true});
    }
    if (correlation_) {
      wanted.push_back({fmt::format("[random_effects.{}] correlation", *model_->label),
                        *correlation_, formula::Powers(), "a correlation", true});
      model_->correlated = true;
    }
    try {
      model_->population = formula::compile({}, wanted, model_->symbols);
    } catch (const InputError& error) {
      fail_at_place(root_, table, error.what());
    }
  }

  SpecialColumns allowed_special_columns() const {
    const SpecialColumns special = special_columns(model_->data);
    const auto process = std::find_if(written_.begin(), written_.end(),
                                      [](const auto& each) { return each.process != nullptr; });
    if (process != written_.end()) {
      for (const auto& each :
           {special.status, special.lower, special.upper, special.entry, special.count}) {
        if (!each) continue;
        root_.required_table("data").required_table("columns").fail(
            *each, fmt::format("is not possible for a {}: each of its readings is one exact number",
                               process->form->name));
      }
    }
    if (!model_->modes && !use_rate_ && written_.size() > 1 &&
        (special.status || special.lower || special.upper || special.entry)) {
      const TomlReader columns = root_.required_table("data").required_table("columns");
      columns.fail(special.status  ? "status"
                   : special.lower ? "lower"
                   : special.upper ? "upper"
                                   : "entry",
                   "is ambiguous in a study of several measured columns");
    }
    return special;
  }

  void compile_measured() {
    const SpecialColumns special = allowed_special_columns();
    for (const WrittenLikelihood& written : written_) {
      const TomlReader table = table_of(written);
      const NumberColumn* column = measured_column(written, special);
      if (!column) fail_without_column(written);
      Measured measured{written.column,
                        written.mode,
                        column->unit.unit,
                        column->unit.powers,
                        written.form,
                        written.process,
                        written.trials,
                        {},
                        {},
                        {},
                        {},
                        written.life()};
      if (written.form->counted && !column->unit.powers.empty() && column->unit.unit.scale != 1) {
        table.fail("family",
                   fmt::format("{} is for counts; '{}' is measured in {}", written.form->name,
                               written.column, column->unit.unit.text));
      }
      if (written.trials && !model_->data.number(*written.trials)) {
        table.fail("trials", "must name a numeric column under data.columns");
      }
      add_wanted(written, column->unit.powers, measured);
      try {
        measured.program = formula::compile(model_->lines, measured.wanted, model_->row_symbols);
      } catch (const InputError& error) {
        fail_at_place(root_, table, error.what());
      }
      if (written.process) model_->data.require_values(*column);
      const bool may_lack = written_.size() > 1;
      const bool is_rate = use_rate_ && !model_->measured.empty();
      measured.observed = model_->modes ? std::move(observed_of_modes_[model_->measured.size()])
                          : is_rate
                              ? observed_rates(model_->data, model_->measured[0].observed)
                              : read_observed(model_->data, written.column, *written.form, special,
                                              written.trials, may_lack, measured.life.dead);
      if (model_->steps)
        measured.observed =
            last_steps(*model_->steps, written.column, model_->data, measured.observed);
      if (model_->ramp) require_exact_failures(model_->data, written.column, measured.observed);
      if (model_->modes && measured.program.has_paths())
        table.fail(
            "",
            "depends on earlier rows (cum, or a state); that is not possible with [failure_modes]");
      if (!measured.life.plain() && measured.program.has_paths())
        table.fail("", "depends on earlier rows (cum, or a state); lives of subpopulations cannot");
      measured.reporting = model_->data.reporting;
      model_->measured.push_back(std::move(measured));
    }
    if (use_rate_) add_life_in_time();
    if (subpopulations_)
      model_->subpopulations->exchangeable = are_exchangeable(
          written_.front(), *model_->subpopulations, model_->written, model_->parameters);
    for (const NumberColumn& each : model_->data.numbers) {
      const bool measured = std::any_of(model_->measured.begin(), model_->measured.end(),
                                        [&](const Measured& m) { return m.column == each.name; });
      if (!measured) model_->data.require_values(each);
    }
    for (std::size_t c = 0; c < model_->row_symbols.columns.size(); ++c) {
      const bool used = std::any_of(model_->measured.begin(), model_->measured.end(),
                                    [&](const Measured& m) { return m.program.uses_column(c); });
      if (used)
        model_->data.require_complete(*model_->data.number(model_->row_symbols.columns[c].name));
    }
    require_used_parameters();
  }

  // A parameter without effect on any output is a mistake: its posterior would be its prior.
  void require_used_parameters() const {
    const TomlReader priors = root_.required_table("prior");
    for (std::size_t s = 0; s < model_->symbols.parameters.size(); ++s) {
      const bool measured =
          std::any_of(model_->measured.begin(), model_->measured.end(),
                      [&](const Measured& m) { return m.program.uses_parameter(s); });
      if (measured || (model_->label && model_->population.uses_parameter(s))) continue;
      const std::string& name = model_->symbols.parameters[s].name;
      priors.fail(name, "is in no likelihood: the data would not inform it");
    }
  }

  static constexpr std::size_t latent_effects = 2, most_unit_effects = 4;
  const TomlReader& root_;
  const Source& source_;
  std::size_t integrated_;
  std::shared_ptr<FormulaModel> model_;
  std::vector<std::string> texts_;
  std::vector<WrittenLikelihood> written_;
  std::vector<WrittenLikelihood> of_modes_;  // of the modes with a table
  std::vector<WrittenLikelihood> of_subpopulations_;
  bool subpopulations_ = false;
  std::optional<WrittenLikelihood> use_rate_;
  std::vector<Observed> observed_of_modes_;
  std::vector<WrittenEffects> varies_;
  std::vector<WrittenEffect> effects_;  // of the units, which are integrated out
  std::vector<WrittenEffects> drawn_;
  std::optional<std::string> correlation_;
  std::map<std::string, std::string> indexed_;  // parameter -> label
};

}  // namespace

std::string expression(const TomlReader& table, const std::string& key) {
  if (table.is_text(key)) return table.required_text(key);
  return fmt::format("{}", table.required_quantity(key, "1").si());
}

formula::Program compile_at(const TomlReader& table, const std::string& key,
                            const std::vector<formula::Line>& lines, const formula::Wanted& wanted,
                            const formula::Symbols& symbols) {
  try {
    return formula::compile(lines, {wanted}, symbols);
  } catch (const InputError& error) {
    table.fail(key, error.what());
  }
}

std::shared_ptr<FormulaModel> read_formula_model(const TomlReader& root, const Source& source) {
  std::shared_ptr<FormulaModel> model = Reader(root, source, 2).read();
  // Two effects in which paths are linear cost no more than one; otherwise, of three, only one is
  // integrated out.
  const auto drawn = std::ranges::count_if(
      model->drawn, [&](const DrawnEffect& each) { return model->label == each.label; });
  if (drawn != 1 || model->effects.empty() ||
      is_linear(*model, bind_columns(*model, model->data.table.rows)))
    return model;
  return Reader(root, source, 1).read();
}

}  // namespace wearwell::formula_model
