#pragma once

#include <pybind11/functional.h>
#include <pybind11/pybind11.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <tuple>
#include <utility>

#include "core.h"
#include "wearwell/base/monitor.h"

namespace wearwell::python {

/// Work on a thread of its own, while this one looks for Ctrl-C and tells of progress.
class Attended {
 public:
  explicit Attended(py::object progress) : progress_(std::move(progress)) {}

  /// Returns when `work` has ended, with what it threw; or, where Python raised meanwhile, with that.
  template <class Work>
  void run(const Work& work) {
    std::exception_ptr thrown;
    std::optional<py::error_already_set> raised;
    std::thread worker([&] {
      try {
        work();
      } catch (...) {
        thrown = std::current_exception();
      }
      const std::lock_guard lock(mutex_);
      done_ = true;
      changed_.notify_all();
    });
    for (bool done = false; !done;) {
      {
        const py::gil_scoped_release release;
        std::unique_lock lock(mutex_);
        done = changed_.wait_for(lock, look_every, [&] { return done_; });
      }
      if (raised) continue;
      try {
        attend();
      } catch (py::error_already_set& error) {
        raised.emplace(std::move(error));
        stop_.request_stop();
      }
    }
    {
      const py::gil_scoped_release release;
      worker.join();
    }
    if (raised) throw std::move(*raised);
    if (thrown) std::rethrow_exception(thrown);
  }

  std::stop_token stop() const { return stop_.get_token(); }

  Monitor monitor(int threads) {
    Monitor monitor{.stop = stop_.get_token(), .threads = threads};
    if (!progress_.is_none()) {
      monitor.progress = [this](const Step& step) {
        const std::lock_guard lock(mutex_);
        step_ = {std::string(step.what), step.done, step.total, step.seconds};
        fresh_ = true;
      };
    }
    return monitor;
  }

 private:
  static constexpr std::chrono::milliseconds look_every{50};

  void attend() {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    std::tuple<std::string, long long, long long, double> step;
    {
      const std::lock_guard lock(mutex_);
      if (!std::exchange(fresh_, false)) return;
      step = step_;
    }
    const auto& [what, done, total, seconds] = step;
    progress_(what, done, total, seconds);
  }

  py::object progress_;
  std::stop_source stop_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::tuple<std::string, long long, long long, double> step_;
  bool fresh_ = false, done_ = false;
};

}  // namespace wearwell::python
