#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "wearwell/monitor/fleet.h"
#include "wearwell/monitor/notices.h"
#include "wearwell/monitor/population.h"
#include "wearwell/monitor/result_watch.h"

namespace wearwell::monitor {

/// Watches the folder of results. When a whole one of the same study is there, a fleet of its
/// population is built from the store, beside the running one, on a thread of its own. One that
/// does not fit is reported, and the running one goes on.
class FitExchange {
 public:
  /// Makes a fleet beside the running one, with nothing applied yet.
  using MakeFleet = std::function<std::shared_ptr<Fleet>(const Population& population)>;
  struct Ready {
    Population population;
    std::shared_ptr<Fleet> fleet;
  };

  /// `present`: the running population, `running`: its fleet. `running` and `notices` must outlive
  /// it. `wake` is called when a fleet is ready.
  FitExchange(ResultSource source, Population present, const FleetReader& running,
              MakeFleet make_fleet, Notices& notices, std::function<void()> wake);
  ~FitExchange();

  /// Asks for a look at the result, whether it has changed or not.
  void request() { requested_ = true; }
  /// The fleet that is ready to take the place of the running one, once.
  std::optional<Ready> ready();
  /// Holds back the next fleet while it lives, so that no fleet is built from readings that are
  /// being removed; empty while one is built, or waits.
  std::unique_lock<std::mutex> hold();

 private:
  void watch(const std::stop_token& stop);
  void look(bool asked, const std::stop_token& stop);
  void refuse(const std::string& why);
  /// Why the forecast of a unit by `next` leaves out readings that the running one counts; empty if
  /// none does, or if it is stopped.
  std::string left_out(Fleet& next, const std::stop_token& stop) const;

  const ResultSource source_;
  const FleetReader& running_;
  const MakeFleet make_fleet_;
  Notices& notices_;
  const std::function<void()> wake_;
  Population present_;  ///< or the one that is ready; of the thread
  ResultWatch watch_;
  std::atomic<bool> requested_ = false;
  std::mutex lock_, building_;
  std::optional<Ready> ready_;
  std::jthread thread_;
};

}  // namespace wearwell::monitor
