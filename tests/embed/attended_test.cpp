#include "wearwell/embed/attended.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "wearwell/base/stop_scope.h"

namespace wearwell::embed {
namespace {

struct Away {
  Away() { ++begun; }
  ~Away() { ++ended; }
  inline static int begun = 0, ended = 0;
};

// Work as the library's: it looks at the stop token, and says so when it is stopped.
void wait_until_stopped(const Monitor& monitor) {
  while (!monitor.stop.stop_requested()) std::this_thread::yield();
  throw Cancelled();
}

TEST(Attended, WorkIsDoneOnAnotherThreadAndItsExceptionComesOut) {
  const auto here = std::this_thread::get_id();
  std::thread::id there;
  attended<Away>([&](const Monitor&) { there = std::this_thread::get_id(); }, [](const auto&) {});
  EXPECT_NE(there, here);
  EXPECT_NE(there, std::thread::id());
  EXPECT_THROW(
      attended<Away>([](const Monitor&) { throw std::out_of_range("work"); }, [](const auto&) {}),
      std::out_of_range);
}

TEST(Attended, WhatTheOnLookerThrowsStopsTheWorkAndComesOut) {
  const auto here = std::this_thread::get_id();
  EXPECT_THROW(attended<Away>(wait_until_stopped,
                              [&](const auto&) {
                                EXPECT_EQ(std::this_thread::get_id(), here);
                                throw std::domain_error("Ctrl-C");
                              }),
               std::domain_error);
}

// Loops of the library without a Monitor, on the pool of threads.
void loop_until_stopped(const Monitor&) {
  tbb::parallel_for(0, 1000, [](int) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(100);
    while (std::chrono::steady_clock::now() < until) check_stop();
  });
}

TEST(Attended, LoopsWithoutAMonitorStopToo) {
  const auto ctrl_c = [](const auto&) { throw std::domain_error("Ctrl-C"); };
  EXPECT_THROW(attended<Away>(loop_until_stopped, ctrl_c), std::domain_error);
}

TEST(Attended, WhatStoppedOneWorkDoesNotStopTheNext) {
  const auto ctrl_c = [](const auto&) { throw std::domain_error("Ctrl-C"); };
  for (int i = 0; i < 5; ++i) {
    EXPECT_THROW(attended<Away>(loop_until_stopped, ctrl_c), std::domain_error);
    const auto short_loop = [](const Monitor&) {
      tbb::parallel_for(0, 1000, [](int) { check_stop(); });
    };
    EXPECT_NO_THROW(attended<Away>(short_loop, [](const auto&) {}));
    EXPECT_NO_THROW(tbb::parallel_for(0, 1000, [](int) { check_stop(); }));
  }
}

TEST(Attended, TheLastStepBeforeALookIsTold) {
  std::vector<ProgressSnapshot> steps;
  attended<Away>(
      [](const Monitor& monitor) {
        monitor.progress({"parts", 1, 3, 0.5});
        monitor.progress({"parts", 2, 3, 1.5});
      },
      [&](const std::optional<ProgressSnapshot>& reported) {
        if (reported) steps.push_back(*reported);
      });
  ASSERT_FALSE(steps.empty());
  EXPECT_EQ(steps.back().what, "parts");
  EXPECT_EQ(steps.back().done, 2);
  EXPECT_EQ(steps.back().total, 3);
  EXPECT_EQ(steps.back().seconds, 1.5);
}

TEST(Attended, WhatIsHeldWhileWaitingIsTakenBackBeforeEveryLook) {
  attended<Away>([](const Monitor&) {}, [](const auto&) { EXPECT_EQ(Away::begun, Away::ended); });
  EXPECT_EQ(Away::begun, Away::ended);
}

}  // namespace
}  // namespace wearwell::embed
