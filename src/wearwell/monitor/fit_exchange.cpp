#include "wearwell/monitor/fit_exchange.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "wearwell/base/printable.h"
#include "wearwell/monitor/source.h"

namespace wearwell::monitor {

FitExchange::FitExchange(ResultSource source, Population present, const FleetReader& running,
                         MakeFleet make_fleet, Notices& notices, std::function<void()> wake)
    : source_(std::move(source)),
      running_(running),
      make_fleet_(std::move(make_fleet)),
      notices_(notices),
      wake_(std::move(wake)),
      present_(std::move(present)),
      watch_(source_.folder),
      thread_([this](const std::stop_token& stop) { watch(stop); }) {}

FitExchange::~FitExchange() {
  thread_.request_stop();
  thread_.join();
}

std::optional<FitExchange::Ready> FitExchange::ready() {
  const std::lock_guard lock(lock_);
  return std::exchange(ready_, std::nullopt);
}

std::unique_lock<std::mutex> FitExchange::hold() {
  std::unique_lock building(building_, std::try_to_lock);
  const std::lock_guard lock(lock_);
  return building && !ready_ ? std::move(building) : std::unique_lock<std::mutex>();
}

void FitExchange::watch(const std::stop_token& stop) {
  constexpr auto between = std::chrono::milliseconds(500);
  // Another one may have come between the start and the first look.
  bool changed_before = written_ms(source_.folder) != present_.written_ms;
  while (pause(between, stop)) {
    const bool changed = watch_.changed() || std::exchange(changed_before, false);
    const bool asked = requested_.exchange(false);
    if (!changed && !asked) continue;
    if (asked) watch_.reset();
    try {
      look(asked, stop);
    } catch (const std::exception& error) {
      refuse(error.what());
    }
  }
}

void FitExchange::refuse(const std::string& why) {
  notices_.tell("result",
                fmt::format("{}: {}; forecasts still come from the earlier fit {}",
                            source_.folder.string(), why, present_.fingerprint.substr(0, 7)));
}

std::string FitExchange::left_out(Fleet& next, const std::stop_token& stop) const {
  constexpr auto between = std::chrono::milliseconds(200);
  for (;;) {
    bool waits = false;
    for (const UnitView& each : next.units("", 0, SIZE_MAX)) {
      const std::uint64_t out = each.quality.not_counted;
      if (out == 0) continue;
      const std::optional<UnitView> now = running_.view(each.unit);
      if (now && now->quality.not_counted >= out) continue;
      if (now && now->quality.readings == each.quality.readings)
        return fmt::format(
            "it leaves out {} reading{} of {} '{}', of which the running fit leaves out {}: {}",
            out, out == 1 ? "" : "s", next.fleet().noun, printable(each.unit),
            now->quality.not_counted, each.quality.state_problem);
      waits = true;  // one of the two is behind
    }
    if (!waits || !pause(between, stop)) return {};
    try {
      next.apply();
      next.refresh(true);
    } catch (const StoreError& error) {
      notices_.tell("store", error.what());
    }
  }
}

void FitExchange::look(bool asked, const std::stop_token& stop) {
  if (const std::string why = incomplete_result(source_.folder); !why.empty()) return refuse(why);
  const Population now = source_.read();
  if (now.fingerprint == present_.fingerprint) {
    if (asked)
      notices_.tell("result", fmt::format("{} has the fit {} that forecasts come from",
                                          source_.folder.string(), now.fingerprint.substr(0, 7)));
    return;
  }
  const std::lock_guard building(building_);
  std::shared_ptr<Fleet> fleet;
  // Until the store can be read.
  for (auto wait = std::chrono::milliseconds(200);;
       wait = std::min(2 * wait, decltype(wait)(5000))) {
    try {
      if (!fleet) {
        if (const std::string why = misfit(present_, now, {}); !why.empty()) return refuse(why);
        fleet = make_fleet_(now);
      }
      while (fleet->apply() > 0) {
        if (stop.stop_requested()) return;
      }
      while (!fleet->refresh()) {
        if (stop.stop_requested()) return;
      }
      break;
    } catch (const StoreError& error) {
      notices_.tell("store", error.what());
      if (!pause(wait, stop)) return;
    }
  }
  std::vector<std::string> units;
  for (const UnitView& each : fleet->units("", 0, SIZE_MAX)) units.push_back(each.unit);
  for (const auto& [unit, events] : fleet->events())
    for (const UnitPart& each : events->parts())
      if (!each.name.empty()) units.push_back(each.name);
  if (const std::string why = misfit(present_, now, units); !why.empty()) return refuse(why);
  if (const std::string why = left_out(*fleet, stop); !why.empty()) return refuse(why);
  if (stop.stop_requested()) return;
  present_ = now;
  {
    const std::lock_guard lock(lock_);
    ready_ = Ready{now, std::move(fleet)};
  }
  wake_();
}

}  // namespace wearwell::monitor
