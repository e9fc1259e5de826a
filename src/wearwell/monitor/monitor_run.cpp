#include "wearwell/monitor/monitor_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <limits>
#include <thread>

#include "wearwell/base/error.h"
#include "wearwell/base/workers.h"
#include "wearwell/monitor/current_fleet.h"
#include "wearwell/monitor/fit_exchange.h"
#include "wearwell/monitor/fleet.h"
#include "wearwell/monitor/http_server.h"
#include "wearwell/monitor/intake.h"
#include "wearwell/monitor/learned_readings.h"
#include "wearwell/monitor/monitor_signals.h"
#include "wearwell/monitor/publisher.h"
#include "wearwell/monitor/retention.h"
#include "wearwell/monitor/save_schedule.h"
#include "wearwell/monitor/source.h"
#include "wearwell/monitor/starting_fleet.h"
#include "wearwell/monitor/time_text.h"
#include "wearwell/monitor/webhook.h"

// Longer than others: the parts of a running monitor, and how they begin and end.
namespace wearwell::monitor {
namespace {

using Clock = std::chrono::steady_clock;

/// Waiting readers of the store are woken by its writers.
class WakeSignal {
 public:
  void ring() {
    const std::lock_guard lock(lock_);
    rung_ = true;
    changed_.notify_all();
  }
  void wait(std::chrono::milliseconds time) {
    std::unique_lock lock(lock_);
    changed_.wait_for(lock, time, [&] { return rung_; });
    rung_ = false;
  }

 private:
  std::mutex lock_;
  std::condition_variable changed_;
  bool rung_ = false;
};

/// The threads of the sources.
class Sources {
 public:
  Sources(const MonitorConfig& config, bool once, Intake& intake, Store& store, Notices& notices,
          WakeSignal& wake);
  /// Whether all have ended and no source can deliver more.
  bool ended() const { return open_ == 0; }
  void stop();

 private:
  void run(SourceContext& context, std::stop_token stop);

  std::deque<SourceContext> contexts_;
  WakeSignal& wake_;
  std::atomic<int> open_ = 0;
  std::vector<std::jthread> threads_;
};

Sources::Sources(const MonitorConfig& config, bool once, Intake& intake, Store& store,
                 Notices& notices, WakeSignal& wake)
    : wake_(wake) {
  for (const SourceSettings& source : config.sources) {
    ++open_;
    if (source.kind == SourceKind::http) continue;  // the server's, which never ends
    contexts_.push_back({source, intake, store, notices, once});
  }
  for (SourceContext& context : contexts_)
    threads_.emplace_back([this, &context](std::stop_token stop) { run(context, stop); });
}

void Sources::run(SourceContext& context, std::stop_token stop) {
  try {
    switch (context.settings.kind) {
      case SourceKind::stdin:
        read_stream(context, STDIN_FILENO, stop);
        break;
      case SourceKind::folder:
        read_folder(context, stop);
        break;
      case SourceKind::mqtt:
        read_mqtt(context, stop);
        break;
      case SourceKind::sparkplug:
        read_sparkplug_source(context, stop);
        break;
      case SourceKind::http:
        break;
    }
  } catch (const std::exception& error) {
    context.notices.tell("source." + context.settings.name,
                         fmt::format("has ended: {}", error.what()));
  }
  --open_;
  wake_.ring();
}

void Sources::stop() {
  for (std::jthread& thread : threads_) thread.request_stop();
  for (std::jthread& thread : threads_) thread.join();
  threads_.clear();
}

/// Whether the store did the work; if not, why is reported.
bool guarded(Notices& notices, const std::function<void()>& work) {
  try {
    work();
    return true;
  } catch (const StoreError& error) {
    notices.tell("store", error.what());
    return false;
  }
}

/// The fleet, and what makes another one of it.
class RunningFleet {
 public:
  /// Notes the fit. Readers see that it is starting, until `start`. Throws InputError: the fit has
  /// learned readings of the store; StoreError.
  RunningFleet(const MonitorConfig& config, const Population& population,
               const MonitorOptions& options, Store& store, Tally& tally, Notices& notices);

  Fleet& fleet() { return *fleet_; }
  const CurrentFleet& readers() const { return *readers_; }
  PopulationChecks& checks() { return checks_; }
  WebhookCounts& webhook() { return webhook_; }
  /// Processes what the store had when the monitor began; false if it is to end before. States are
  /// saved on the way, and at the end: a monitor that is killed again and again, each time before
  /// its regular save, would otherwise start from ever older states. Should the store not respond,
  /// it tries again, for readings are accepted already; with --once it throws StoreError.
  bool start(MonitorSignals& signals);
  std::shared_ptr<Fleet> make_beside(const Population& population);
  /// Another fleet takes the place of the running one. Throws StoreError; it may be called again.
  void exchange(const FitExchange::Ready& ready);

