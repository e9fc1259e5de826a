#include "wearwell/monitor/fleet_metrics.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <utility>

namespace wearwell::monitor {
namespace {

std::string number(double x) {
  if (std::isnan(x)) return "NaN";
  if (std::isinf(x)) return x > 0 ? "+Inf" : "-Inf";
  return fmt::format("{}", x);
}

/// A quoted label value.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char each : text) {
    if (each == '\n') {
      out += "\\n";
    } else {
      if (each == '"' || each == '\\') out += '\\';
      out += each;
    }
  }
  return out + '"';
}

class Text {
 public:
  void family(const char* name, const char* type, const char* help) {
    name_ = name;
    out_ += fmt::format("# HELP {} {}\n# TYPE {} {}\n", name, help, name, type);
  }
  void sample(const std::string& labels, double value) {
    out_ += labels.empty() ? fmt::format("{} {}\n", name_, number(value))
                           : fmt::format("{}{{{}}} {}\n", name_, labels, number(value));
  }
  std::string take() { return std::move(out_); }

 private:
  std::string name_, out_;
};

double seconds(std::int64_t milliseconds) {
  return static_cast<double>(milliseconds) / 1000;
}

void add_fleet(const FleetView& fleet, Text* text) {
  text->family("wearwell_fleet_info", "gauge",
               "The quantity that is monitored, and its units; always 1.");
  text->sample(fmt::format("axis={},axis_unit={},level={},level_unit={},title={}",
                           quoted(fleet.axis), quoted(fleet.axis_unit), quoted(fleet.limited),
                           quoted(fleet.level_unit), quoted(fleet.title)),
               1);
  text->family("wearwell_fleet_trusted", "gauge",
               "Whether the result that the population comes from passed its checks.");
  text->sample("", fleet.trusted ? 1 : 0);
  text->family("wearwell_fleet_units", "gauge", "Units by alarm.");
  for (const auto& [alarm, count] :
       {std::pair(Alarm::ok, fleet.ok), std::pair(Alarm::watch, fleet.watch),
        std::pair(Alarm::act, fleet.act), std::pair(Alarm::doubt, fleet.doubt),
        std::pair(Alarm::unknown, fleet.unknown)}) {
    text->sample(fmt::format("alarm=\"{}\"", name(alarm)), static_cast<double>(count));
  }
  text->family("wearwell_fleet_limit", "gauge", "The failure threshold, in level_unit.");
  text->sample("", fleet.limit);
  text->family("wearwell_fleet_horizon", "gauge", "The horizon of the risk, in axis_unit.");
  text->sample("", fleet.horizon);
  const auto count = [&](const char* name, const char* help, std::uint64_t value) {
    text->family(name, "counter", help);
    text->sample("", static_cast<double>(value));
  };
  count("wearwell_messages_received_total", "Messages received.", fleet.messages);
  count("wearwell_messages_stored_total", "Messages stored.", fleet.stored);
  count("wearwell_messages_refused_total", "Messages refused.", fleet.refused);
  count("wearwell_messages_repeated_total", "Messages repeated.", fleet.repeated);
  text->family("wearwell_state_lag_seconds", "gauge",
               "Age in the store of the last processed reading; 0: all are processed.");
  text->sample("", seconds(fleet.lag_ms));
  text->family("wearwell_last_message_timestamp_seconds", "gauge",
               "Time of the last message, Unix time; 0: none yet.");
  text->sample("", seconds(fleet.last_message_ms));
  if (fleet.webhook) {
    count("wearwell_webhook_sent_total", "Alarms that the webhook's server has accepted.",
          fleet.webhook->sent);
    count("wearwell_webhook_failures_total", "Attempts to send an alarm that failed.",
          fleet.webhook->failed);
    text->family("wearwell_webhook_waiting", "gauge", "Units whose alarm is still to be sent.");
    text->sample("", static_cast<double>(fleet.webhook->waiting));
  }
  text->family("wearwell_fit_info", "gauge", "The fit that forecasts come from; always 1.");
  text->sample(fmt::format("fingerprint={}", quoted(fleet.fit.fingerprint)), 1);
  text->family("wearwell_fit_since_timestamp_seconds", "gauge",
               "Time from which forecasts come from it, Unix time.");
  text->sample("", seconds(fleet.fit.since_ms));
  text->family("wearwell_start_timestamp_seconds", "gauge", "Start of the monitor, Unix time.");
  text->sample("", seconds(fleet.started_ms));
}

double code(Alarm alarm) {
  switch (alarm) {
    case Alarm::ok:
      return 0;
    case Alarm::watch:
      return 1;
    case Alarm::act:
      return 2;
    case Alarm::doubt:
      return 3;
    case Alarm::unknown:
      break;
  }
  return -1;
}

