#include "wearwell/prognosis/factor_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "wearwell/math/log_sum_exp.h"
#include "wearwell/prognosis/change_cause.h"
#include "wearwell/prognosis/reading_bytes.h"

namespace wearwell::prognosis {
namespace {

constexpr double excludes = 0.1;          // two-sided p-value of a reading of 0
constexpr std::uint64_t most_seen = 100;  // readings; later ones are not tested
const double nearer = std::log(10), farther = std::log(0.01);
const double begins = std::log(1e4), none = std::log(1e-6);

Reading multiplied(Reading reading, std::size_t column, std::size_t factor) {
  reading.numbers[column] *= unit_factors()[factor];
  return reading;
}

// The log probability of a reading within a thousandth of its value, so small that the ratio of two
// of them is that of the densities; NaN if nothing predicts it.
double log_probability(const TrackedUnit& unit, Reading reading, std::size_t column) {
  constexpr double part = 1e-3;
  const double value = reading.numbers[column], half = part * std::abs(value);
  reading.numbers[column] = value - half;
  const std::vector<PredictiveTails> low = unit.predictive(reading);
  reading.numbers[column] = value + half;
  const std::vector<PredictiveTails> high = unit.predictive(reading);
  if (low.size() != 1 || high.size() != 1) return std::nan("");
  const bool lower = high.front().below < high.front().above;
  return std::log(std::max(0.0, lower ? high.front().below - low.front().below
                                      : low.front().above - high.front().above));
}

}  // namespace

bool FactorTest::is_alive(const Other& other) {
  return other.log_evidence > none;
}

// As the readings so far leave it.
void FactorTest::begin(Other& other, std::size_t factor, const Tracker& tracker, std::size_t column,
                       const std::string& name) {
  if (other.unit) return;
  other.unit = tracker.begin(name);
  for (std::size_t k = 0; k < taken_.size(); ++k)
    other.unit->update(multiplied(taken_[k], column, factor), readings(column, factor, k));
}

void FactorTest::add(const Tracker& tracker, const WatchedColumns& columns, const std::string& name,
                     const TrackedUnit& unit, const Reading& reading, double added) {
  if (ended_ || !columns.measured) return;
  const std::size_t column = *columns.measured;
  const double value = reading.numbers[column];
  if (std::isnan(value)) return;
  ended_ = ++seen_ > most_seen || added != 0;
  Reading watched = alone(tracker, columns, reading);
  const std::unique_ptr<TrackedUnit> fresh = tracker.begin(name);
  watched.numbers[column] = 0;
  // A family of positive values has no 0.
  if (ended_ || value == 0 || two_sided(fresh->predictive(watched)) >= excludes) return;
  watched.numbers[column] = value;
  const double as_is = log_probability(unit, watched, column);
  const double as_new = log_probability(*fresh, watched, column);
  if (!std::isfinite(as_is)) return;
  const bool any = std::any_of(others_.begin(), others_.end(), [&](const Other& other) {
    return is_alive(other) && other.is_nearer;
  });
  for (std::size_t i = 0; i < count; ++i) {
    Other& other = others_[i];
    if (!is_alive(other)) continue;
    const Reading other_reading = multiplied(watched, column, i);
    if (other.is_nearer) {
      begin(other, i, tracker, column, name);
      other.log_evidence += log_probability(*other.unit, other_reading, column) - as_is;
    }
    if (other.unit) other.unit->update(other_reading, readings(column, i, taken_.size()));
    const double level = log_probability(*fresh, other_reading, column) - as_new;
    other.is_nearer = level >= nearer;
    if (level > farther && is_alive(other)) continue;
    other.log_evidence = -std::numeric_limits<double>::infinity();  // also in place of NaN
    other.unit.reset();
  }
  if (any || !taken_.empty()) taken_.push_back(watched);
  judge(tracker, column, value);
}

History FactorTest::readings(std::size_t column, std::size_t factor, std::size_t until) const {
  return [this, column, factor, until](const std::function<void(const Reading&)>& visit) {
    for (std::size_t k = 0; k < until; ++k) visit(multiplied(taken_[k], column, factor));
  };
}

void FactorTest::judge(const Tracker& tracker, std::size_t column, double last) {
  std::array<double, count> logs{};
  std::transform(others_.begin(), others_.end(), logs.begin(),
                 [](const Other& other) { return other.log_evidence; });
  const double evidence = log_sum_exp(logs) - std::log(count);
  const bool is_found = evidence >= begins;
  ended_ = is_found || std::none_of(others_.begin(), others_.end(), is_alive);
  if (!ended_) return;
  taken_.clear();
  for (Other& other : others_) other.unit.reset();
  if (!is_found) return;
  const auto best = std::max_element(logs.begin(), logs.end()) - logs.begin();
  const double factor = unit_factors()[static_cast<std::size_t>(best)];
  const ReadingColumn& measured = tracker.columns()[column];
  reason_ = fmt::format(
      "the readings, such as {} of {}, fit a {} of the study after multiplication by {}: {}",
      measured.name, reading_text(last, measured.unit), tracker.noun(), factor_text(factor),
      wrong_unit(factor));
}

void FactorTest::save(ByteWriter& to) const {
  to.byte(ended_);
  to.u64(seen_);
  to.u64(count);
  for (const Other& other : others_) {
    to.number(other.log_evidence);
    to.byte(other.is_nearer);
  }
  to.u64(taken_.size());
  for (const Reading& each : taken_) prognosis::save(to, each);
  to.text(reason_);
}

void FactorTest::load(ByteReader& from, const Tracker& tracker) {
  ended_ = from.flag();
  seen_ = from.u64();
  if (from.u64() != count) from.fail("of another version");
  for (Other& other : others_) {
    other = {};
    other.log_evidence = from.number();
    other.is_nearer = from.flag();
  }
  taken_.clear();
  for (std::size_t left = from.count(1); left > 0; --left)
    taken_.push_back(read_reading(from, tracker));
  reason_ = from.text();
}

}  // namespace wearwell::prognosis
