#include "wearwell/prognosis/unit_life.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <map>
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
#include "wearwell/study/inference_data.h"
#include "wearwell/study/life_levels.h"

// Longer than others: each kind of study tells lives in its own way, and all are one question.

namespace wearwell::prognosis {
namespace {

double probit(double p) {
  return boost::math::quantile(boost::math::normal(), p);
}

// Of a study with one life: that of a joint, or of a new bearing.
UnitLife of_request(const LifeRequest& request, const WeightedDraws& posterior,
                    const LifeQuestion& question) {
  const LifeLaw law = request.law(posterior);
  UnitLife life{.of = request.of.empty() ? "joint" : request.of,
                .at = fmt::format("to {:.6g} {}", request.limit.value, request.limit.unit.text),
                .unit = request.unit_name};
  life.risk = request.risk;
  double from = request.now;
  if (question.survived) {
    const double survived = along_life("--survived", *question.survived, life.unit);
    if (survived < from)
      throw InputError(
          fmt::format("--survived: {} lies before the last inspection, after {:.6g} {}: leave it "
                      "out, what remains counts from there",
                      *question.survived, from, life.unit));
    from = survived;
  }
  life.name = from > 0 ? "remaining life" : "life";
  if (from > 0) life.from = from;
  const double before = from > 0 ? law.cdf(from) : 0;
  if (from > 0) life.passed = before;
  if (before > 1 - 1e-3)
    throw InputError(fmt::format(
        "the {} has reached its limit before {:.6g} {} with a probability of more than 99.9 %: "
        "of what would remain nothing is known",
        life.of, from, life.unit));
  for (const double percent : life_percentages(question.risk.value_or(life.risk))) {
    const double p = percent / 100;
    life.share.push_back(p);
    life.life.push_back(std::max(0.0, law.quantile(before + p * (1 - before)) - from));
  }
  answer(question, life);
  return life;
}

// The lives among what a study asks for, with the B-lives of each.
struct Found {
  QuantityRequest request;
  std::map<double, double> by_percent;  // in its unit
  std::optional<double> survival;
  std::optional<double> never;
};

// So far comes only what has no end.
constexpr const char* for_ever = "1e300 cycles";
constexpr const char* to_for_ever = "survival to 1e+300 cycles";

std::string without_new(const std::string& of) {
  return of.starts_with("new ") ? of.substr(4) : of;
}

std::vector<Found> lives_of(const PosteriorStudy& study, const WeightedDraws& posterior,
                            const std::vector<double>& levels) {
  std::vector<Found> found;
  for (const QuantityGroup& group : study.quantity_groups) {
    const auto& requests = group.requests;
    if (std::none_of(requests.begin(), requests.end(),
                     [](const auto& each) { return each.is_life; }))
      continue;
    const std::vector<QuantityQuantiles> answers = group.from_draws(posterior);
    for (const QuantityRequest& life : requests) {
      if (!life.is_life) continue;
      Found each{life, {}, {}, {}};
      for (std::size_t i = 0; i < requests.size(); ++i) {
        const QuantityRequest& other = requests[i];
        if (other.of != life.of && other.of != without_new(life.of)) continue;
        if (other.name == to_for_ever) {
          each.never = answers[i].predictive;
        } else if (study.model == "law" && other.name.starts_with("survival to ")) {
          each.survival = answers[i].q50;
        }
        if (other.at != life.at || !answers[i].predictive) continue;
        for (const double percent : levels) {
          if (other.name == b_life_name(percent, life.name))
            each.by_percent[percent] = from_si(other.unit, *answers[i].predictive);
        }
      }
      found.push_back(std::move(each));
    }
  }
  return found;
}

Source with_wishes(const Source& source,
                   const std::vector<std::pair<std::string, std::string>>& keys) {
  Source asked = source;
  asked.study = with_predict(source.study, keys);
  return asked;
}

// A bearing study tells the life of a new one unless it is asked for one of its own.
Source of_one_bearing(const Source& source, const LifeQuestion& question) {
  const TomlReader root = TomlReader::parse(source.study);
  if (question.unit.empty() || root.required_text("model") != "bearing-wear") return source;
  const Table table = read_table(root.required_table("data"), source);
  const DataRoles roles = data_roles(root, table);
  if (!roles.unit)
    throw InputError(
        "--unit: the rows of this study do not say which bearing they are of "
        "(data.columns.bearing); "
        "without --unit the life of a new one is told");
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
      fmt::format("--unit: no '{}' is known{} (known: {}; without --unit a new bearing)",
                  question.unit, did_you_mean(question.unit, known), fmt::join(known, ", ")));
}

bool to_a_limit(const Source& source) {
  const TomlReader root = TomlReader::parse(source.study);
  const auto predict = root.table("predict");
  return predict && predict->has("limit");
}

std::string list_of(const std::vector<double>& percents) {
  return fmt::format("[{}]", fmt::join(percents, ", "));
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

// The one that is meant.
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
  // Of a new one both its life and what remains where it has survived so far.
  if (fitting.size() == 2 && fitting[0]->of == fitting[1]->of) return *fitting[1];
  if (fitting.size() == 1) return *fitting[0];
  if (all.empty())
    throw InputError(
        "the study asks for no life: [predict] needs a limit (or, of S-N tests, a stress)");
  const auto once = [](std::vector<std::string>& each) {
    std::sort(each.begin(), each.end());
    each.erase(std::unique(each.begin(), each.end()), each.end());
  };
  once(names);
  once(fresh);
  // Where there is but one kind of new ones nobody has to name it.
  const bool unnamed = fresh.size() == 1;
  std::string known = fmt::format("{}", fmt::join(names, ", "));
  if (!unnamed && !fresh.empty())
    known += fmt::format("{}{}", known.empty() ? "" : ", ", fmt::join(fresh, ", "));
  if (!known.empty()) known = fmt::format("known: {}", known);
  if (unnamed)
    known += fmt::format("{}without --unit a new {}", known.empty() ? "" : "; ", fresh.front());
  if (question.unit.empty())
    throw InputError(fmt::format("--unit is missing: whose life? ({})", known));
  if (!unnamed) names.insert(names.end(), fresh.begin(), fresh.end());
  throw InputError(fmt::format("--unit: no '{}' is known{} ({})", question.unit,
                               did_you_mean(question.unit, names), known));
}

// A unit that was read later than what it is said to have come to counts from its last reading.
void require_ahead(const QuantityRequest& mine, const std::vector<QuantityRequest>& all,
                   const std::string& survived) {
  for (const QuantityRequest& each : all) {
    if (!is_new(each) || each.name != "remaining life" || each.at == mine.at) continue;
    throw InputError(fmt::format(
        "--survived: {} was read beyond {} already: leave it out, what remains counts {}", mine.of,
        survived, mine.at.substr(std::min(mine.at.rfind("from "), mine.at.size()))));
  }
}

// What is known of that one.
const Found& found_of(const QuantityRequest& mine, const std::vector<Found>& all) {
  return *std::find_if(all.begin(), all.end(), [&](const Found& each) {
    return each.request.of == mine.of && each.request.name == mine.name &&
           each.request.at == mine.at;
  });
}

UnitLife described(const Found& found) {
  UnitLife life{.of = found.request.of, .at = found.request.at, .unit = found.request.unit.text};
  life.name = found.request.name;
  double before = 0;
  for (const auto& [percent, value] : found.by_percent) {
    if (std::isnan(value))
      throw InputError(fmt::format("of the {} of {} nothing is known: hardly any comes so far",
                                   life.name, life.of));
    before = std::max(before, value);  // quantiles are solved for, to so many digits
    life.share.push_back(percent / 100);
    life.life.push_back(before);
  }
  if (found.survival) life.passed = 1 - *found.survival;
  constexpr double hardly = 1e-9;
  if (found.never && *found.never > hardly) life.never = *found.never;
  return life;
}

// Of tests to failure at one load: lives are asked for from the beginning, and again of those that are left.
UnitLife of_tests(const Source& source, const ReadAsked& read, const WeightedDraws& posterior,
                  const LifeQuestion& question, UnitLife life) {
  if (!question.survived) return life;
  const double from = along_life("--survived", *question.survived, life.unit);
  const double before = life.cdf(from);
  if (before > 1 - 1e-3)
    throw InputError(
        fmt::format("--survived: hardly any {} comes to {}", life.of, *question.survived));
  std::vector<double> levels, shares;
  for (const double percent : life_percentages(question.risk.value_or(life.risk))) {
    shares.push_back(percent / 100);
    levels.push_back(100 * (before + percent / 100 * (1 - before)));
  }
  const auto asked = read(with_wishes(source, {{"b_lives", list_of(levels)}}));
  if (life.never) *life.never /= 1 - before;
  const std::vector<Found> all = lives_of(require_posterior_study(*asked), posterior, levels);
  const UnitLife again =
      described(found_of(chosen(lives_asked(require_posterior_study(*asked)), question), all));
  life.name = "remaining life";
  life.from = from;
  life.passed = before;
  life.share = shares;
  life.life.clear();
  for (const double each : again.life) life.life.push_back(std::max(0.0, each - from));
  return life;
}

}  // namespace

