#include "wearwell/monitor/monitor_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <csignal>
#include <deque>
#include <thread>

#include "wearwell/base/error.h"
#include "wearwell/base/workers.h"
#include "wearwell/monitor/http_server.h"
#include "wearwell/monitor/intake.h"
#include "wearwell/monitor/publisher.h"
#include "wearwell/monitor/source.h"

namespace wearwell::monitor {
namespace {

using Clock = std::chrono::steady_clock;

std::atomic<bool> signal_arrived = false;
static_assert(std::atomic<bool>::is_always_lock_free);
extern "C" void note_signal(int) {
  signal_arrived = true;
}

/// While it lives, the signals that end a program are queued until polled. New threads leave them
/// to it and are not interrupted; existing ones (workers that read the result) note those that
/// reach them. An ignored signal stays ignored.
class EndingSignals {
 public:
  EndingSignals() {
    signal_arrived = false;
    struct sigaction noting = {};
    noting.sa_handler = note_signal;
    noting.sa_flags = SA_RESTART;
    sigemptyset(&blocked_);
    for (std::size_t i = 0; i < signals.size(); ++i) {
      sigaction(signals[i], nullptr, &actions_before_[i]);
      if (actions_before_[i].sa_handler == SIG_IGN) continue;
      sigaction(signals[i], &noting, nullptr);
      sigaddset(&blocked_, signals[i]);
    }
    pthread_sigmask(SIG_BLOCK, &blocked_, &mask_before_);
  }
  ~EndingSignals() {
    for (std::size_t i = 0; i < signals.size(); ++i)
      sigaction(signals[i], &actions_before_[i], nullptr);
    pthread_sigmask(SIG_SETMASK, &mask_before_, nullptr);
  }
  EndingSignals(const EndingSignals&) = delete;
  EndingSignals& operator=(const EndingSignals&) = delete;

  bool arrived() const {
    constexpr timespec at_once = {0, 0};
    return signal_arrived || sigtimedwait(&blocked_, nullptr, &at_once) > 0;
  }

 private:
  static constexpr std::array signals = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, signals.size()> actions_before_ = {};
  sigset_t blocked_, mask_before_;
};

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

/// Keeps a fleet up to date with its store.
class Follower {
 public:
  Follower(Fleet& fleet, Notices& notices) : fleet_(fleet), notices_(notices) {}

  /// One round; false if there is nothing to do now.
  bool round() {
    constexpr auto between_saves = std::chrono::seconds(30);
    bool busy = false;
    const bool good = guarded([&] {
      busy = fleet_.apply() > 0;
      busy = !fleet_.refresh() || busy;
      if (Clock::now() - saved_ < between_saves) return;
      saved_ = Clock::now();
      fleet_.save();
    });
    return busy && good;
  }

  /// Processes all readings and then saves the states: with retries for a while, should the store
  /// not respond.
  void finish() {
    constexpr int attempts = 20;
    for (int i = 0; i < attempts; ++i) {
      const bool good = guarded([&] {
        while (fleet_.apply() > 0) {
        }
        fleet_.refresh(true);
        fleet_.save();
      });
      if (good) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    notices_.tell("store", "the states could not be saved; they will be rebuilt from the readings");
  }

 private:
  bool guarded(const std::function<void()>& work) {
    try {
      work();
      return true;
    } catch (const StoreError& error) {
      notices_.tell("store", error.what());
      return false;
    }
  }

  Fleet& fleet_;
  Notices& notices_;
  Clock::time_point saved_ = Clock::now();
};

/// The server and the publisher, while they live.
class Outlets {
 public:
  Outlets(const MonitorConfig& config, const MonitorOptions& options, const Fleet& fleet,
          Intake& intake, const prognosis::Tracker& tracker, Notices& notices)
      : events_(intake, tracker, !config.sequence) {
    if (options.once) return;
    for (const SourceSettings& source : config.sources) {
      if (source.kind == SourceKind::http) inbox_ = std::make_unique<SourceInbox>(intake, source);
    }
    if (config.http)
      server_ = std::make_unique<HttpServer>(*config.http, fleet, inbox_.get(),
                                             config.http->events ? &events_ : nullptr);
    if (config.publish)
      publisher_ = std::jthread([&](std::stop_token stop) {
        publish_states(fleet, *config.publish, notices, std::move(stop));
      });
  }
  std::string address() const { return server_ ? server_->address() : std::string(); }

 private:
  EventInbox events_;
  std::unique_ptr<SourceInbox> inbox_;
  std::unique_ptr<HttpServer> server_;
  std::jthread publisher_;
};

/// Processes what the store has. States are saved on the way, and at the end: a monitor that is
/// killed again and again, each time before its regular save, would otherwise start from ever
/// older states.
void catch_up(Fleet& fleet, const EndingSignals& signals) {
  constexpr auto between_saves = std::chrono::seconds(5);
  Clock::time_point saved = Clock::now();
  while (fleet.apply() > 0 && !signals.arrived()) {
    if (Clock::now() - saved < between_saves) continue;
    fleet.save();
    saved = Clock::now();
  }
  fleet.save();
  fleet.refresh(true);
}

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

void run_monitor(const MonitorConfig& config, const Population& population,
                 const MonitorOptions& options, const Begun& started,
                 const std::function<void(const Fleet&)>& ended) {
  if (options.once) refuse_endless_sources(config);
  const EndingSignals signals;
  Notices notices(stderr);
  Tally tally(config.most_units);
  const auto store =
      open_store(config.store, config.folder, store_columns(config, population.tracker),
                 Access::write, [&](const std::string& what) { notices.tell("store", what); });
  FleetSettings settings;
  settings.title = config.title;
  settings.trusted = population.trusted;
  settings.population = population.fingerprint;
  settings.alarm = config.alarm;
  settings.threads = threads_or_all(options.threads);
  settings.keys_are_times = !config.sequence;
  const bool tells = !options.once;
  settings.on_alarm = [&](const AlarmChange& change, Alarm before, const UnitView& unit) {
    if (tells)
      notices.tell(
          fmt::format("unit '{}'", change.unit),
          fmt::format("{} -> {}, risk {:.3g}{}{}{}", name(before), name(change.alarm), change.risk,
                      unit.beyond ? ", the last reading is beyond the limit" : "",
                      unit.doubt.empty() ? "" : "; in doubt: ", unit.doubt));
  };
  Fleet fleet(population.tracker, *store, tally, notices, std::move(settings));
  catch_up(fleet, signals);
  WakeSignal wake;
  Intake intake(*store, tally, notices, [&] { wake.ring(); });
  const Outlets outlets(config, options, fleet, intake, population.tracker, notices);
  started(fleet, outlets.address());
  Sources sources(config, options.once, intake, *store, notices, wake);
  Follower follower(fleet, notices);
  while (!signals.arrived()) {
    constexpr auto patience = std::chrono::milliseconds(50);
    const bool over = sources.ended();
    if (!follower.round()) {
      if (over) break;
      wake.wait(patience);
    }
  }
  sources.stop();
  follower.finish();
  ended(fleet);
}

}  // namespace wearwell::monitor
