#include "wearwell/monitor/monitor_config.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/input/text_file.h"
#include "wearwell/monitor/broker_config.h"
#include "wearwell/monitor/config_problems.h"
#include "wearwell/monitor/config_values.h"
#include "wearwell/monitor/http_config.h"
#include "wearwell/monitor/source_config.h"
#include "wearwell/monitor/store.h"
#include "wearwell/monitor/webhook_config.h"

namespace wearwell::monitor {
namespace {

/// The risk's distance, in the unit of the study's axis.
double read_horizon(const TomlReader& table, const prognosis::Tracker& tracker) {
  const Unit& unit = tracker.axis().unit;
  const double horizon = required_si(table, "horizon", unit) - unit.offset;
  if (!(horizon > 0)) table.fail("horizon", "must be above 0");
  return horizon;
}

/// Without a tracker (null) the horizon is not checked.
AlarmSettings read_alarm(const TomlReader& root, const prognosis::Tracker* tracker) {
  const std::string horizon =
      fmt::format("horizon = \"500 {}\"", tracker ? tracker->axis().unit.text : "h");
  if (!root.has("alarm"))
    root.fail("alarm", fmt::format("is missing: how far ahead the risk looks; for example:\n    "
                                   "[alarm]\n    {}",
                                   horizon));
  const TomlReader table = root.required_table("alarm");
  AlarmSettings alarm;
  Problems problems;
  problems.in(
      [&] {
        if (tracker) {
          alarm.horizon = read_horizon(table, *tracker);
        } else if (!table.has("horizon")) {
          table.fail("horizon", "is missing");
        }
      },
      horizon);
  const auto share = [&](const char* key, double& into) {
    const std::string example = fmt::format("{} = {}", key, into);
    return problems.in(
        [&] {
          const auto value = table.quantity(key, "1");
          if (!value) return;
          if (!(value->si() > 0 && value->si() < 1))
            table.fail(key, fmt::format("{} must lie between 0 and 1", value->si()));
          into = value->si();
        },
        example);
  };
  const bool watch = share("watch", alarm.watch), act = share("act", alarm.act);
  if (watch && act) {
    problems.in(
        [&] {
          if (!(alarm.watch < alarm.act))
            table.fail("watch", fmt::format("{} must be below act, {}", alarm.watch, alarm.act));
        },
        "watch = 0.05 with act = 0.2");
  }
  share("hysteresis", alarm.hysteresis);
  problems.in(
      [&] {
        const auto silence = table.quantity("silence", "s");
        if (!silence) return;
        if (!(silence->si() > 0)) table.fail("silence", "must be above 0");
        alarm.silence = silence->si();
      },
      "silence = \"2 d\"");
  problems.finish();
  return alarm;
}

PublishSettings read_publish(const TomlReader& table) {
  PublishSettings publish;
  Problems problems;
  problems.in([&] { publish.broker = read_broker(table, "wearwell-publish"); });
  problems.in(
      [&] {
        publish.prefix = table.text("prefix").value_or("wearwell");
        if (publish.prefix.find_first_of("+#") != std::string::npos || publish.prefix.empty())
          table.fail("prefix", "is not a topic");
      },
      "prefix = \"wearwell\"");
  problems.finish();
  return publish;
}

/// What is removed cannot be had back, so a short time is a mistake.
std::optional<double> read_keep(const TomlReader& store) {
  const auto keep = store.quantity("keep", "s");
  if (!keep) return {};
  constexpr double day = 86400, year = 365.25 * day;
  if (!(keep->si() >= day && keep->si() <= 1000 * year))
    store.fail("keep", "must lie between 1 d and 1000 years");
  return keep->si();
}

constexpr std::initializer_list<const char*> root_keys = {"result",  "title", "store", "reading",
                                                          "source",  "alarm", "http",  "publish",
                                                          "webhook", "limits"};

/// The file or URL in [store].
std::string read_store_url(const TomlReader& store) {
  std::string url = store.text("url").value_or("");
  if (url.empty()) return default_store;
  if (is_postgres(url)) return url;
  if (url.find("://") != std::string::npos)
    store.fail("url", "is neither a file nor postgresql://...");
  const std::filesystem::path folder = (folder_of(store) / url).parent_path();
  std::error_code ignored;
  if (!folder.empty() && !std::filesystem::is_directory(folder, ignored))
    store.fail("url", fmt::format("no such folder: {}", folder.string()));
  return url;
}

/// What can be read without the population of the result.
void read_own_tables(const TomlReader& root, MonitorConfig& config, Problems& problems) {
  problems.in([&] { config.title = root.text("title").value_or(""); },
              "title = \"Pumps of hall 2\"");
  problems.in([&] {
    config.store = default_store;
    const auto store = root.table("store");
    if (!store) return;
    problems.in([&] { config.store = read_store_url(*store); }, "url = \"fleet.sqlite\"");
    problems.in([&] { config.keep_s = read_keep(*store); }, "keep = \"5 years\"");
  });
  problems.in([&] {
    if (const auto http = root.table("http")) config.http = read_http(*http);
  });
  problems.in([&] {
    if (const auto publish = root.table("publish")) config.publish = read_publish(*publish);
  });
  problems.in([&] {
    if (const auto webhook = root.table("webhook")) config.webhook = read_webhook(*webhook);
  });
  problems.in([&] {
    constexpr long long most = 10'000'000;
    const auto limits = root.table("limits");
    if (!limits) return;
    problems.in(
        [&] {
          if (const auto units = limits->integer("units", 1, most))
            config.most_units = static_cast<std::size_t>(*units);
        },
        "units = 1000");
  });
}

/// Without a tracker (null): all that needs no result.
MonitorConfig read_tables(const TomlReader& root, const prognosis::Tracker* tracker,
                          Problems& problems) {
  MonitorConfig config;
  config.folder = folder_of(root);
  for (const char* key : root_keys) root.has(key);
  read_own_tables(root, config, problems);
  problems.in([&] { read_sources(root, tracker, config, problems); });
  problems.in([&] {
    const auto posts = [](const SourceSettings& each) { return each.kind == SourceKind::http; };
    if (!root.has("http") && std::any_of(config.sources.begin(), config.sources.end(), posts))
      root.fail("http",
                "is missing: a source of kind \"http\" needs a server, [http]; for example:\n    "
                "[http]\n    listen = \"127.0.0.1:8080\"");
  });
  problems.in([&] { config.alarm = read_alarm(root, tracker); });
  problems.unknown_keys(root);
  return config;
}

/// Whether a text has nothing but comments and blanks.
bool has_only_comments(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first != line.npos && line[first] != '#') return false;
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return true;
}

}  // namespace