 private:
  FleetSettings settings_of(const Population& population) const;
  std::shared_ptr<Fleet> make(const Population& population, FleetSettings settings);
  void note_fit();
  bool done(MonitorSignals& signals, const std::function<void()>& work);

  const MonitorConfig& config_;
  const MonitorOptions& options_;
  Store& store_;
  Tally& tally_;
  Notices& notices_;
  Population population_;
  WebhookCounts webhook_;
  PopulationChecks checks_;
  FleetSettings::Start start_;     ///< of the monitor
  const std::int64_t last_place_;  ///< in the store at the start
  std::shared_ptr<Fleet> fleet_;
  std::unique_ptr<CurrentFleet> readers_;
  std::int64_t fit_since_ms_ = 0;
  std::vector<MovedForecast> moved_;  ///< by the fit of the start
};

RunningFleet::RunningFleet(const MonitorConfig& config, const Population& population,
                           const MonitorOptions& options, Store& store, Tally& tally,
                           Notices& notices)
    : config_(config),
      options_(options),
      store_(store),
      tally_(tally),
      notices_(notices),
      population_(population),
      checks_(population.tracker),
      start_{unix_ms_now(), store.count()},
      last_place_(store.last_place()),
      readers_(
          std::make_unique<CurrentFleet>(std::make_shared<const StartingFleet>(start_.time_ms))) {
  // Sources begin before there is a fleet: what the store has is known to them.
  for (const std::string& each : store.units()) static_cast<void>(tally.admit(each));
  note_fit();
}

FleetSettings RunningFleet::settings_of(const Population& population) const {
  FleetSettings settings;
  settings.title = config_.title;
  settings.trusted = population.trusted;
  settings.population = population.fingerprint;
  settings.fit = {population.fingerprint, population.written_ms, 0};
  settings.alarm = config_.alarm;
  settings.start = start_;
  settings.threads = threads_or_all(options_.threads);
  settings.keys_are_times = !config_.sequence;
  if (config_.webhook) settings.webhook = [this] { return webhook_.view(); };
  settings.on_alarm = [this](const AlarmChange& change, Alarm before, const UnitView& unit) {
    if (options_.once) return;
    notices_.tell(
        fmt::format("unit '{}'", change.unit),
        fmt::format("{} -> {}, risk {:.3g}{}{}{}", name(before), name(change.alarm), change.risk,
                    unit.beyond ? ", the last reading is beyond the limit" : "",
                    unit.doubt.empty() ? "" : "; in doubt: ", unit.doubt));
  };
  return settings;
}

/// The tracker lives as long as the fleet.
std::shared_ptr<Fleet> RunningFleet::make(const Population& population, FleetSettings settings) {
  struct Owned {
    std::shared_ptr<const prognosis::Tracker> tracker;
    Fleet fleet;
  };
  const auto owned = std::shared_ptr<Owned>(new Owned{
      population.tracker, {*population.tracker, store_, tally_, notices_, std::move(settings)}});
  return {owned, &owned->fleet};
}

std::shared_ptr<Fleet> RunningFleet::make_beside(const Population& population) {
  FleetSettings settings = settings_of(population);
  settings.beside = true;
  return make(population, std::move(settings));
}

void RunningFleet::note_fit() {
  const std::vector<StoredFit> fits = store_.fits();
  const StoredFit fit{0, population_.fingerprint, unix_ms_now(), population_.written_ms,
                      population_.trusted};
  if (!fits.empty() && fits.back().population == fit.population) {
    fit_since_ms_ = fits.back().since_ms;
    moved_ = store_.moved(fits.back().number);
    sort_by_change(moved_);
  } else {
    refuse_learned(store_, population_.fingerprint, *population_.tracker);
    store_.begin_fit(fit, {});
    fit_since_ms_ = fit.since_ms;
  }
}

/// Repeats the work until the store has done it; false if the monitor is to end before.
bool RunningFleet::done(MonitorSignals& signals, const std::function<void()>& work) {
  constexpr auto patience = std::chrono::milliseconds(200);
  while (!signals.ends()) {
    if (options_.once) {
      work();
      return true;
    }
    if (guarded(notices_, work)) return true;
    std::this_thread::sleep_for(patience);
  }
  return false;
}

bool RunningFleet::start(MonitorSignals& signals) {
  if (!done(signals, [&] { fleet_ = make(population_, settings_of(population_)); })) return false;
  fleet_->set_moved(fit_since_ms_, std::move(moved_));
  SaveSchedule saves(std::chrono::seconds(5), 4, Clock::now());
  bool all = false;
  const auto piece = [&] {
    // Sources may deliver faster than states follow: what has come since is for later.
    all = fleet_->apply(last_place_, Fleet::small_piece) == 0;
    const Clock::time_point begin = Clock::now();
    if (!all && !saves.is_due(begin)) return;
    fleet_->save();
    saves.saved(begin, Clock::now());
    if (all) return;
    const std::int64_t reached_ms = unix_ms_now() - fleet_->fleet().lag_ms;
    notices_.tell("start", fmt::format("states include the readings stored until {}",
                                       iso_of_unix_ms(reached_ms)));
  };
  while (!all && done(signals, piece)) {
  }
  const auto ends = [&] { return signals.ends(); };
  if (!done(signals, [&] { fleet_->refresh(true, ends); }) || signals.ends()) {
    static_cast<void>(guarded(notices_, [&] { fleet_->save(); }));
    return false;
  }
  readers_->exchange(fleet_);
  return true;
}

void RunningFleet::exchange(const FitExchange::Ready& ready) {
  Fleet& next = *ready.fleet;
  // Forecasts of both are compared, so both must be of the same readings and events: those up to
  // the place that one of them has reached; the rest comes after the exchange.
  const std::int64_t last = std::max(fleet_->place(), next.place());
  do {
    fleet_->apply(last);
    next.apply(last);
  } while (fleet_->place() != next.place() || fleet_->last_event() != next.last_event());
  fleet_->refresh(true);
  next.refresh(true);
  const std::vector<MovedForecast> moved = moved_forecasts(*fleet_, next);
  const StoredFit fit{0, ready.population.fingerprint, unix_ms_now(), ready.population.written_ms,
                      ready.population.trusted};
  store_.begin_fit(fit, moved);
  next.set_moved(fit.since_ms, moved);
  next.take_over(*fleet_);
  readers_->exchange(ready.fleet);
  checks_.set(ready.population.tracker);
  fleet_ = ready.fleet;
  notices_.tell("result", fmt::format("forecasts come from the fit {} now, before {}; {}",
                                      ready.population.fingerprint.substr(0, 7),
                                      population_.fingerprint.substr(0, 7), moved_text(moved)));
  population_ = ready.population;
}

/// Keeps a fleet up to date with its store.
class Follower {
 public:
  Follower(RunningFleet& running, Retention& retention, Notices& notices)
      : running_(running), retention_(retention), notices_(notices) {}

