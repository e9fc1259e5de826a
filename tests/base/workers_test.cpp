#include "wearwell/base/workers.h"

#include <gmock/gmock.h>

#include <atomic>
#include <barrier>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace wearwell {
namespace {

TEST(Workers, EachRunsOnceOnAThreadOfItsOwn) {
  std::barrier all(3);  // would wait for ever if two shared a thread
  std::mutex mutex;
  std::set<std::thread::id> ids;
  std::multiset<int> ran;
  run_workers(3, [&](int worker) {
    all.arrive_and_wait();
    const std::lock_guard lock(mutex);
    ids.insert(std::this_thread::get_id());
    ran.insert(worker);
  });
  EXPECT_EQ(ids.size(), 3u);
  EXPECT_TRUE(ids.contains(std::this_thread::get_id()));
  EXPECT_THAT(ran, testing::ElementsAre(0, 1, 2));
}

TEST(Workers, TheExceptionOfAnyWorkerIsRethrownAfterAllHaveEnded) {
  std::atomic<int> ended = 0;
  const auto work = [&](int worker) {
    if (worker == 1) throw std::runtime_error("worker 1");
    ++ended;
  };
  EXPECT_THAT([&] { run_workers(4, work); },
              testing::ThrowsMessage<std::runtime_error>("worker 1"));
  EXPECT_EQ(ended, 3);
}

TEST(Workers, EveryTaskRunsOnceWhateverTheThreads) {
  for (const int threads : {1, 2, 7}) {
    std::vector<std::atomic<int>> runs(100);
    run_tasks(100, threads, [&](int task) { ++runs[task]; });
    for (const auto& each : runs) EXPECT_EQ(each, 1);
  }
  run_tasks(0, 4, [](int) { FAIL() << "no task was asked for"; });
}

TEST(Workers, NoTaskIsStartedAfterOneThatThrew) {
  int ran = 0;
  EXPECT_THROW(run_tasks(100, 1,
                         [&](int task) {
                           ++ran;
                           if (task == 4) throw std::runtime_error("task 4");
                         }),
               std::runtime_error);
  EXPECT_EQ(ran, 5);
}

}  // namespace
}  // namespace wearwell
