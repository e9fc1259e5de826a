#include "wearwell/base/stoppable.h"

#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>

#include <memory>
#include <utility>

#include "wearwell/base/stop_scope.h"

namespace wearwell {
namespace {

// Hands the signal to each thread of the pool that joins the work of this thread.
class SignalOfWorkers : public tbb::task_scheduler_observer {
 public:
  explicit SignalOfWorkers(std::shared_ptr<StopSignal> signal) : signal_(std::move(signal)) {
    observe(true);
  }
  ~SignalOfWorkers() override {
    // A thread of the pool may keep the signal for a while; it must not stop its next work.
    signal_->ended = true;
    observe(false);
  }
  void on_scheduler_entry(bool is_worker) override {
    if (is_worker) set_stop_signal(signal_);
  }
  void on_scheduler_exit(bool is_worker) override {
    if (is_worker) set_stop_signal(nullptr);
  }

 private:
  const std::shared_ptr<StopSignal> signal_;
};

}  // namespace

void stoppable(std::stop_token stop, const std::function<void()>& work) {
  const auto signal = std::make_shared<StopSignal>();
  signal->requested = std::move(stop);
  const StopScope scope(signal);
  const SignalOfWorkers workers(signal);
  work();
}

}  // namespace wearwell
