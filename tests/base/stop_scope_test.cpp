#include "wearwell/base/stop_scope.h"

#include <gtest/gtest.h>

#include <memory>
#include <stop_token>

#include "wearwell/base/monitor.h"
#include "wearwell/base/workers.h"

namespace wearwell {
namespace {

std::shared_ptr<StopSignal> signal_of(const std::stop_source& source) {
  auto signal = std::make_shared<StopSignal>();
  signal->requested = source.get_token();
  return signal;
}

TEST(StopScope, ARequestStopsTheWorkOfTheScopeAlone) {
  std::stop_source stop;
  EXPECT_NO_THROW(check_stop());
  {
    const StopScope scope(signal_of(stop));
    EXPECT_NO_THROW(check_stop());
    stop.request_stop();
    EXPECT_THROW(check_stop(), Cancelled);
    {
      const StopScope other(signal_of(std::stop_source()));
      EXPECT_NO_THROW(check_stop());
    }
    EXPECT_THROW(check_stop(), Cancelled);
  }
  EXPECT_NO_THROW(check_stop());
}

TEST(StopScope, WorkThatHasEndedIsNotStopped) {
  std::stop_source stop;
  stop.request_stop();
  const auto signal = signal_of(stop);
  const StopScope scope(signal);
  signal->ended = true;
  EXPECT_NO_THROW(check_stop());
}

TEST(StopScope, WorkersHaveTheSignalOfTheirCaller) {
  std::stop_source stop;
  stop.request_stop();
  run_workers(3, [](int) { EXPECT_NO_THROW(check_stop()); });
  const StopScope scope(signal_of(stop));
  run_workers(3, [](int) { EXPECT_THROW(check_stop(), Cancelled); });
  EXPECT_THROW(run_tasks(5, 2, [](int) { check_stop(); }), Cancelled);
}

}  // namespace
}  // namespace wearwell
