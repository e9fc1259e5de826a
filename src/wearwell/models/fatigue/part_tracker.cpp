#include "wearwell/models/fatigue/part_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/fatigue/part_reading.h"
#include "wearwell/models/fatigue/sn_parameters.h"
#include "wearwell/models/fatigue/sn_predictions.h"
#include "wearwell/models/fatigue/sn_study.h"
#include "wearwell/models/fatigue/stress_lives.h"
#include "wearwell/prognosis/unit_state.h"

namespace wearwell::fatigue {
namespace {

using prognosis::Forecast;
using prognosis::Reading;

// Of the posterior; more points if life is either finite or infinite at each of them.
constexpr std::size_t points = 1000, points_at_a_limit = 4000;
// probability of surviving so far: below it the reading contradicts
constexpr double hardly_possible = 1e-4;
constexpr double same_stress = 1e-6;      // relative
constexpr double undefined_share = 1e-8;  // of the posterior, where the model has no life
constexpr std::string_view part_mark = "wearwell part 1";

bool alike(const Stress& a, const Stress& b) {
  const double size = std::max(std::abs(a.alternating), std::abs(b.alternating));
  return std::abs(a.alternating - b.alternating) <= same_stress * size &&
         std::abs(a.mean - b.mean) <= same_stress * size;
}

// The parts common to all tracked parts.
struct Parts {
  SnLaw law;
  SnData data;
  PartReading reading;
  ThinnedPosterior few;
  std::optional<Stress> ahead;             // of a part without readings
  std::vector<std::string> seen;           // run-outs
  std::map<std::string, std::size_t> row;  // of each part of the study
  std::string fingerprint;

  Parts(const TomlReader& root, const prognosis::CarriedState& state)
      : law(read_sn_law(root)),
        data(read_sn_data(root, state.source, law.correction)),
        reading(root, data, law.correction),
        few(state.posterior, law.bends() && !law.limit ? points_at_a_limit : points),
        ahead(reading.only()),
        fingerprint(prognosis::population_fingerprint(state)) {
    for (std::size_t i = 0; i < data.parts.size(); ++i) {
      row[data.parts[i]] = i;
      if (data.tests[i].outcome == Outcome::runout) seen.push_back(data.parts[i]);
    }
    const auto predict = root.table("predict");
    const auto stresses = predict ? predict->table("stress") : std::nullopt;
    if (!ahead && stresses && stresses->keys().size() == 1)
      ahead = read_stress(stresses->required_table(stresses->keys().front()), law.correction,
                          data.spring, data.stress_si);
  }

  // Tables of a few stresses are cached; this does not change results.
  std::shared_ptr<const StressLives> lives(const Stress& stress) const {
    constexpr std::size_t most = 32;
    const std::lock_guard lock(lock_);
    const std::pair key(stress.alternating, stress.mean);
    auto at = lives_.find(key);
    if (at == lives_.end()) {
      if (lives_.size() >= most) lives_.clear();
      at = lives_.emplace(key, std::make_shared<const StressLives>(law, few, stress)).first;
    }
    return at->second;
  }

  std::string refusal(const std::string& part) const {
    const auto at = row.find(part);
    if (at == row.end() || data.tests[at->second].outcome == Outcome::runout) return {};
    return fmt::format("'{}' is row {} of {}, where it failed: no life remains", printable(part),
                       at->second + 1, data.source);
  }

 private:
  mutable std::mutex lock_;
  mutable std::map<std::pair<double, double>, std::shared_ptr<const StressLives>> lives_;
};

using SharedParts = std::shared_ptr<const Parts>;

class PartUnit final : public prognosis::TrackedUnit {
 public:
  PartUnit(SharedParts parts, std::string name) : parts_(std::move(parts)), name_(std::move(name)) {
    const auto at = parts_->row.find(name_);
    refusal_ = parts_->refusal(name_);
    if (!refusal_.empty()) return;
    if (at == parts_->row.end()) {
      stress_ = parts_->ahead;
      return;
    }
    const LifeTest& test = parts_->data.tests[at->second];
    stress_ = test.stress;
    bound_ = true;
    known_ = now_ = test.life;
  }

  prognosis::UpdateResult update(const Reading& reading,
                                 const prognosis::History& history) override;
  Forecast forecast() const override;
  std::vector<prognosis::PredictiveTails> predictive(const Reading& reading) const override;
  std::vector<prognosis::ForecastBand> ahead(std::span<const double> places) const override;
  std::optional<prognosis::InPopulations> in_populations(
      const prognosis::History& history) const override;
  std::size_t readings() const override { return readings_; }
  std::string save() const override;
  void load(prognosis::ByteReader& from);

