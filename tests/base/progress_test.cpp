#include "wearwell/base/progress.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <thread>

namespace wearwell {
namespace {

using testing::HasSubstr;
using namespace std::chrono_literals;

// What `work` shows of itself.
template <class Work>
std::string shown(std::chrono::milliseconds patience, const Work& work) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* file = open_memstream(&text, &size);
  {
    Progress progress(file, "iterations", patience);
    work(progress);
  }
  std::fclose(file);
  const std::string out(text, size);
  std::free(text);
  return out;
}

TEST(Progress, SaysHowFarAndWipesItself) {
  const std::string out = shown(0ms, [](Progress& progress) {
    progress.expect(400);
    progress.advance(100);
  });
  EXPECT_THAT(out, testing::StartsWith("\r  100 iterations, "));
  EXPECT_THAT(out, HasSubstr(" a second, 25 %, "));
  EXPECT_THAT(out, testing::EndsWith(" s left\033[K\r\033[K"));
}

TEST(Progress, ShowsNothingOfShortWork) {
  EXPECT_EQ(shown(1h, [](Progress& progress) { progress.advance(100); }), "");
}

TEST(Progress, CountsTheStepsOfAllThreads) {
  const std::string out = shown(0ms, [](Progress& progress) {
    const auto work = [&] {
      ProgressSteps steps(&progress);
      for (int i = 0; i < 1050; ++i) steps.step();
    };
    std::thread a(work), b(work);
    a.join();
    b.join();
    std::this_thread::sleep_for(150ms);
    progress.advance(1);
  });
  EXPECT_THAT(out, HasSubstr("\r  2101 iterations"));
}

TEST(Progress, NowhereToShowIsNoError) {
  Progress progress(nullptr, "iterations", 0ms);
  progress.advance(10);
  ProgressSteps(nullptr).step();
}

}  // namespace
}  // namespace wearwell
