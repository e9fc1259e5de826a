#include "wearwell/monitor/monitor_config.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>

#include "wearwell/base/nearest.h"
#include "wearwell/monitor/broker_config.h"
#include "wearwell/monitor/config_problems.h"
#include "wearwell/monitor/config_values.h"
#include "wearwell/monitor/http_config.h"
#include "wearwell/monitor/source_config.h"
#include "wearwell/monitor/store.h"
#include "wearwell/monitor/webhook_config.h"

namespace wearwell::monitor {
namespace {

AlarmSettings read_alarm(const TomlReader& root, const prognosis::Tracker& tracker) {
  const prognosis::ReadingColumn& axis = tracker.axis();
  const std::string horizon = fmt::format("horizon = \"500 {}\"", axis.unit.text);
  if (!root.has("alarm"))
    root.fail("alarm", fmt::format("is missing: how far ahead the risk looks; for example:\n    "
                                   "[alarm]\n    {}",
                                   horizon));
  const TomlReader table = root.required_table("alarm");
  AlarmSettings alarm;
  Problems problems;
  problems.in(
      [&] {
        alarm.horizon = required_si(table, "horizon", axis.unit) - axis.unit.offset;
        if (!(alarm.horizon > 0)) table.fail("horizon", "must be above 0");
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
  problems.in([&] { table.finish(); });
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
  problems.in([&] { table.finish(); });
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

/// The keys of the file itself, where `finish` would also see those behind a problem.
void refuse_unknown_tables(const TomlReader& root) {
  const std::vector<std::string> known = {"result", "title", "store",   "reading", "source",
                                          "alarm",  "http",  "publish", "webhook", "limits"};
  for (const std::string& key : root.keys()) {
    if (std::find(known.begin(), known.end(), key) == known.end())
      root.fail(key, fmt::format("unknown key; did you mean '{}'? (possible: {})",
                                 nearest_name(key, known), fmt::join(known, ", ")));
  }
}

/// What can be read without the population of the result.
void read_own_tables(const TomlReader& root, MonitorConfig& config, Problems& problems) {
  problems.in([&] { config.title = root.text("title").value_or(""); },
              "title = \"Pumps of hall 2\"");
  problems.in_table(root, "store", [&] {
    config.store = "fleet.sqlite";
    const auto store = root.table("store");
    if (!store) return;
    problems.in(
        [&] {
          const std::string url = store->text("url").value_or("");
          if (url.find("://") != std::string::npos && !is_postgres(url))
            store->fail("url", "is neither a file nor postgresql://...");
          if (!url.empty()) config.store = url;
        },
        "url = \"fleet.sqlite\"");
    problems.in([&] { config.keep_s = read_keep(*store); }, "keep = \"5 years\"");
  });
  problems.in_table(root, "http", [&] {
    if (const auto http = root.table("http")) config.http = read_http(*http);
  });
  problems.in_table(root, "publish", [&] {
    if (const auto publish = root.table("publish")) config.publish = read_publish(*publish);
  });
  problems.in_table(root, "webhook", [&] {
    if (const auto webhook = root.table("webhook")) config.webhook = read_webhook(*webhook);
  });
  problems.in_table(root, "limits", [&] {
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

}  // namespace

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
  MonitorConfig rest;
  read_own_tables(root, rest, problems);
  for (const char* key : {"reading", "source", "alarm"}) {
    problems.in([&] {
      if (!root.has(key))
        root.fail(key, "is missing; wearwell new monitor NAME --from RESULT writes it");
    });
  }
  problems.in([&] { refuse_unknown_tables(root); });
  problems.finish();
  return result;
}

MonitorConfig read_monitor_config(const TomlReader& root, const prognosis::Tracker& tracker) {
  MonitorConfig config;
  config.folder = folder_of(root);
  root.has("result");
  Problems problems;
  read_own_tables(root, config, problems);
  problems.in([&] { read_sources(root, tracker, config, problems); });
  problems.in([&] {
    const auto posts = [](const SourceSettings& each) { return each.kind == SourceKind::http; };
    if (!root.has("http") && std::any_of(config.sources.begin(), config.sources.end(), posts))
      root.fail("http",
                "is missing: a source of kind \"http\" needs a server, [http]; for example:\n    "
                "[http]\n    listen = \"127.0.0.1:8080\"");
  });
  problems.in_table(root, "alarm", [&] { config.alarm = read_alarm(root, tracker); });
  if (problems.empty()) {
    root.finish();
  } else {
    problems.in([&] { refuse_unknown_tables(root); });
  }
  problems.finish();
  return config;
}

}  // namespace wearwell::monitor
