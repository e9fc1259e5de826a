#include "wearwell/monitor/store.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/monitor/alarm.h"
#include "wearwell/monitor/postgres_store.h"
#include "wearwell/monitor/sqlite_store.h"

namespace wearwell::monitor {
namespace {

constexpr std::string_view unconfirmed = " unconfirmed";

}  // namespace

std::string text_of(const SentAlarm& sent) {
  return std::string(name(sent.alarm)) + (sent.unconfirmed ? std::string(unconfirmed) : "");
}

SentAlarm sent_alarm(std::string_view text) {
  const bool open = text.ends_with(unconfirmed);
  if (open) text.remove_suffix(unconfirmed.size());
  return {alarm_named(text), open};
}

bool is_postgres(const std::string& url) {
  return url.starts_with("postgresql://") || url.starts_with("postgres://");
}

std::string shown_store(const std::string& url) {
  return is_postgres(url) ? shown_url(url) : url;
}

void check_place(const std::string& url, const std::filesystem::path& folder) {
  if (is_postgres(url)) return check_postgres_place(url);
  check_sqlite_place(folder / url);
}

std::unique_ptr<Store> open_store(const std::string& url, const std::filesystem::path& folder,
                                  const StoreColumns& columns, Access access,
                                  const StoreNotice& reported) {
  if (is_postgres(url)) return open_postgres_store(url, columns, access, reported);
  return open_sqlite_store(folder / url, columns, access, reported);
}

int check_store(const std::string& name, const std::string& version, const StoreColumns& there,
                const StoreColumns& wanted, Access access) {
  int number = 0;
  const auto [rest, error] =
      std::from_chars(version.data(), version.data() + version.size(), number);
  const bool known = error == std::errc() && rest == version.data() + version.size() &&
                     number >= 1 && number <= store_version;
  if (!known)
    throw InputError(
        fmt::format("{} is a store of version '{}'; this wearwell reads versions 1 to {}: a later "
                    "version wrote it, or it is damaged",
                    name, printable(shortened(version)), store_version));
  const auto differ = [&](const char* what, const auto& kept, const auto& asked) {
    if (kept == asked) return;
    throw InputError(
        fmt::format("{} has readings with the {} {}, but the result in the configuration has {}; "
                    "use another store",
                    name, what, printable(json_of(kept)), printable(json_of(asked))));
  };
  differ("columns", there.numbers, wanted.numbers);
  differ("labels", there.labels, wanted.labels);
  if (there.sequence != wanted.sequence)
    throw InputError(fmt::format(
        "{} identifies readings by their {}, but the configuration by their {}; use another store",
        name, there.sequence ? "sequence numbers" : "times",
        wanted.sequence ? "sequence numbers" : "times"));
  if (number < store_version && access == Access::read)
    throw InputError(
        fmt::format("{} is a store of version {}, and this wearwell reads version {}; start "
                    "wearwell monitor to upgrade it",
                    name, number, store_version));
  return number;
}

std::string migrated_text(const std::string& name, int from) {
  return fmt::format("{} had version {} and is now upgraded to version {}", name, from,
                     store_version);
}

bool is_among_removed(const UnitEvent& event, const std::optional<UnitEvent>& cancelled,
                      std::int64_t before_key) {
  if (event.kind == EventKind::cancelled)  // the event at the key itself ends what is removed
    return cancelled && changes_state(cancelled->kind) && cancelled->key <= before_key;
  return changes_state(event.kind) && event.key < before_key;
}

std::string json_of(const std::vector<double>& numbers) {
  std::string text = "[";
  for (const double each : numbers) {
    if (text.size() > 1) text += ',';
    text += std::isfinite(each) ? fmt::format("{}", each) : "null";
  }
  return text + ']';
}

std::string json_of(const std::vector<std::string>& texts) {
  return nlohmann::json(texts).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::vector<double> numbers_of(std::string_view json) {
  const auto damaged = [&] {
    return StoreError(fmt::format("'{}' is not a list of numbers", json));
  };
  std::vector<double> numbers;
  if (json.size() < 2 || json.front() != '[' || json.back() != ']') throw damaged();
  const char* at = json.data() + 1;
  const char* end = json.data() + json.size() - 1;
  while (at < end) {
    double value = std::numeric_limits<double>::quiet_NaN();
    if (*at == 'n') {
      at += 4;
    } else {
      const auto [rest, error] = std::from_chars(at, end, value);
      if (error != std::errc()) throw damaged();
      at = rest;
    }
    if (at > end || (at < end && *at != ',')) throw damaged();
    ++at;
    numbers.push_back(value);
  }
  return numbers;
}

std::vector<std::string> texts_of(std::string_view json) {
  if (json == "[]") return {};
  const auto list = nlohmann::json::parse(json, nullptr, false);
  if (!list.is_array()) throw StoreError(fmt::format("'{}' is not a list of texts", json));
  std::vector<std::string> texts;
  for (const auto& each : list) {
    if (!each.is_string()) throw StoreError(fmt::format("'{}' is not a list of texts", json));
    texts.push_back(each.get<std::string>());
  }
  return texts;
}

}  // namespace wearwell::monitor