 private:
  bool is_known() const { return refusal_.empty() && stress_.has_value(); }
  std::string problem_of(const Reading& reading, double& cycles,
                         std::optional<Stress>& stress) const;
  // Weights of the posterior's points for a part that survived n; they sum to `survival`.
  std::vector<double> weights(const StressLives& lives, double n, double& survival) const;

  SharedParts parts_;
  std::string name_, refusal_;
  std::optional<Stress> stress_;
  bool bound_ = false;          // the stress is its own, not that of future parts
  double known_ = 0, now_ = 0;  // cycles: known from the study, and now
  std::size_t readings_ = 0;
};

std::string PartUnit::problem_of(const Reading& reading, double& cycles,
                                 std::optional<Stress>& stress) const {
  if (reading.numbers.size() != parts_->reading.columns().size() || !reading.labels.empty())
    throw InputError(fmt::format("a reading has {} numbers and {} labels; expected are {} and 0",
                                 reading.numbers.size(), reading.labels.size(),
                                 parts_->reading.columns().size()));
  if (!refusal_.empty()) return refusal_;
  std::string problem = parts_->reading.read(reading.numbers, cycles, stress);
  if (!problem.empty()) return problem;
  if (!stress) stress = stress_;
  if (!stress) return "alternating_stress is missing, or other columns that give it";
  if (bound_ && !alike(*stress, *stress_))
    return fmt::format(
        "it runs under {}, but earlier under {}: life under a changing stress is a sum of damage "
        "(wearwell fatigue life)",
        description(parts_->law, parts_->data, *stress),
        description(parts_->law, parts_->data, *stress_));
  return {};
}

std::vector<double> PartUnit::weights(const StressLives& lives, double n, double& survival) const {
  std::vector<double> weight = lives.log_survival(n, known_);
  survival = 0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    weight[i] = parts_->few.weights[i] * std::exp(weight[i]);
    survival += weight[i];
  }
  return weight;
}

prognosis::UpdateResult PartUnit::update(const Reading& reading, const prognosis::History&) {
  prognosis::UpdateResult taken;
  double cycles = 0;
  std::optional<Stress> stress;
  taken.problem = problem_of(reading, cycles, stress);
  if (!taken.problem.empty()) return taken;
  taken.p_value = 1;  // for a reading with less information than is known
  if (cycles > now_) {
    const auto lives = parts_->lives(*stress);
    double before = 0, after = 0;
    weights(*lives, now_, before);
    weights(*lives, cycles, after);
    if (!(after > 0)) {
      taken.problem = "no part of the population survives so long under that stress";
      taken.impossible = true;
      taken.tails = {{1, 0}};
      return taken;
    }
    taken.p_value = std::min(1.0, after / before);
    taken.tails = {{1, taken.p_value}};  // it fails later: all that is known
    now_ = cycles;
  }
  stress_ = stress;
  bound_ = true;
  ++readings_;
  taken.counted = true;
  taken.contradicts = taken.p_value < hardly_possible;
  return taken;
}

std::vector<prognosis::PredictiveTails> PartUnit::predictive(const Reading& reading) const {
  double cycles = 0;
  std::optional<Stress> stress;
  if (!problem_of(reading, cycles, stress).empty() || !(cycles > now_)) return {};
  const auto lives = parts_->lives(*stress);
  double before = 0, after = 0;
  weights(*lives, now_, before);
  weights(*lives, cycles, after);
  return {{1, std::min(1.0, after / before)}};
}

// The share of its life that a part has used at a given life: small for long lives.
prognosis::ForecastBand used(const prognosis::WeightedLives& remaining, double now, double at) {
  const auto level = [&](double p) { return at > 0 ? at / (now + remaining.quantile(p)) : 0; };
  return {at, level(0.95), level(0.5), level(0.05)};
}

Forecast PartUnit::forecast() const {
  Forecast forecast;
  const auto lives = is_known() ? parts_->lives(*stress_) : nullptr;
  if (!lives || (now_ == 0 && lives->undefined() > undefined_share)) {
    forecast.now = now_;
    forecast.level05 = forecast.level50 = forecast.level95 = forecast.passed =
        std::numeric_limits<double>::quiet_NaN();
    return forecast;
  }
  double sum = 0, square = 0;
  const std::vector<double> weight = weights(*lives, now_, sum);
  for (const double each : weight) square += each * each;
  forecast.effective = sum * sum / square;
  forecast.now = now_;
  forecast.remaining = lives->remaining(weight, now_);
  const prognosis::ForecastBand level = used(forecast.remaining, now_, now_);
  forecast.level05 = level.level05;
  forecast.level50 = level.level50;
  forecast.level95 = level.level95;
  return forecast;
}

std::vector<prognosis::ForecastBand> PartUnit::ahead(std::span<const double> places) const {
  if (!places.empty() && places.front() < now_)
    throw std::invalid_argument("a forecast must start at the unit's present position");
  const Forecast now = forecast();
  std::vector<prognosis::ForecastBand> path;
  if (std::isnan(now.passed)) return path;
  for (const double at : places) path.push_back(used(now.remaining, now_, at));
  return path;
}

std::optional<prognosis::InPopulations> PartUnit::in_populations(const prognosis::History&) const {
  if (!is_known()) return {};
  const auto lives = parts_->lives(*stress_);
  if (now_ == 0 && lives->undefined() > undefined_share) return {};
  prognosis::InPopulations apart;
  apart.log_likelihood = lives->log_survival(now_, known_);
  const std::size_t count = apart.log_likelihood.size();
  apart.passed.assign(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> one(count, 0.0);
    one[i] = 1;
    apart.remaining.push_back(lives->remaining(one, now_));
  }
  return apart;
}

std::string PartUnit::save() const {
  prognosis::ByteWriter to = prognosis::unit_state(part_mark, parts_->fingerprint);
  to.text(name_);
  to.u64(readings_);
  to.number(now_);
  to.byte(bound_);
  to.number(bound_ ? stress_->alternating : 0);
  to.number(bound_ ? stress_->mean : 0);
  return prognosis::signed_unit_state(std::move(to));
}

void PartUnit::load(prognosis::ByteReader& from) {
  readings_ = from.u64();
  now_ = from.number();
  const bool bound = from.flag();
  const Stress stress{from.number(), from.number()};
  from.end();
  if (!(now_ >= known_ && std::isfinite(now_))) from.fail("its number of cycles is not a number");
  if (!bound) return;
  if (!(stress.alternating > 0 && std::isfinite(stress.alternating) && std::isfinite(stress.mean)))
    from.fail("its stress is not a number");
  stress_ = stress;
  bound_ = true;
}

class PartTracker final : public prognosis::Tracker {
 public:
  explicit PartTracker(SharedParts parts) : parts_(std::move(parts)) {}