void add_units(const std::vector<UnitView>& units, Text* text) {
  std::vector<std::string> labels;
  for (const UnitView& each : units) labels.push_back("unit=" + quoted(each.unit));
  const auto gauge = [&](const char* name, const char* help,
                         const std::function<double(const UnitView&)>& value) {
    text->family(name, "gauge", help);
    for (std::size_t i = 0; i < units.size(); ++i) text->sample(labels[i], value(units[i]));
  };
  // A missing sample means an unknown value.
  const auto known = [&](const char* name, const char* help,
                         const std::function<double(const UnitView&)>& value) {
    text->family(name, "gauge", help);
    for (std::size_t i = 0; i < units.size(); ++i)
      if (units[i].known) text->sample(labels[i], value(units[i]));
  };
  const auto interval = [&](const char* name, const char* help, Interval UnitView::*of) {
    text->family(name, "gauge", help);
    for (std::size_t i = 0; i < units.size(); ++i) {
      if (!units[i].known) continue;
      const Interval& value = units[i].*of;
      text->sample(labels[i] + ",percentile=\"5\"", value.q05);
      text->sample(labels[i] + ",percentile=\"50\"", value.q50);
      text->sample(labels[i] + ",percentile=\"95\"", value.q95);
    }
  };
  text->family("wearwell_fleet_units_shown", "gauge",
               "Units with their own samples here, the riskiest ones.");
  text->sample("", static_cast<double>(units.size()));
  gauge("wearwell_unit_alarm", "0: ok, 1: watch, 2: act, 3: doubt, -1: unknown.",
        [](const UnitView& unit) { return code(unit.alarm); });
  gauge("wearwell_unit_acknowledged", "Whether someone has acknowledged the alarm, 1 or 0.",
        [](const UnitView& unit) { return unit.acknowledged_by.empty() ? 0.0 : 1.0; });
  gauge("wearwell_unit_doubt", "Whether the readings do not follow the forecast, 1 or 0.",
        [](const UnitView& unit) { return unit.doubt.empty() ? 0.0 : 1.0; });
  gauge("wearwell_unit_beyond",
        "Whether the last reading measures a level beyond the failure threshold, 1 or 0.",
        [](const UnitView& unit) { return unit.beyond ? 1.0 : 0.0; });
  gauge("wearwell_unit_in_service", "1; 0 if the part has failed or is taken out.",
        [](const UnitView& unit) { return unit.service == Service::in_service ? 1.0 : 0.0; });
  known("wearwell_unit_risk_ratio",
        "Probability that the failure threshold is reached within the horizon.",
        [](const UnitView& unit) { return unit.risk; });
  known("wearwell_unit_passed_ratio", "Probability that the failure threshold is already reached.",
        [](const UnitView& unit) { return unit.passed; });
  known("wearwell_unit_position", "Use of the unit so far, in axis_unit.",
        [](const UnitView& unit) { return unit.at; });
  interval("wearwell_unit_level",
           "Present value of the quantity with the failure threshold, in level_unit.",
           &UnitView::level);
  interval("wearwell_unit_remaining", "Remaining useful life, in axis_unit.", &UnitView::remaining);
  known("wearwell_unit_remaining_b10", "Remaining useful life that 90 % exceed, in axis_unit.",
        [](const UnitView& unit) { return unit.b10; });
  gauge("wearwell_unit_last_reading_timestamp_seconds",
        "Time of the last reading, Unix time; 0: none yet.",
        [](const UnitView& unit) { return seconds(unit.last_reading_ms); });
  text->family("wearwell_unit_readings_total", "counter", "Readings by outcome.");
  for (std::size_t i = 0; i < units.size(); ++i) {
    const Quality& of = units[i].quality;
    for (const auto& [outcome, count] :
         {std::pair("counted", of.readings), std::pair("contradicting", of.contradicting),
          std::pair("late", of.late), std::pair("refused", of.refused),
          std::pair("repeated", of.repeated)}) {
      text->sample(fmt::format("{},outcome=\"{}\"", labels[i], outcome),
                   static_cast<double>(count));
    }
  }
}

void add_http(const HttpCounts& http, Text* text) {
  text->family("wearwell_http_connections", "gauge", "Open connections.");
  text->sample("", static_cast<double>(http.connections));
  text->family("wearwell_http_event_streams", "gauge", "Open connections that listen to events.");
  text->sample("", static_cast<double>(http.streams));
  text->family("wearwell_http_responses_total", "counter", "Responses by status.");
  for (const auto& [status, count] : http.answers) {
    text->sample(fmt::format("code=\"{}\"", status), static_cast<double>(count));
  }
}

}  // namespace

std::string metrics_text(const FleetView& fleet, const std::vector<UnitView>& units,
                         const HttpCounts& http) {
  Text text;
  add_fleet(fleet, &text);
  add_units(units, &text);
  add_http(http, &text);
  return text.take();
}

}  // namespace wearwell::monitor
