#include "wearwell/cli/new_monitor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/cli/first_selection.h"
#include "wearwell/cli/followed_result.h"
#include "wearwell/study/example.h"

namespace wearwell {
namespace {

namespace fs = std::filesystem;

// The median of what remains to a unit, in the axis's unit; NaN where nothing determines it: the life
// of a new part needs its load.
double remaining_of(const prognosis::Tracker& tracker, const std::string& unit) {
  const prognosis::Forecast forecast = tracker.begin(unit)->forecast();
  if (forecast.remaining.points().empty()) return std::nan("");
  const double median = forecast.remaining.quantile(0.5) / tracker.axis().unit.scale;
  return std::isfinite(median) && median > 0 ? median : std::nan("");
}

// The line of the horizon: a tenth of the median life of a new unit, or of what remains to one of the
// study, to one digit.
std::string horizon_line(const prognosis::Tracker& tracker) {
  const std::string fresh = "a new " + tracker.noun();
  double median = std::nan("");
  if (tracker.refusal(fresh).empty()) median = remaining_of(tracker, fresh);
  for (const std::string& each : tracker.seen()) {
    if (!std::isnan(median)) break;
    median = remaining_of(tracker, each);
  }
  const std::string unit = tracker.axis().unit.text == "1" ? "" : " " + tracker.axis().unit.text;
  if (std::isnan(median))
    return fmt::format("# horizon = {}  # STATE IT: the use until the next inspection",
                       toml_text("1000" + unit));
  const double tenth = median / 10, power = std::pow(10, std::floor(std::log10(tenth)));
  return "horizon = " +
         toml_text(fmt::format("{:.6g}{}", std::max(1.0, std::round(tenth / power)) * power, unit));
}

std::string column_lines(const prognosis::Tracker& tracker) {
  std::string text;
  for (const prognosis::ReadingColumn& each : tracker.columns()) {
    const std::string name = toml_text(each.name);
    text += each.unit.text == "1" ? fmt::format("{} = {}", each.name, name)
                                  : fmt::format("{} = {{ field = {}, unit = {} }}", each.name, name,
                                                toml_text(each.unit.text));
    text += each.measured ? "  # measured\n" : "  # a constant: { value = \"...\" }\n";
  }
  for (const std::string& each : tracker.labels())
    text += fmt::format("{} = {}  # a label\n", each, toml_text(each));
  return text;
}

// A field that no column of the study has: its axis may be called time.
std::string free_field(const prognosis::Tracker& tracker, const std::string& name) {
  const auto columns = tracker.columns();
  const auto labels = tracker.labels();
  const bool taken = tracker.noun() == name ||
                     std::find(labels.begin(), labels.end(), name) != labels.end() ||
                     std::any_of(columns.begin(), columns.end(),
                                 [&](const auto& each) { return each.name == name; });
  return taken ? "message_" + name : name;
}

std::string configuration(const prognosis::Tracker& tracker, const fs::path& result) {
  const std::string noun = tracker.noun().empty() ? "unit" : tracker.noun();
  return fmt::format(
      R"(# Readings of {0}s on line: wearwell monitor monitor.toml. Every key: docs/reference/monitor.md
title  = {1}
result = {2}  # what wearwell fit has written

[store]
url = "fleet.sqlite"  # readings, states, events; or postgresql://USER@HOST/DATABASE
# keep = "5 years"    # then readings of parts that are out of service for so long are removed

# The fields of a message: a JSON object, or a line of CSV with a heading.
[reading]
unit        = {3}
time        = {9}  # identifies a reading of a {0}
time_format = "iso 8601"  # 2026-11-22T15:04:05Z; or "unix s", "unix ms"
# sequence  = "n"         # a whole number that identifies a reading instead
event       = {10}  # rows with this field are events: installed, replaced, repaired, failed, corrected, ...
[reading.columns]
{4}
# Where readings come from: as many as there are, each with a name.
[source.line]
kind = "stdin"            # which a service does not have
# [source.files]
# kind   = "folder"       # .csv, .jsonl, .ndjson, .json
# folder = "incoming"
# [source.plant]
# kind   = "mqtt"         # or "sparkplug"
# broker = "mqtts://broker:8883"
# topic  = "plant/wear"   # "plant/{{unit}}/wear": the topic names the {0}; then reading.unit is left out
# [source.post]
# kind   = "http"         # POST /api/v1/readings
# format = "influx"       # lines of InfluxDB, of any source; then also precision = "ns"; or "opc ua"

# Risk: the probability that {5} reaches {6:.6g}{7} within the horizon.
[alarm]
{8}
watch   = "5 %"
act     = "20 %"
# silence = "2 d"         # without a reading for so long, the state is unknown

[http]
listen = "127.0.0.1:8080"  # the page; beyond this machine with token, certificate and key
# [http.tokens.dashboard]   # who may do what: read, write (readings), operate (events, alarms)
# token_file = "dashboard.token"
# roles = ["read"]
# [publish]
# broker = "mqtt://broker"  # every change of a {0}
# [webhook]
# url = "https://HOST/PATH"  # POST of each alarm that lasts for a minute
)",
      noun, toml_text(fmt::format("All {}s", noun)), toml_text(result.generic_string()),
      toml_text(noun), column_lines(tracker), tracker.limited(), tracker.limit().value,
      tracker.limit().unit.text == "1" ? "" : " " + tracker.limit().unit.text,
      horizon_line(tracker), toml_text(free_field(tracker, "time")),
      toml_text(free_field(tracker, "event")));
}

}  // namespace

void run_new_monitor(const NewOptions& options, Models models) {
  if (options.from.empty())
    throw InputError("--from RESULT is missing: the folder of a result whose units are monitored");
  if (!options.columns.empty() || options.failure || !options.limit.empty() ||
      !options.table.empty())
    throw InputError(
        "--column, --failure, --limit and the options for reading a table are not for "
        "a monitor: it is made for a result");
  const FollowedResult read = followed_result(options.from, models);
  fs::path folder = options.folder;
  if (folder.empty()) {
    const fs::path name = options.from.has_filename() ? options.from : options.from.parent_path();
    folder = name.filename().string() + "-monitor";
  }
  const fs::path file = write_new(
      "monitor.toml",
      configuration(*read.tracker, fs::relative(fs::absolute(options.from), fs::absolute(folder))),
      folder);
  fmt::print(
      "{} has a configuration for {}. Adapt the fields of your messages, then run: wearwell "
      "monitor {} --check\n",
      file.string(), options.from.string(), shell_word(file.string()));
}

}  // namespace wearwell
