#include "wearwell/models/ownlaw/own_predictions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/models/ownlaw/own_life_law.h"
#include "wearwell/models/ownlaw/own_lives.h"
#include "wearwell/models/ownlaw/own_reader.h"

// Longer than others: every answer of a law asks the same nodes and paths.
namespace wearwell::ownlaw {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string in_words(const Quantity& quantity) {
  return quantity.unit.text == "1" ? fmt::format("{:.6g}", quantity.value)
                                   : fmt::format("{:.6g} {}", quantity.value, quantity.unit.text);
}

std::string joined(const std::string& a, const std::string& b) {
  return a.empty() ? b : b.empty() ? a : a + ", " + b;
}

// A path for any thread.
class SharedPath {
 public:
  explicit SharedPath(std::shared_ptr<const Path> path) : path_(std::move(path)) {}
  PathAt& mine() const {
    std::unique_ptr<PathAt>& own = own_.local();
    if (!own) own = std::make_unique<PathAt>(*path_);
    return *own;
  }

 private:
  std::shared_ptr<const Path> path_;
  mutable tbb::enumerable_thread_specific<std::unique_ptr<PathAt>> own_;
};

class Predictions {
 public:
  Predictions(const TomlReader& predict, std::shared_ptr<const OwnLaw> law,
              std::shared_ptr<const OwnRows> rows, PosteriorStudy& study)
      : predict_(predict), law_(std::move(law)), rows_(std::move(rows)), study_(study) {
    if (const auto given = predict.table("given")) given_ = read_conditions(*given, *law_);
    given_words_ = given_.words;
    common_ = common_conditions(*law_, given_);
    noun_ = law_->label.value_or(
        law_->symbols.labels.size() == 1 ? law_->symbols.labels.front().name : std::string("unit"));
    for (const Parameter& each : law_->parameters) start_.push_back(each.start);
  }

  void read() {
    const bool asks_along = predict_.has("at") || predict_.has("limit");
    if (asks_along && !law_->along) {
      predict_.fail(predict_.has("limit") ? "limit" : "at",
                    "needs predict.along: the column that is the axis of wear and life");
    }
    level_ = 0.9;
    if (const auto level = predict_.quantity("credible_level", "1")) {
      if (!(level->si() > 0 && level->si() < 1)) {
        predict_.fail("credible_level", "must lie between 0 and 1");
      }
      level_ = level->si();
    }
    if (predict_.has("at")) read_at();
    if (predict_.has("limit")) {
      read_limit();
      for (const char* key : {"b_lives", "survival_to", "hazard_at", "accelerated"}) {
        if (predict_.has(key)) {
          predict_.fail(key,
                        "is for a likelihood of a life; beside predict.limit lives are "
                        "those to the limit");
        }
      }
    } else if (!law_->along) {
      read_life_law();
    }
    read_quantities();
  }

 private:
  QuantityRequest request(const std::string& name, const std::string& of, const std::string& at,
                          const Unit& unit) const {
    return {name, of, at, unit, true, false, {}, {}, {}};
  }

  // ---- Measurements to come along the axis.

  void read_at() {
    const NumberColumn& axis = *law_->data.number(*law_->along);
    const std::string si = law::si_text(axis.unit.powers);
    const double most = *std::max_element(axis.values.begin(), axis.values.end());
    for (const Quantity& at : predict_.quantities("at", si)) {
      for (const Measured& measured : law_->measured) add_measurement(measured, axis, at);
      study_.reaches.push_back(
          {fmt::format("the prediction at {} of {}", in_words(at), *law_->along),
           fmt::format("the largest {} of the data is {:.4g} {}", *law_->along,
                       from_si(axis.unit.unit, most), axis.unit.unit.text),
           at.si(), most});
    }
  }

