#include "wearwell/prognosis/unit_life.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/toml_edit.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/math/constants.h"
#include "wearwell/prognosis/data_roles.h"
#include "wearwell/prognosis/named_life.h"
#include "wearwell/prognosis/required_lives.h"
#include "wearwell/study/inference_data.h"

// Longer than others: each kind of study reports lives in its own way, but the question is the
// same.

namespace wearwell::prognosis {
namespace {

double probit(double p) {
  return boost::math::quantile(boost::math::normal(), p);
}

// For a study with one life: of a joint, or of a new bearing.
UnitLife of_request(const LifeRequest& request, const WeightedDraws& posterior,
                    const LifeQuestion& question) {
  const LifeDistribution distribution = request.distribution(posterior);
  UnitLife life{.of = request.of.empty() ? "joint" : request.of,
                .at = fmt::format("to {:.6g} {}", request.limit.value, request.limit.unit.text),
                .unit = request.unit_name};
  life.risk = request.risk;
  double from = request.now;
  if (question.survived) {
    const double survived = along_life("--survived", *question.survived, life.unit);
    if (survived < from)
      throw InputError(
          fmt::format("--survived: {} lies before the last inspection, at {:.6g} {}: leave out "
                      "--survived; the remaining life counts from there",
                      *question.survived, from, life.unit));
    from = survived;
  }
  life.name = from > 0 ? "remaining useful life" : "life";
  if (from > 0) life.from = from;
  const double before = from > 0 ? distribution.cdf(from) : 0;
  if (from > 0) life.passed = before;
  if (before > 1 - 1e-3)
    throw InputError(
        fmt::format("the {} has reached its threshold before {:.6g} {} with a probability of more "
                    "than 99.9 %; its remaining useful life is undetermined",
                    life.of, from, life.unit));
  for (const double percent :
       life_percentages(question.risk.value_or(life.risk), question.shares)) {
    const double p = percent / 100;
    life.share.push_back(p);
    life.life.push_back(std::max(0.0, distribution.quantile(before + p * (1 - before)) - from));
  }
  answer(question, life,
         [&](double until) { return (distribution.cdf(from + until) - before) / (1 - before); });
  return life;
}

Source with_wishes(const Source& source,
                   const std::vector<std::pair<std::string, std::string>>& keys) {
  if (keys.empty()) return source;
  Source asked = source;
  asked.study = with_predict(source.study, keys);
  return asked;
}

// A bearing study reports the life of a new bearing unless --unit names one.
Source of_one_bearing(const Source& source, const LifeQuestion& question) {
  const TomlReader root = TomlReader::parse(source.study);
  if (question.unit.empty() || root.required_text("model") != "bearing-wear") return source;
  const Table table = read_table(root.required_table("data"), source);
  const DataRoles roles = data_roles(root, table);
  if (!roles.unit)
    throw InputError(
        "--unit: the rows of this study do not name their bearing (data.columns.bearing); without "
        "--unit you get the life of a new one");
  const Column& column = table.column(*roles.unit);
  std::vector<std::string> known;
  for (std::size_t row = 0; row < table.rows; ++row) known.push_back(cell_word(column, row));
  const std::string bare = question.unit.starts_with("bearing ") ? question.unit.substr(8) : "";
  for (const std::string& name : {question.unit, bare}) {
    if (std::find(known.begin(), known.end(), name) == known.end()) continue;
    return with_wishes(source, {{"life_of", nlohmann::json(name).dump()}});
  }
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  throw InputError(
      fmt::format("--unit: '{}' is unknown{} (known: {}; without --unit a new bearing)",
                  question.unit, did_you_mean(question.unit, known), fmt::join(known, ", ")));
}

bool to_a_limit(const Source& source) {
  const TomlReader root = TomlReader::parse(source.study);
  const auto predict = root.table("predict");
  return predict && predict->has("limit");
}

std::vector<QuantityRequest> lives_asked(const PosteriorStudy& study) {
  std::vector<QuantityRequest> lives;
  for (const QuantityGroup& group : study.quantity_groups) {
    for (const QuantityRequest& each : group.requests) {
      if (each.is_life) lives.push_back(each);
    }
  }
  return lives;
}

bool is_new(const QuantityRequest& life) {
  return life.of.starts_with("new ");
}

// "7" of "machine 7".
std::string label_of(const QuantityRequest& life) {
  return life.of.substr(std::min(life.of.find(' ') + 1, life.of.size()));
}

// The name that matches.
const QuantityRequest& chosen(const std::vector<QuantityRequest>& all,
                              const LifeQuestion& question) {
  std::vector<std::string> names, fresh;
  std::vector<const QuantityRequest*> fitting;
  for (const QuantityRequest& each : all) {
    const std::string bare = without_new(each.of);
    const bool fits =
        question.unit.empty()
            ? is_new(each)
            : bare == question.unit || (!is_new(each) && label_of(each) == question.unit);
    is_new(each) ? fresh.push_back(bare) : names.push_back(label_of(each));
    if (fits) fitting.push_back(&each);
  }
  // Without a name, the study's headline: the part as it is, not without one of its failure modes.
  const auto first =
      std::find_if(all.begin(), all.end(), [](const auto& each) { return each.headline; });
  if (question.unit.empty() && first != all.end())
    std::erase_if(fitting, [&](const auto* each) { return each->of != first->of; });
  // For a new unit both its life and its remaining life where it has survived so far.
  if (fitting.size() == 2 && fitting[0]->of == fitting[1]->of) return *fitting[1];
  if (fitting.size() == 1) return *fitting[0];
  if (all.empty())
    throw InputError(
        "the study has no life to report: [predict] needs a limit (or, for S-N tests, a stress)");
  const auto once = [](std::vector<std::string>& each) {
    std::sort(each.begin(), each.end());
    each.erase(std::unique(each.begin(), each.end()), each.end());
  };
  once(names);
  once(fresh);
  // With only one kind of new unit no name is needed.
  const bool unnamed = fresh.size() == 1;
  std::string known = fmt::format("{}", fmt::join(names, ", "));
  if (!unnamed && !fresh.empty())
    known += fmt::format("{}{}", known.empty() ? "" : ", ", fmt::join(fresh, ", "));
  if (!known.empty()) known = fmt::format("known: {}", known);
  if (unnamed)
    known += fmt::format("{}without --unit a new {}", known.empty() ? "" : "; ", fresh.front());
  if (question.unit.empty())
    throw InputError(fmt::format("--unit is missing: name the unit ({})", known));
  if (!unnamed) names.insert(names.end(), fresh.begin(), fresh.end());
  throw InputError(fmt::format("--unit: '{}' is unknown{} ({})", question.unit,
                               did_you_mean(question.unit, names), known));
}

// A unit with a reading beyond its given survival counts from its last reading.
void require_ahead(const QuantityRequest& mine, const std::vector<QuantityRequest>& all,
                   const std::string& survived) {
  if (is_new(mine)) return;
  for (const QuantityRequest& each : all) {
    if (!is_new(each) || each.name != "remaining useful life" || each.at == mine.at) continue;
    throw InputError(fmt::format(
        "--survived: {} has readings beyond {} already: leave out --survived; the remaining life "
        "counts {}",
        mine.of, survived, mine.at.substr(std::min(mine.at.rfind("from "), mine.at.size()))));
  }
}

// The distribution of the named unit.
PredictiveLife life_of(const QuantityRequest& mine, const PosteriorStudy& study,
                       const WeightedDraws& posterior) {
  for (const QuantityGroup& group : study.quantity_groups) {
    std::size_t lives = 0;
    for (const QuantityRequest& each : group.requests) {
      if (each.is_life && each.of == mine.of && each.name == mine.name && each.at == mine.at)
        return group.lives(posterior)[lives];
      lives += each.is_life ? 1 : 0;
    }
  }
  throw InputError(fmt::format("the study has no life of {}", mine.of));
}

// From `survived` on, where the question concerns the survivors of tests to failure at one load:
// `known` is then the life from the start.
UnitLife described(const QuantityRequest& mine, const PredictiveLife& known,
                   const LifeQuestion& question, bool from_beginning) {
  UnitLife life{.of = mine.of, .at = mine.at, .unit = mine.unit.text};
  life.name = mine.name;
  life.numerical_error = known.numerical_error;
  double from = 0, gone = 0;
  if (question.survived && from_beginning) {
    from = along_life("--survived", *question.survived, life.unit);
    gone = known.distribution.cdf(to_si(mine.unit, from));
    if (gone > 1 - 1e-3)
      throw InputError(
          fmt::format("--survived: hardly any {} reaches {}", life.of, *question.survived));
    life.name = "remaining useful life";
    life.from = from;
    life.passed = gone;
  } else if (question.survived) {
    life.passed = 1 - known.survival;
  }
  double before = 0;
  for (const double percent :
       life_percentages(question.risk.value_or(life.risk), question.shares)) {
    const double p = percent / 100;
    const double value =
        from_si(mine.unit, known.distribution.quantile(gone + p * (1 - gone))) - from;
    if (std::isnan(value))
      throw InputError(fmt::format("the {} of {} is undetermined: hardly any gets this far",
                                   life.name, life.of));
    before = std::max(before, value);  // quantiles are solved to this many digits
    life.share.push_back(p);
    life.life.push_back(before);
  }
  constexpr double hardly = 1e-9, for_ever = 1e300;
  const double never = (1 - known.distribution.cdf(for_ever)) / (1 - gone);
  if (from_beginning && never > hardly) life.never = never;
  answer(question, life, [&](double until) {
    return (known.distribution.cdf(to_si(mine.unit, from + until)) - gone) / (1 - gone);
  });
  return life;
}

// A wrong value of --survived is an error of the option, not of the study that carries it; empty
// if the message is about anything else.
std::string problem_of_survived(const std::string& message) {
  const std::string key = "predict.survived: ";
  const std::size_t at = message.find(key);
  if (at == message.npos) return {};
  const std::string why = message.substr(at + key.size());
  return "--survived: " + why.substr(0, why.find('\n'));
}

}  // namespace

std::vector<double> life_percentages(double risk, const std::vector<double>& shares) {
  std::vector<double> levels = {0.01, 0.03, 0.1, 0.3, 0.5, 1,  2,    3,    5,
                                7,    93,   95,  97,  98,  99, 99.5, 99.9, 99.99};
  for (int percent = 10; percent <= 90; percent += 5) levels.push_back(percent);
  std::vector<double> asked = shares;
  asked.push_back(risk);
  for (const double share : asked) {
    const double at = 100 * share;
    if (std::none_of(levels.begin(), levels.end(),
                     [&](double each) { return std::abs(each - at) < 1e-9 * at; }))
      levels.push_back(at);
  }
  std::sort(levels.begin(), levels.end());
  return levels;
}

double along_life(const char* option, const std::string& text, const std::string& unit) {
  const bool counted = unit == "cycles" || unit == "revolutions" || unit.ends_with(" cycles");
  const std::string si = unit == "revolutions" ? "rev" : counted ? "cycle" : unit;
  const double one = unit.ends_with(" cycles") ? read_unit(unit, "cycle").scale : 1;
  try {
    const Quantity given = read_quantity(text, si);
    const double value = counted ? given.si() / one : from_si(read_unit(unit, si), given.si());
    if (value >= 0 && std::isfinite(value)) return value;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", option, error.what()));
  }
  throw InputError(fmt::format("{}: '{}' must not be negative", option, text));
}

void answer(const LifeQuestion& question, UnitLife& life,
            const std::function<double(double until)>& cdf) {
  life.risk = question.risk.value_or(life.risk);
  life.inspect_within = life.quantile(life.risk);
  if (!question.horizon) return;
  life.horizon = along_life("--horizon", *question.horizon, life.unit);
  life.reached = std::clamp(cdf(*life.horizon), 0.0, 1.0);
}

double UnitLife::quantile(double p) const {
  const auto above = std::lower_bound(share.begin(), share.end(), p * (1 - 1e-12));
  if (above == share.end()) return infinity;
  const auto i = static_cast<std::size_t>(above - share.begin());
  if (i == 0 || std::abs(share[i] - p) < 1e-12) return life[i];
  const double part =
      (probit(p) - probit(share[i - 1])) / (probit(share[i]) - probit(share[i - 1]));
  if (!std::isfinite(life[i])) return infinity;
  if (!(life[i - 1] > 0)) return life[i - 1] + part * (life[i] - life[i - 1]);
  return std::exp(std::lerp(std::log(life[i - 1]), std::log(life[i]), part));
}

UnitLife unit_life(const Source& source, const ReadAsked& read, const WeightedDraws& posterior,
                   const LifeQuestion& question) {
  const auto whole = read(of_one_bearing(source, question));
  const PosteriorStudy& study = require_posterior_study(*whole);
  if (study.life) {
    const TomlReader data = TomlReader::parse(source.study).required_table("data");
    const std::string name = data.text("joint").value_or("joint");
    if (study.life->of.empty() && !question.unit.empty() && question.unit != name)
      throw InputError(fmt::format(
          "--unit: this study is of one joint, called '{}' (data.joint): leave out --unit. Joints "
          "with different wear rates need a study of model \"formula\" with [random_effects.UNIT]",
          printable(name)));
    return of_request(*study.life, posterior, question);
  }
  const bool distribution = study.model == "formula";
  std::vector<std::pair<std::string, std::string>> keys;
  if (distribution && question.survived)
    keys.emplace_back("survived", nlohmann::json(*question.survived).dump());
  std::unique_ptr<const Study> asked;
  try {
    asked = read(with_wishes(source, keys));
  } catch (const InputError& error) {
    const std::string problem = problem_of_survived(error.what());
    if (problem.empty()) throw;
    throw InputError(problem);
  }
  const PosteriorStudy& fitted = require_posterior_study(*asked);
  const std::vector<QuantityRequest> requests = lives_asked(fitted);
  if (requests.empty()) refuse_repairable(fitted, fitted.title);
  const QuantityRequest mine = chosen(requests, question);
  if (distribution && question.survived) require_ahead(mine, requests, *question.survived);
  if (distribution && to_a_limit(source) &&
      (is_new(mine) || mine.of.find(' ') != std::string::npos)) {
    const nlohmann::json only =
        is_new(mine) ? nlohmann::json::array() : nlohmann::json{label_of(mine)};
    keys.emplace_back("lives_of", only.dump());
    asked = read(with_wishes(source, keys));
  }
  const PosteriorStudy& of_one = require_posterior_study(*asked);
  return described(mine, life_of(mine, of_one, posterior), question, !distribution);
}

}  // namespace wearwell::prognosis