  std::span<const prognosis::ReadingColumn> columns() const override {
    return parts_->reading.columns();
  }
  std::span<const std::string> labels() const override { return {}; }
  const prognosis::ReadingColumn& axis() const override {
    return parts_->reading.columns().front();
  }
  const std::string& limited() const override { return limited_; }
  const Quantity& limit() const override { return limit_; }
  bool rising() const override { return true; }
  const std::string& noun() const override { return noun_; }
  double probability_error() const override { return 0.004; }
  std::vector<double> populations() const override { return parts_->few.weights; }
  std::span<const std::string> seen() const override { return parts_->seen; }
  std::string refusal(const std::string& unit) const override { return parts_->refusal(unit); }
  std::string problem(const Reading& reading) const override {
    double cycles = 0;
    std::optional<Stress> stress;
    return parts_->reading.read(reading.numbers, cycles, stress);
  }

  std::unique_ptr<prognosis::TrackedUnit> begin(const std::string& unit) const override {
    return std::make_unique<PartUnit>(parts_, unit);
  }

  std::unique_ptr<prognosis::TrackedUnit> restore(const std::string& bytes) const override {
    prognosis::ByteReader from = prognosis::read_unit_state(bytes, part_mark, parts_->fingerprint);
    auto unit = std::make_unique<PartUnit>(parts_, from.text());
    unit->load(from);
    return unit;
  }

 private:
  SharedParts parts_;
  std::string limited_ = "used life", noun_ = "part";
  Quantity limit_{1, Unit{"1", 1, 0}};
};

}  // namespace

std::unique_ptr<const prognosis::Tracker> track_parts(const prognosis::CarriedState& state) {
  const TomlReader root = TomlReader::parse(state.source.study);
  auto parts = std::make_shared<const Parts>(root, state);
  std::vector<std::string> names;
  for (const Parameter& each : sn_parameters(root, parts->law, parts->data))
    names.push_back(each.name);
  prognosis::require_parameters(state, names);
  return std::make_unique<const PartTracker>(std::move(parts));
}

}  // namespace wearwell::fatigue