  void add_measurement(const Measured& measured, const NumberColumn& axis, const Quantity& at) {
    const ResponseFamily family = measured.form->family;
    const bool normal = family == ResponseFamily::normal;
    const bool known = normal || family == ResponseFamily::lognormal ||
                       family == ResponseFamily::lognormal_by_moments;
    if (!known) {
      predict_.fail("at", fmt::format("measurements to come are predicted of the normal and the "
                                      "lognormal family, not of {}",
                                      measured.form->name));
    }
    if (law_->effects.size() > 1) {
      predict_.fail("at",
                    "measurements to come are predicted where one parameter varies, not two; "
                    "lives (predict.limit) are for both");
    }
    const auto path = std::make_shared<const SharedPath>(
        make_path(law_, predict_, "at", measured.wanted, true, common_));
    const double place = at.si();
    // The mean and standard deviation of the column itself.
    const auto moments = [=](const double* x, double z) {
      PathAt& mine = path->mine();
      mine.move_to(x);
      mine.evaluate(1, &z, &place);
      double mean = mine.output(0, 0), sd = mine.output(1, 0);
      if (family == ResponseFamily::lognormal) {
        mean *= std::exp(0.5 * sd * sd);
        sd = mean * std::sqrt(std::expm1(sd * sd));
      }
      return std::pair(mean, sd);
    };
    PredictionRequest prediction{*law_->along,
                                 from_si(axis.unit.unit, place),
                                 measured.column,
                                 measured.unit,
                                 [=](const double* x) { return moments(x, 0).first; },
                                 [=](const double* x) { return moments(x, 0).second; },
                                 normal ? ObservationFamily::normal : ObservationFamily::lognormal,
                                 {}};
    if (law_->varies()) {
      prediction.item = [=](const double* x, double z) { return moments(x, z).first; };
      prediction.mean_of = "median " + noun_;
      prediction.measured_of = "new " + noun_;
    }
    study_.predictions.push_back(std::move(prediction));
  }

  // ---- Lives to a limit.

  void read_limit() {
    const TomlReader limits = predict_.required_table("limit");
    const std::vector<std::string> names = limits.keys();
    if (names.size() != 1) {
      limits.fail(names.empty() ? "" : names[1],
                  "one limit at a time: limit = { wear = \"100 um\" }");
    }
    const std::string& name = names.front();
    const NumberColumn& axis = *law_->data.number(*law_->along);
    std::vector<law::Wanted> wanted = {{"[predict] limit", name}};
    auto path = std::make_shared<LimitedPath>();
    path->next = make_path(law_, limits, name, wanted, true, common_);
    const law::Powers powers = path->next->program.outputs()[0].powers;
    const Quantity limit = limits.required_quantity(name, law::si_text(powers));
    path->limit = limit.si();
    const double least = *std::min_element(axis.values.begin(), axis.values.end());
    const double most = *std::max_element(axis.values.begin(), axis.values.end());
    path->begin = std::min(0.0, least);
    path->scale = most > path->begin ? most - path->begin : 1;
    require_monotone(limits, name, *path, axis);
    add_seen(limits, name, wanted, axis, *path);
    request_lives(name, limit, axis, std::move(path));
  }

  // At the values where searches start, from the beginning to twice the last row.
  void require_monotone(const TomlReader& limits, const std::string& name, LimitedPath& path,
                        const NumberColumn& axis) const {
    constexpr std::size_t points = 64;
    PathAt at(*path.next);
    at.move_to(start_.data());
    std::vector<double> place, value;
    for (std::size_t i = 1; i <= points; ++i) {
      place.push_back(path.begin + 2 * path.scale * static_cast<double>(i) / points);
    }
    at.evaluate(points, nullptr, place.data());
    double size = 0;
    for (std::size_t i = 0; i < points; ++i) {
      value.push_back(at.output(0, i));
      size = std::max(size, std::abs(value[i]));
    }
    path.rising = value.back() >= value.front();
    for (std::size_t i = 1; i < points; ++i) {
      const double step = value[i] - value[i - 1];
      if ((path.rising ? step : -step) >= -1e-9 * size) continue;
      limits.fail(
          name, fmt::format("{} first {} and then {} with {} (near {:.4g} {}): when it "
                            "reaches a limit is not one life",
                            name, path.rising ? "grows" : "falls", path.rising ? "falls" : "grows",
                            *law_->along, from_si(axis.unit.unit, place[i]), axis.unit.unit.text));
    }
    if (value.back() == value.front()) {
      limits.fail(name, fmt::format("{} does not change with {}: it never reaches a limit", name,
                                    *law_->along));
    }
  }

  const LabelColumn* unit_label() const {
    if (law_->label) return law_->data.label(*law_->label);
    return law_->symbols.labels.size() == 1 ? law_->data.label(law_->symbols.labels.front().name)
                                            : nullptr;
  }

