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

// A tenth of the median life of a new unit, to one digit.
std::string horizon(const prognosis::Tracker& tracker) {
  const std::string fresh = "a new " + tracker.noun();
  const std::string unit =
      tracker.refusal(fresh).empty() || tracker.seen().empty() ? fresh : tracker.seen().front();
  const prognosis::Forecast forecast = tracker.begin(unit)->forecast();
  const Unit& axis = tracker.axis().unit;
  double tenth =
      forecast.remaining.points().empty() ? 1 : forecast.remaining.quantile(0.5) / axis.scale / 10;
  if (!std::isfinite(tenth) || !(tenth > 0)) tenth = 1;
  const double power = std::pow(10, std::floor(std::log10(tenth)));
  return fmt::format("{:.6g} {}", std::max(1.0, std::round(tenth / power)) * power,
                     axis.text == "1" ? "" : axis.text);
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
  std::string ending = horizon(tracker);
  if (ending.back() == ' ') ending.pop_back();
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
event       = {10}  # rows with this field are events: replaced, failed, corrected, withdrawn, ...
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

# Risk: the probability that {5} reaches {6:.6g} {7} within the horizon.
[alarm]
horizon = {8}
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
      tracker.limit().unit.text, toml_text(ending), toml_text(free_field(tracker, "time")),
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