  /// One round; false if there is nothing to do now.
  bool round() {
    bool busy = false;
    const bool good = guarded([&] {
      Fleet& fleet = running_.fleet();
      busy = take_readings(fleet);
      busy = !fleet.refresh() || busy;
      const Clock::time_point begin = Clock::now();
      if (!saves_.is_due(begin)) return;
      saves_.saved(begin, begin);  // should the store not respond
      fleet.save();
      saves_.saved(begin, Clock::now());
    });
    return busy && good;
  }

  /// Takes the fleet of another fit, as soon as the store responds.
  void take(FitExchange& exchange) {
    if (auto ready = exchange.ready()) next_ = std::move(ready);
    if (!next_) return;
    if (guarded([&] { running_.exchange(*next_); })) next_.reset();
  }

  /// Removes a piece of what need not be kept; false if there is nothing to do now. No fleet of
  /// another fit may be under way.
  bool remove_old(FitExchange* exchange) {
    std::unique_lock<std::mutex> held;
    if (exchange) held = exchange->hold();
    if (exchange && (!held || next_)) return false;
    bool busy = false;
    return guarded([&] { busy = retention_.round(running_.fleet()); }) && busy;
  }

  /// Processes all readings and then saves the states: with retries for a while, should the store
  /// not respond. After a signal it is not longer than service managers wait.
  void finish(MonitorSignals& signals) {
    constexpr int attempts = 20;
    constexpr auto longest = std::chrono::seconds(10);
    const Clock::time_point begin = Clock::now();
    const auto late = [&] { return signals.ends() && Clock::now() - begin > longest; };
    for (int i = 0; i < attempts; ++i) {
      bool all = false;
      if (guarded([&] { all = running_.fleet().finish(late); })) {
        if (!all)
          notices_.tell("end",
                        "ended before all stored readings are processed; the next start "
                        "continues from the saved states");
        return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    notices_.tell("store", "the states could not be saved; they will be rebuilt from the readings");
  }

 private:
  bool guarded(const std::function<void()>& work) { return monitor::guarded(notices_, work); }

  /// Readings for a second at most, then it is the turn of forecasts: where states are behind, units
  /// would wait for theirs for as long as it takes to process thousands of readings.
  static bool take_readings(Fleet& fleet) {
    constexpr std::size_t piece = 1000;
    const Clock::time_point begin = Clock::now();
    std::size_t taken = 0, last = 0;
    do {
      last = fleet.apply(std::numeric_limits<std::int64_t>::max(), piece);
      taken += last;
    } while (last == piece && Clock::now() - begin < std::chrono::seconds(1));
    return taken > 0;
  }

  RunningFleet& running_;
  Retention& retention_;
  Notices& notices_;
  std::optional<FitExchange::Ready> next_;
  SaveSchedule saves_{std::chrono::seconds(30), 9, Clock::now()};
};

/// The server, the publisher and the webhook, while they live.
class Outlets {
 public:
  /// Begins to serve.
  Outlets(const MonitorConfig& config, const MonitorOptions& options, RunningFleet& running,
          Intake& intake, const prognosis::Tracker& tracker)
      : config_(config),
        once_(options.once),
        running_(running),
        events_(intake, tracker, !config.sequence) {
    if (once_) return;
    running.checks().bind(events_.mapping());
    for (const SourceSettings& source : config.sources) {
      if (source.kind == SourceKind::http) inbox_ = std::make_unique<SourceInbox>(intake, source);
    }
    if (config.http)
      server_ = std::make_unique<HttpServer>(*config.http, running.readers(), inbox_.get(),
                                             config.http->events ? &events_ : nullptr);
  }
  /// Sends states and alarms from here on, once there are forecasts.
  void open(Store& store, Notices& notices) {
    if (once_) return;
    if (config_.publish)
      publisher_ = std::jthread([&](std::stop_token stop) {
        publish_states(running_.readers(), *config_.publish, notices, std::move(stop));
      });
    if (config_.webhook)
      webhook_ = std::jthread([&](std::stop_token stop) {
        send_alarms(running_.readers(), *config_.webhook, store, notices, running_.webhook(),
                    std::move(stop));
      });
  }
  std::string address() const { return server_ ? server_->address() : std::string(); }

 private:
  const MonitorConfig& config_;
  bool once_;
  RunningFleet& running_;
  EventInbox events_;
  std::unique_ptr<SourceInbox> inbox_;
  std::unique_ptr<HttpServer> server_;
  std::jthread publisher_, webhook_;
};

void refuse_endless_sources(const MonitorConfig& config) {
  for (const SourceSettings& source : config.sources) {
    if (source.kind != SourceKind::stdin && source.kind != SourceKind::folder)
      throw InputError(
          fmt::format("--once: source.{} has no end; use files or standard input", source.name));
  }
}

}  // namespace

StoreColumns store_columns(const MonitorConfig& config, const prognosis::Tracker& tracker) {
  StoreColumns columns;
  for (const prognosis::ReadingColumn& each : tracker.columns())
    columns.numbers.push_back(each.name);
  columns.labels.assign(tracker.labels().begin(), tracker.labels().end());
  columns.sequence = config.sequence;
  return columns;
}

void run_monitor(const MonitorConfig& configured, const Population& population,
                 const ResultSource& result, const MonitorOptions& options, const Begun& started,
                 const std::function<void(const FleetReader&)>& ended) {
  MonitorConfig config = configured;
  if (options.once) refuse_endless_sources(config);
  MonitorSignals signals;
  Notices notices(stderr);
  Tally tally(config.most_units);
  const auto store =
      open_store(config.store, config.folder, store_columns(config, *population.tracker),
                 Access::write, [&](const std::string& what) { notices.tell("store", what); });
  RunningFleet running(config, population, options, *store, tally, notices);
  for (SourceSettings& source : config.sources) running.checks().bind(source.mapping);
  WakeSignal wake;
  Intake intake(*store, tally, notices, [&] { wake.ring(); });
  // Readings are accepted from here on; how long the states take to follow depends on the store.
  Outlets outlets(config, options, running, intake, *population.tracker);
  Sources sources(config, options.once, intake, *store, notices, wake);
  if (!running.start(signals)) {
    notices.tell("start", "ended during the start; the next start continues from the saved states");
    return;
  }
  outlets.open(*store, notices);
  started(running.readers(), outlets.address());
  Retention retention(config.keep_s, *store, *population.tracker, notices);
  Follower follower(running, retention, notices);
  std::optional<FitExchange> exchange;
  if (!options.once)
    exchange.emplace(
        result, population, running.readers(),
        [&](const Population& next) { return running.make_beside(next); }, notices,
        [&] { wake.ring(); });
  while (!signals.ends()) {
    constexpr auto patience = std::chrono::milliseconds(50);
    const bool over = sources.ended();
    if (exchange) {
      if (signals.reload()) exchange->request();
      follower.take(*exchange);
    }
    const bool removes = !options.once && follower.remove_old(exchange ? &*exchange : nullptr);
    if (!follower.round() && !removes) {
      if (over) break;
      wake.wait(patience);
    }
  }
  exchange.reset();
  sources.stop();
  follower.finish(signals);
  if (options.once && config.keep_s) {
    while (!signals.ends() && follower.remove_old(nullptr)) {
    }
    follower.finish(signals);
  }
  ended(running.readers());
}

}  // namespace wearwell::monitor