  void add_seen(const TomlReader& limits, const std::string& name,
                const std::vector<law::Wanted>& wanted, const NumberColumn& axis,
                LimitedPath& path) const {
    if (!law_->label) return;
    for (std::size_t u = 0; u < law_->units.size(); ++u) {
      const Conditions own = conditions_of_unit(*law_, u, {});
      const Conditions ahead = conditions_of_unit(*law_, u, given_);
      LimitedPath::Seen seen;
      seen.ahead = make_path(law_, limits, name, wanted, true, ahead);
      const bool same = [&] {
        for (std::size_t c = 0; c < seen.ahead->symbols.columns.size(); ++c) {
          if (!seen.ahead->program.uses_column(c)) continue;
          const std::string& column = seen.ahead->symbols.columns[c].name;
          if (own.numbers.at(column) != ahead.numbers.at(column)) return false;
        }
        for (std::size_t c = 0; c < seen.ahead->symbols.labels.size(); ++c) {
          if (!seen.ahead->program.uses_label(c)) continue;
          const std::string& column = seen.ahead->symbols.labels[c].name;
          if (own.labels.at(column) != ahead.labels.at(column)) return false;
        }
        return true;
      }();
      if (!same) seen.behind = make_path(law_, limits, name, wanted, true, own);
      seen.now = -infinity;
      for (std::size_t row = 0; row < law_->data.table.rows; ++row) {
        if (law_->unit_of_row[row] == u) seen.now = std::max(seen.now, axis.values[row]);
      }
      path.seen.push_back(std::move(seen));
    }
  }

  void request_lives(const std::string& name, const Quantity& limit, const NumberColumn& axis,
                     std::shared_ptr<const LimitedPath> path) {
    const std::string at = joined(fmt::format("to {} = {}", name, in_words(limit)), given_words_);
    QuantityGroup group;
    group.requests.push_back(request("life", "new " + noun_, at, axis.unit.unit));
    for (std::size_t u = 0; u < path->seen.size(); ++u) {
      group.requests.push_back(
          request("remaining life", noun_ + " " + law_->units[u],
                  fmt::format("{} from {:.6g} {} on", at,
                              from_si(axis.unit.unit, path->seen[u].now), axis.unit.unit.text),
                  axis.unit.unit));
    }
    for (QuantityRequest& each : group.requests) {
      each.is_life = true;
      each.safe_end = 0.05;
    }
    group.from_draws = [rows = rows_, path](const WeightedDraws& draws) {
      const LimitedLives lives = limited_lives(*rows, *path, draws);
      std::vector<QuantityQuantiles> all;
      const auto add = [&](const CellMixture& life) {
        const auto q = [&](double p) { return life.mass() > 1e-6 ? life.quantile(p) : 0; };
        const double middle = q(0.5);
        all.push_back({q(0.05), middle, q(0.95), q(0.01), q(0.1), middle});
      };
      add(lives.next);
      for (const CellMixture& each : lives.remaining) add(each);
      return all;
    };
    study_.quantity_groups.push_back(std::move(group));
  }

  // ---- Lives of which the likelihood is.

  std::shared_ptr<const LifeLaw> life_law(const Measured& measured, const char* key,
                                          const Conditions& conditions) const {
    return std::make_shared<const LifeLaw>(
        make_path(law_, predict_, key, measured.wanted, false, conditions), measured);
  }

