#include "wearwell/prognosis/change_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/prognosis/predicted_reading.h"
#include "wearwell/prognosis/reading_bytes.h"

namespace wearwell::prognosis {
namespace {

constexpr std::size_t most_since = 12;             // readings from which a cause is found
constexpr std::uint64_t longest_history = 20'000;  // that is taken again for a reference
constexpr double stuck = 20;                       // evidence of repeats
constexpr double agrees = 0.01;                    // two-sided p-value of a reading that does
constexpr std::uint64_t agreeing_enough = 3;       // readings in a row

/// The coarsest step of a decimal scale that a value can come from: 2 for 6, 0.5 for 6.5.
double decimal_step(double value) {
  value = std::abs(value);
  if (!(value > 0)) return std::numeric_limits<double>::infinity();
  constexpr int digits = 12;
  const int top = static_cast<int>(std::floor(std::log10(value)));
  for (int power = top; power > top - digits; --power) {
    for (const double first : {5.0, 2.5, 2.0, 1.0}) {
      const double step = first * std::pow(10.0, power), count = value / step;
      constexpr double rounding = 1e-9;
      if (count > 0.5 && std::abs(count - std::round(count)) < rounding * count) return step;
    }
  }
  return value * std::pow(10.0, -digits);
}

bool is_of_kind(const Unit& unit, const std::string& like) {
  try {
    read_unit(unit.text, like);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

WatchedColumns watched_columns(const Tracker& tracker) {
  WatchedColumns watched;
  const auto columns = tracker.columns();
  std::size_t measured = 0;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].name == tracker.axis().name) watched.axis = i;
    if (!columns[i].measured) continue;
    ++measured;
    watched.measured = i;
    if (is_of_kind(columns[i].unit, tracker.limit().unit.text) &&
        (!watched.level || columns[i].name == tracker.limited()))
      watched.level = i;
  }
  // With several measured columns, only the name identifies the one with the threshold.
  if (measured > 1) {
    if (watched.level && columns[*watched.level].name != tracker.limited()) watched.level.reset();
    watched.measured = watched.level;
  }
  if (watched.measured == watched.axis) watched.measured.reset();
  if (watched.level == watched.axis) watched.level.reset();
  return watched;
}

// A repeated value counts if other values were likelier, and if the unit has been used meanwhile.
double ChangeWatch::repeat_evidence(const WatchedUnit& of, const Reading& reading) const {
  if (!of.columns.measured || equal_ == 0) return 1;
  const double value = reading.numbers[*of.columns.measured];
  if (!(reading.numbers[of.columns.axis] > last_at_) || std::isnan(value)) return 1;
  if (value != last_value_) return evidence_of_difference();
  // The first repeat is no surprise to a coarse sensor, and its probability costs a prediction.
  if (equal_ < 2 || !std::isfinite(coarsest_)) return evidence_of_repeat(1);
  Reading at = alone(of.tracker, of.columns, reading);
  double probability = 0;
  for (const double side : {1.0, -1.0}) {
    at.numbers[*of.columns.measured] = value + side * coarsest_ / 2;
    const std::vector<PredictiveTails> tails = of.unit.predictive(at);
    if (tails.size() != 1) return side < 0 && value > 0 ? evidence_of_repeat(probability) : 1;
    probability += side * tails.front().below / (tails.front().below + tails.front().above);
  }
  return evidence_of_repeat(probability);
}

UpdateResult ChangeWatch::update(const WatchedUnit& of, const Reading& reading, bool late,
                                 const History& history) {
  const double repeat = late ? 1 : repeat_evidence(of, reading);
  ++taken_;
  if (!late) factor_.add(of.tracker, of.columns, of.name, of.unit, reading, of.added);
  UpdateResult taken = of.unit.update(reading, history);
  if (!taken.counted && !taken.impossible) return taken;
  const bool doubted = test_.in_doubt() || held_;
  test_.add(taken.tails, repeat);
  if (!late) {
    if (doubted)
      hold(of, reading, history);
    else
      agreeing_ = 0;
    if (taken.counted) population_.add(of.tracker, of.columns, of.name, reading, of.added);
    const double before_at = last_at_;
    repeats_ = repeat > 1 ? repeats_ * repeat : repeat == 1 ? repeats_ : 1;
    note_values(of, reading);
    note_evidence(of, reading, before_at);
  }
  reason_ = in_doubt() ? described(of, history) : std::string();
  return taken;
}

// The forecast of a unit that has changed follows the readings in time, and the test falls silent:
// doubt ends only where readings agree again with what the unit showed before.
void ChangeWatch::hold(const WatchedUnit& of, const Reading& reading, const History& history) {
  held_ = false;
  if (since_.empty() || !find_reference(of, history)) return;
  const double p = two_sided(reference_->predictive(alone(of.tracker, of.columns, reading)));
  if (!std::isnan(p)) agreeing_ = p >= agrees ? agreeing_ + 1 : 0;
  held_ = agreeing_ < agreeing_enough;
}

void ChangeWatch::note_values(const WatchedUnit& of, const Reading& reading) {
  const double at = reading.numbers[of.columns.axis];
  const bool moved = at != last_at_;
  last_at_ = at;
  farthest_at_ = std::max(farthest_at_, at);
  if (of.columns.level && !std::isnan(reading.numbers[*of.columns.level])) {
    const double level = reading.numbers[*of.columns.level], limit = of.tracker.limit().si();
    beyond_ = of.tracker.rising() ? level - of.restored >= limit : level + of.restored <= limit;
  }
  if (!of.columns.measured) return;
  const double value = reading.numbers[*of.columns.measured];
  if (std::isnan(value)) return;
  const Unit& unit = of.tracker.columns()[*of.columns.measured].unit;
  // The sensor has steps in what it shows, not in what follows from that.
  const double shown = value - of.added + of.offset;
  coarsest_ = std::min(coarsest_, decimal_step(from_si(unit, shown)) * unit.scale);
  if (value == last_value_) {
    equal_ += moved;
  } else {
    if (!std::isnan(last_value_) && of.added == last_added_ && of.offset == last_offset_)
      coarsest_ = std::min(coarsest_, std::abs(value - last_value_));
    equal_ = 1;
  }
  last_value_ = value;
  last_added_ = of.added;
  last_offset_ = of.offset;
}

void ChangeWatch::note_evidence(const WatchedUnit& of, const Reading& reading, double before_at) {
  if (!is_changed() && test_.evidence() < ChangeTest::some) {
    since_.clear();
    reference_.reset();
    new_unit_.reset();
    return;
  }
  if (since_.empty()) {
    dropped_ = 0;
    before_ = taken_ - 1;
    before_at_ = before_at;
  }
  const double measured =
      of.columns.measured ? reading.numbers[*of.columns.measured] : std::nan("");
  since_.push_back({alone(of.tracker, of.columns, reading),
                    {reading.numbers[of.columns.axis], measured, 0, 0, of.added}});
  if (since_.size() <= most_since) return;
  since_.pop_front();
  ++dropped_;
}

std::string ChangeWatch::described(const WatchedUnit& of, const History& history) {
  if (is_back()) {
    const Unit& unit = of.tracker.axis().unit;
    return fmt::format("{} goes back from {} to {}: the counter was reset, or the {} replaced",
                       of.tracker.axis().name, reading_text(farthest_at_, unit),
                       reading_text(last_at_, unit), of.tracker.noun());
  }
  if (factor_.is_found()) return factor_.reason();
  if (repeats_ >= stuck)
    return fmt::format(
        "the last {} readings are all {}: the sensor is stuck, or an old value is "
        "sent again",
        equal_,
        reading_text(last_value_ - last_added_, of.tracker.columns()[*of.columns.measured].unit));
  if (population_.is_outside() && (!is_changed() || before_ == 0)) return population_.reason();
  // A cause costs some predictions: later it is found again ever more rarely.
  const std::uint64_t count = since_.size() + dropped_;
  const bool again = count <= most_since || count % (std::bit_floor(count) / 8) == 0;
  return again || reason_.empty() ? described_change(of, history) : reason_;
}

std::string ChangeWatch::described_change(const WatchedUnit& of, const History& history) {
  const auto since = predicted(of, history);
  if (!since) {
    const std::uint64_t count = since_.size() + dropped_;
    return fmt::format("{} outside the forecast; the rate has changed, or the sensor has",
                       count == 0   ? "late readings lie"
                       : count == 1 ? "the last reading lies"
                                    : fmt::format("the last {} readings lie", count));
  }
  std::vector<ReadingSince> new_values;
  std::optional<AsNew> as_new;
  for (std::size_t first = 0; first < since->size(); ++first) {
    const ReadingSince& each = (*since)[first];
    constexpr double far = 3;
    if (each.measured > each.expected - far * each.spread) continue;
    new_values = predicted_as_new(of, first, first > 0 ? (*since)[first - 1].at : before_at_);
    if (!new_values.empty()) as_new = AsNew{first, new_values};
    break;
  }
  const ChangeCause cause = cause_of(*since, before_at_, as_new);
  const ReadingColumn& measured = of.tracker.columns()[*of.columns.measured];
  return description(cause, *since, dropped_, {of.tracker.noun(), measured.unit});
}

// The readings from `first` on, one after the other, of a new unit whose use begins at `start`;
// empty if there is none.
std::vector<ReadingSince> ChangeWatch::predicted_as_new(const WatchedUnit& of, std::size_t first,
                                                        double start) {
  const std::string name = "a new " + of.tracker.noun();
  if (!of.tracker.refusal(name).empty() || !std::isfinite(start)) return {};
  const bool goes_on =
      new_unit_ && dropped_ == 0 && new_unit_->first == first && new_unit_->start == start;
  if (!goes_on) new_unit_.reset(new NewUnit{of.tracker.begin(name), {}, {}, first, start});
  NewUnit& fresh = *new_unit_;
  const History history = [&](const std::function<void(const Reading&)>& visit) {
    for (const Reading& each : fresh.taken) visit(each);
  };
  for (std::size_t i = first + fresh.values.size(); i < since_.size(); ++i) {
    Reading moved = since_[i].reading;
    moved.numbers[of.columns.axis] -= start;
    // A new one has not been repaired.
    moved.numbers[*of.columns.measured] -= since_[i].values.added;
    ReadingSince values = since_[i].values;
    values.measured -= std::exchange(values.added, 0);
    if (!predict(*fresh.unit, moved, of.columns, values.spread, values)) {
      new_unit_.reset();
      return {};
    }
    fresh.values.push_back(values);
    fresh.unit->update(moved, history);
    fresh.taken.push_back(std::move(moved));
  }
  return fresh.values;
}

// What the readings before them predict for those since.
std::optional<std::vector<ReadingSince>> ChangeWatch::predicted(const WatchedUnit& of,
                                                                const History& history) {
  if (!of.columns.measured || since_.empty() || !find_reference(of, history)) return {};
  std::vector<ReadingSince> values;
  for (Since& each : since_) {
    if (std::isnan(each.values.measured)) continue;
    const double scale = scale_of_reading(of.tracker, of.columns, each.values.measured);
    if (!each.predicted && !predict(*reference_, each.reading, of.columns, scale, each.values))
      return {};
    each.predicted = true;
    values.push_back(each.values);
  }
  if (values.size() != since_.size()) return {};
  return values;
}

bool ChangeWatch::find_reference(const WatchedUnit& of, const History& history) {
  if (reference_) return true;
  if (before_ > longest_history) return false;
  std::vector<Reading> all;
  if (before_ > 0) {
    history([&](const Reading& each) {
      if (all.size() < before_) all.push_back(each);
    });
  }
  std::shared_ptr<TrackedUnit> unit = of.tracker.begin(of.name);
  for (std::size_t i = 0; i < all.size(); ++i) {
    unit->update(all[i], [&](const std::function<void(const Reading&)>& visit) {
      for (std::size_t j = 0; j < i; ++j) visit(all[j]);
    });
  }
  reference_ = std::move(unit);
  return true;
}

void ChangeWatch::save(ByteWriter& to) const {
  test_.save(to);
  to.text(reason_);
  to.u64(taken_);
  for (const double each : {last_at_, farthest_at_, last_value_, last_added_, last_offset_,
                            coarsest_, repeats_, before_at_})
    to.number(each);
  to.byte(beyond_);
  to.byte(held_);
  population_.save(to);
  factor_.save(to);
  for (const std::uint64_t each : {agreeing_, equal_, dropped_, before_}) to.u64(each);
  to.u64(since_.size());
  for (const Since& each : since_) {
    prognosis::save(to, each.reading);
    for (const double number : {each.values.at, each.values.measured, each.values.expected,
                                each.values.spread, each.values.added})
      to.number(number);
    to.byte(each.predicted);
  }
}

void ChangeWatch::load(ByteReader& from, const Tracker& tracker) {
  test_.load(from);
  reason_ = from.text();
  taken_ = from.u64();
  for (double* each : {&last_at_, &farthest_at_, &last_value_, &last_added_, &last_offset_,
                       &coarsest_, &repeats_, &before_at_})
    *each = from.number();
  beyond_ = from.flag();
  held_ = from.flag();
  population_.load(from);
  factor_.load(from, tracker);
  for (std::uint64_t* each : {&agreeing_, &equal_, &dropped_, &before_}) *each = from.u64();
  since_.clear();
  reference_.reset();
  new_unit_.reset();
  const std::size_t count = from.count(1);
  if (count > most_since) from.fail("it has too many readings since a change");
  for (std::size_t i = 0; i < count; ++i) {
    Since each;
    each.reading = read_reading(from, tracker);
    for (double* number : {&each.values.at, &each.values.measured, &each.values.expected,
                           &each.values.spread, &each.values.added})
      *number = from.number();
    each.predicted = from.flag();
    since_.push_back(std::move(each));
  }
}

}  // namespace wearwell::prognosis