TomlReader read_config_file(const std::filesystem::path& file) {
  const TextFile text = read_text_file(file);
  if (has_only_comments(text.text))
    throw InputError(
        fmt::format("{} is empty: a configuration has result, [reading] with [reading.columns], "
                    "[source.NAME] and [alarm]; wearwell new monitor NAME --from RESULT writes one",
                    file.string()));
  return TomlReader::parse(text);
}

std::string read_store(const TomlReader& root) {
  const auto store = root.table("store");
  return store ? read_store_url(*store) : default_store;
}

std::filesystem::path read_result_path(const TomlReader& root) {
  std::filesystem::path result;
  Problems problems;
  const bool found = problems.in(
      [&] {
        if (!root.has("result"))
          root.fail("result", "is missing: the folder that wearwell fit has written");
        result = existing(root, "result");
      },
      "result = \"study-results\"");
  if (found) return result;
  read_tables(root, nullptr, problems);
  problems.finish();
  return result;
}

void refuse_result(const TomlReader& root, const std::string& why) {
  Problems problems;
  problems.add(why);
  read_tables(root, nullptr, problems);
  problems.finish();
  throw InputError(why);
}

MonitorConfig read_monitor_config(const TomlReader& root, const prognosis::Tracker& tracker) {
  Problems problems;
  MonitorConfig config = read_tables(root, &tracker, problems);
  problems.finish();
  root.finish();
  return config;
}

}  // namespace wearwell::monitor