  void read_life_law() {
    const Measured& measured = law_->measured.front();
    std::vector<double> percents;
    for (const Quantity& each : predict_.quantities("b_lives", "1")) {
      const double value = each.unit.text == "1" ? each.value : 100 * each.si();
      if (!(value > 0 && value < 100)) {
        predict_.fail("b_lives", "are percentages between 0 and 100, like [1, 10]");
      }
      percents.push_back(value);
    }
    if (percents.empty()) percents = {1, 10};
    const std::string si = law::si_text(measured.powers);
    const std::vector<Quantity> survival = predict_.quantities("survival_to", si);
    const std::vector<Quantity> hazard = predict_.quantities("hazard_at", si);
    if (measured.form->counted) {
      for (const char* key : {"b_lives", "survival_to", "hazard_at", "accelerated"}) {
        if (predict_.has(key)) predict_.fail(key, "is for lives, not for counts");
      }
      return;
    }
    const auto life = life_law(measured, predict_.has("given") ? "given" : "", common_);
    std::shared_ptr<const LifeLaw> fast;
    std::string fast_words;
    if (const auto accelerated = predict_.table("accelerated")) {
      const Conditions conditions = read_conditions(*accelerated, *law_);
      fast_words = conditions.words;
      fast = life_law(measured, "accelerated", common_conditions(*law_, conditions));
    }
    QuantityGroup group;
    const std::string what = measured.form->positive ? "life" : measured.column;
    group.requests.push_back(request(what, "new " + noun_, given_words_, measured.unit));
    group.requests.back().is_life = true;
    group.requests.back().safe_end = 0.05;
    const auto bounded = [&](const std::string& name, const std::string& at, const Unit& unit) {
      group.requests.push_back(request(name, noun_, at, unit));
      group.requests.back().credible_level = level_;
      group.requests.back().safe_end = 0.05;
    };
    for (const double percent : percents) {
      bounded(fmt::format("B{:.6g} life", percent), given_words_, measured.unit);
    }
    for (const Quantity& each : survival) {
      bounded("survival to " + in_words(each), given_words_, Unit{"%", 0.01, 0});
    }
    const Unit rate{per_unit(measured.unit), 1 / measured.unit.scale, 0};
    for (const Quantity& each : hazard) {
      group.requests.push_back(request("hazard at " + in_words(each), noun_, given_words_, rate));
    }
    if (fast) {
      group.requests.push_back(request("acceleration factor", noun_,
                                       fmt::format("{} over {}", given_words_, fast_words),
                                       Unit{"1", 1, 0}));
    }
    group.from_draws = [=, level = level_](const WeightedDraws& draws) {
      const LifeLaw::Next next = life->next(draws);
      const double middle = next.quantile(0.5);
      std::vector<QuantityQuantiles> all = {{next.quantile(0.05), middle, next.quantile(0.95),
                                             next.quantile(0.01), next.quantile(0.1), middle}};
      const auto add = [&](const Distribution& known, std::optional<double> predictive) {
        QuantityQuantiles q{
            known.quantile(0.05), known.quantile(0.5), known.quantile(0.95), 0, 0, 0};
        if (predictive) {
          q.predictive = predictive;
          q.bound = known.quantile(1 - level);
        }
        all.push_back(q);
      };
      for (const double percent : percents) {
        add(life->quantile(draws, percent / 100), next.quantile(percent / 100));
      }
      for (const Quantity& each : survival) {
        add(life->survival(draws, each.si()), 1 - next.cdf(each.si()));
      }
      for (const Quantity& each : hazard) add(life->hazard(draws, each.si()), {});
      if (fast) add(life->ratio(draws, *fast), {});
      return all;
    };
    study_.quantity_groups.push_back(std::move(group));
  }

  // ---- Functions of the parameters.

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
      const law::Wanted wanted{"[predict.quantities] " + name, text, {}, {}, true};
      const auto program = std::make_shared<const law::Program>(
          compile_at(*table, name, law_->lines, wanted, law_->symbols));
      const law::Powers& powers = program->outputs()[0].powers;
      Unit shown{powers.empty() ? "1" : law::in_words(powers), 1, 0};
      if (unit) {
        try {
          const law::AnyUnit own = law::read_any_unit(*unit);
          if (own.powers != powers) {
            throw InputError(fmt::format("'{}' is {}, but {} is {}", *unit,
                                         law::in_words(own.powers), name, law::in_words(powers)));
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
    }
  }

  Function function_of(std::shared_ptr<const law::Program> program) const {
    struct Own {
      law::Data data;
      law::Workspace workspace;
    };
    auto own = std::make_shared<tbb::enumerable_thread_specific<std::unique_ptr<Own>>>();
    const std::size_t size = law_->parameters.size();
    const std::size_t columns = law_->symbols.columns.size(), labels = law_->symbols.labels.size();
    return [=](const double* x) {
      std::unique_ptr<Own>& mine = own->local();
      if (!mine) {
        law::Rows rows;
        rows.count = 1;
        rows.columns.resize(columns);
        rows.labels.resize(labels);
        mine.reset(new Own{program->bind(rows), program->workspace(1)});
      }
      program->forward(mine->data, 0, 1, {{x, size}, {}}, mine->workspace);
      return mine->workspace.values(0)[0];
    };
  }

  const TomlReader& predict_;
  std::shared_ptr<const OwnLaw> law_;
  std::shared_ptr<const OwnRows> rows_;
  PosteriorStudy& study_;
  Conditions given_, common_;
  std::string given_words_, noun_;
  std::vector<double> start_;
  double level_ = 0.9;
};

}  // namespace

void read_own_predictions(const TomlReader& root, std::shared_ptr<const OwnLaw> law,
                          std::shared_ptr<const OwnRows> rows, PosteriorStudy& study) {
  if (const auto predict = root.table("predict")) {
    Predictions(*predict, std::move(law), std::move(rows), study).read();
  }
}

}  // namespace wearwell::ownlaw
