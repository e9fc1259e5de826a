#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/monitor/unit_event.h"
#include "wearwell/prognosis/tracker_units.h"

namespace wearwell::monitor {

/// `doubt`: the readings do not follow the forecast, so its risk says nothing.
enum class Alarm { ok, watch, act, doubt, unknown };
const char* name(Alarm alarm);

/// In the units that `FleetView` names.
using prognosis::Interval;

/// Outcomes of a unit's messages.
struct Quality {
  std::uint64_t readings = 0, repeated = 0, late = 0, contradicting = 0, refused = 0;
  std::uint64_t not_counted = 0;   ///< of `refused`: stored readings that the forecast leaves out
  std::string state_problem = {};  ///< the last one of a stored reading
  std::string last_problem = {};
};

/// prognosis::RateChange in the units of the study.
struct RateChangeView {
  double probability = 0;
  Interval since;   ///< along the axis, if it has changed
  Interval factor;  ///< the new rate as a multiple of the earlier one
};

/// One unit as readers see it.
struct UnitView {
  std::string unit;
  Alarm alarm = Alarm::unknown;
  /// False: neither a reading nor the study determines how it continues; then `at`, `level`,
  /// `remaining`, `b10`, `risk` and `passed` are undefined, and not shown.
  bool known = true;
  double at = 0;              ///< along the axis
  std::int64_t last_key = 0;  ///< the largest of its stored readings, of all its parts; 0: none
  std::int64_t last_reading_ms = 0;  ///< Unix time of its last message; 0: none
  Interval level;                    ///< wear, now
  Interval remaining;                ///< life, from now on
  double b10 = 0;                    ///< remaining useful life that 90 % exceed
  double numerical_error = 0;  ///< of both, relative, the largest (Tracker::probability_error)
  double risk = 0;             ///< probability that the threshold is reached within the horizon
  double passed = 0;           ///< probability that it is already reached
  /// Whether its rate has changed; empty if the study does not allow for it.
  std::optional<RateChangeView> rate_change = {};
  std::string doubt = {};     ///< why the forecast is in doubt; empty if it is not
  bool beyond = false;        ///< the last reading measures a level beyond the threshold
  std::int64_t alarm_ms = 0;  ///< Unix time since which the alarm holds; 0: from the start on
  std::string acknowledged_by = {};       ///< who has acknowledged this alarm; empty: no one
  std::int64_t part = 1;                  ///< which one it is, the first is 1
  Service service = Service::in_service;  ///< else the alarm is unknown
  Quality quality;
};

/// The alarm in a word; of a part out of service, why it is.
std::string shown_state(const UnitView& unit);

/// One point in the history of a unit: its reading, and the forecast at that time.
struct UnitMoment {
  std::int64_t time_ms = 0;
  double at = 0;
  std::optional<double> measured;
  Interval level, life;  ///< `life`: predicted end on the axis, not the remaining life
  std::int64_t key = 0;  ///< of the reading
};

/// An event as readers see it.
struct EventView {
  UnitEvent event;                                     ///< its own numbers in SI
  double use = 0;                                      ///< in `axis_unit`; NaN if not given
  double offset = 0, restored = 0;                     ///< in `level_unit`
  std::vector<std::pair<std::string, double>> values;  ///< of `corrected`, by column, in its unit
  bool cancelled = false;
};

/// The forecast of a unit by two fits, from the same readings, as one took the place of the other.
struct MovedForecast {
  struct Side {
    Alarm alarm = Alarm::unknown;
    bool known = false;  ///< as in UnitView
    Interval remaining = {};
    double risk = 0;
  };
  std::string unit;
  std::int64_t last_key = 0;  ///< of the unit's readings then
  std::string axis_unit;      ///< of `remaining`
  Side before, after;
};

/// The fit that forecasts come from.
struct FitView {
  std::string fingerprint;      ///< SHA-1
  std::int64_t written_ms = 0;  ///< Unix time of its file; 0: unknown
  std::int64_t since_ms = 0;    ///< Unix time from which forecasts come from it; 0: unknown
};

struct UnitDetail {
  UnitView view;
  std::vector<UnitMoment> moments;  ///< thinned to some hundred, first and last kept
  struct PathPoint {
    double at;
    Interval level;
  };
  std::vector<PathPoint> path;  ///< past and future
  struct CurvePoint {
    double remaining, survival;
  };
  std::vector<CurvePoint> survival;
  /// Earlier forecasts of `level` (5 to 95 %) compared with the next reading: number covered,
  /// number in all.
  std::uint64_t held = 0, judged = 0;
  std::vector<EventView> events = {};       ///< in the order of their arrival
  std::optional<MovedForecast> moved = {};  ///< by the present fit, when it came
};

/// A column of a reading, for those who report corrections.
struct ColumnView {
  std::string name, unit;  ///< unit empty: a label
};

/// Messages about alarms that are sent elsewhere, since the start.
struct WebhookView {
  std::uint64_t sent = 0, failed = 0;  ///< accepted; attempts without success
  std::uint64_t waiting = 0;           ///< units whose alarm is still to be sent
};

/// The properties common to all units.
struct FleetView {
  std::string title, noun, axis, axis_unit, limited, level_unit;
  double limit = 0, horizon = 0;  ///< in these units
  bool keys_are_times = false;    ///< keys of readings: Unix times in ms, not sequence numbers
  std::vector<ColumnView> columns;
  /// The column of a reading that measures the level, if one does.
  std::optional<ColumnView> level_column = {};
  bool trusted = true;  ///< the result that the population comes from
  std::uint64_t units = 0, ok = 0, watch = 0, act = 0, doubt = 0, unknown = 0;
  std::uint64_t messages = 0, stored = 0, refused = 0, repeated = 0;
  std::int64_t now_ms = 0, started_ms = 0;
  std::int64_t lag_ms =
      0;  ///< age in the store of the last processed reading; 0: all are processed
  std::int64_t last_message_ms = 0;  ///< time of the last one, for any outcome; 0: none yet
  FitView fit = {};
  std::optional<WebhookView> webhook = {};  ///< if there is one
};

/// The data that the page, the API and the metrics read: any thread may ask; answers are copies.
class FleetReader {
 public:
  virtual ~FleetReader() = default;
  virtual FleetView fleet() const = 0;
  /// Sorted by risk, highest first; those in doubt as if theirs just called for action, those beyond
  /// the threshold as certain. Units whose name contains `search` (case-insensitive).
  virtual std::vector<UnitView> units(const std::string& search, std::size_t offset,
                                      std::size_t count,
                                      std::uint64_t* matching = nullptr) const = 0;
  virtual std::optional<UnitDetail> unit(const std::string& name) const = 0;
  /// The same unit without its history and plots: as cheap as a look-up.
  virtual std::optional<UnitView> view(const std::string& name) const = 0;
  /// How the present fit moved the forecasts when it came, the largest change first; empty if it
  /// was there from the start. `*all`: their number.
  virtual std::vector<MovedForecast> moved(std::size_t offset, std::size_t count,
                                           std::uint64_t* all = nullptr) const = 0;
  /// Increases with every change; `changed_since` names the units that changed after it.
  virtual std::uint64_t version() const = 0;
  virtual std::vector<std::string> changed_since(std::uint64_t version) const = 0;
  /// Why there is nothing to read yet; empty: there is.
  virtual std::string starting() const { return {}; }
  /// The reader that answers now: several questions to it are about one fit. It lives as long as
  /// this, or as long as it is held.
  virtual std::shared_ptr<const FleetReader> present() const {
    return {std::shared_ptr<const FleetReader>(), this};
  }
};

/// Entry of external messages (HTTP POST, MQTT, files): stored when it returns true.
struct Delivery {
  bool stored = false;
  std::uint64_t readings = 0, repeated = 0, refused = 0;
  std::string problem = {};  ///< the first one
  std::uint64_t events = 0;
  bool unknown_unit = false;  ///< an event was refused since nothing is known of its unit
};
class Inbox {
 public:
  virtual ~Inbox() = default;
  /// One message: JSON (an object, or lines of objects) or CSV with a heading; `topic` for MQTT,
  /// otherwise "". `no_events`: why rows that are events are refused; empty: they are not.
  virtual Delivery deliver(const std::string& topic, const std::string& payload,
                           const std::string& no_events) = 0;
  Delivery deliver(const std::string& topic, const std::string& payload) {
    return deliver(topic, payload, {});
  }
};

}  // namespace wearwell::monitor
