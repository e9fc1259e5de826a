#include "wearwell/base/progress.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

namespace wearwell {
namespace {

TEST(Progress, TellsHowFar) {
  std::vector<Step> reported;
  const Monitor monitor{.progress = [&](const Step& step) { reported.push_back(step); }};
  Progress progress(monitor, "iterations");
  progress.advance(100);
  ASSERT_EQ(reported.size(), 1u);
  EXPECT_EQ(reported[0].what, "iterations");
  EXPECT_EQ(reported[0].done, 100);
  EXPECT_EQ(reported[0].total, 0);
}

// A part is not charged with the time of the one before.
TEST(Progress, TimesEachPartFromItsBeginning) {
  std::vector<std::string> what;
  std::vector<Step> reported;
  const Monitor monitor{.progress = [&](const Step& step) {
    what.emplace_back(step.what);
    reported.push_back(step);
  }};
  Progress progress(monitor, "evaluations");
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  progress.advance(100);
  progress.begin("iterations", 400);
  std::this_thread::sleep_for(std::chrono::milliseconds(110));
  progress.advance(200);
  ASSERT_EQ(reported.size(), 3u);
  EXPECT_EQ(what, (std::vector<std::string>{"evaluations", "iterations", "iterations"}));
  EXPECT_GE(reported[0].seconds, 0.4);
  EXPECT_EQ(reported[1].done, 0);
  EXPECT_EQ(reported[1].total, 400);
  EXPECT_EQ(reported[2].done, 200);
  EXPECT_LT(reported[2].seconds, reported[0].seconds);
}

TEST(Progress, CountsTheStepsOfAllThreads) {
  long long done = 0;
  const Monitor monitor{.progress = [&](const Step& step) { done = step.done; }};
  Progress progress(monitor, "iterations");
  const auto work = [&] {
    ProgressSteps steps(&progress);
    for (int i = 0; i < 1050; ++i) steps.step();
  };
  std::thread a(work), b(work);
  a.join();
  b.join();
  std::this_thread::sleep_for(std::chrono::milliseconds(150));
  progress.advance(1);
  EXPECT_EQ(done, 2001);  // a thread hands on whole hundreds
}

TEST(Progress, StopsTheWork) {
  std::stop_source source;
  const Monitor monitor{.stop = source.get_token()};
  Progress progress(monitor, "iterations");
  ProgressSteps steps(&progress);
  for (int i = 0; i < 1000; ++i) steps.step();
  source.request_stop();
  EXPECT_THROW(
      {
        for (int i = 0; i < 100; ++i) steps.step();
      },
      Cancelled);
}

TEST(Progress, NobodyToTellIsNoError) {
  const Monitor monitor;
  Progress progress(monitor, "iterations");
  progress.advance(10);
  ProgressSteps(nullptr).step();
}

}  // namespace
}  // namespace wearwell