std::vector<double> life_percentages(double risk) {
  std::vector<double> levels = {0.01, 0.03, 0.1, 0.3, 0.5, 1,  2,    3,    5,
                                7,    93,   95,  97,  98,  99, 99.5, 99.9, 99.99};
  for (int percent = 10; percent <= 90; percent += 5) levels.push_back(percent);
  const double at = 100 * risk;
  if (std::none_of(levels.begin(), levels.end(),
                   [&](double each) { return std::abs(each - at) < 1e-9 * at; }))
    levels.push_back(at);
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

void answer(const LifeQuestion& question, UnitLife& life) {
  life.risk = question.risk.value_or(life.risk);
  life.inspect_within = life.quantile(life.risk);
  if (!question.horizon) return;
  life.horizon = along_life("--horizon", *question.horizon, life.unit);
  life.reached = life.cdf(*life.horizon);
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

double UnitLife::cdf(double until) const {
  const auto above = std::upper_bound(life.begin(), life.end(), until);
  if (above == life.begin()) return 0;  // less than the smallest share
  if (above == life.end()) return share.back();
  const auto i = static_cast<std::size_t>(above - life.begin());
  if (!std::isfinite(life[i])) return share[i - 1];
  const double low = life[i - 1], high = life[i];
  const double part =
      low > 0 ? std::log(until / low) / std::log(high / low) : (until - low) / (high - low);
  return boost::math::cdf(boost::math::normal(),
                          std::lerp(probit(share[i - 1]), probit(share[i]), part));
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
          "--unit: this study is of one joint, called '{}' (data.joint): leave it out. Joints that "
          "wear each at its own pace are a study of model \"law\" with [varies.UNIT]",
          printable(name)));
    return of_request(*study.life, posterior, question);
  }
  const bool law = study.model == "law";
  const double risk = question.risk.value_or(UnitLife{}.risk);
  const std::vector<double> levels = life_percentages(risk);
  std::vector<std::pair<std::string, std::string>> keys = {{"b_lives", list_of(levels)}};
  if (study.model == "sn") keys.emplace_back("survival_to", nlohmann::json(for_ever).dump());
  if (law && question.survived)
    keys.emplace_back("survived", nlohmann::json(*question.survived).dump());
  auto asked = read(with_wishes(source, keys));
  const std::vector<QuantityRequest> requests = lives_asked(require_posterior_study(*asked));
  const QuantityRequest mine = chosen(requests, question);
  if (law && question.survived) require_ahead(mine, requests, *question.survived);
  if (law && to_a_limit(source) && (is_new(mine) || mine.of.find(' ') != std::string::npos)) {
    const nlohmann::json only =
        is_new(mine) ? nlohmann::json::array() : nlohmann::json{label_of(mine)};
    keys.emplace_back("lives_of", only.dump());
    asked = read(with_wishes(source, keys));
  }
  const std::vector<Found> all = lives_of(require_posterior_study(*asked), posterior, levels);
  UnitLife life = described(found_of(mine, all));
  if (!law) life = of_tests(source, read, posterior, question, std::move(life));
  answer(question, life);
  return life;
}

}  // namespace wearwell::prognosis
