#include "wearwell/present/progress_line.h"

#include <gmock/gmock.h>

#include <cstdlib>

namespace wearwell {
namespace {

// What is shown of these steps.
std::string shown(double patience, const std::vector<Step>& steps) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* file = open_memstream(&text, &size);
  {
    ProgressLine line(file, patience);
    for (const Step& step : steps) line.show(step);
  }
  std::fclose(file);
  const std::string out(text, size);
  std::free(text);
  return out;
}

TEST(ProgressLine, SaysHowFarAndWipesItself) {
  EXPECT_EQ(shown(0, {{"iterations", 100, 400, 2}}),
            "\r  100 iterations, 50 a second, 25 %, 6 s left\033[K\r\033[K");
  EXPECT_EQ(shown(0, {{"iterations", 100, 0, 2}}), "\r  100 iterations, 50 a second\033[K\r\033[K");
}

TEST(ProgressLine, NamesAPartThatBegins) {
  EXPECT_EQ(shown(0, {{"leave-one-out", 0, 0, 0}}), "\r  leave-one-out\033[K\r\033[K");
}

TEST(ProgressLine, ShowsNothingOfShortWork) {
  EXPECT_EQ(shown(0.5, {{"iterations", 100, 400, 0.4}}), "");
}

TEST(ProgressLine, NowhereToShowIsNoError) {
  ProgressLine(nullptr).show({"iterations", 100, 400, 10});
}

}  // namespace
}  // namespace wearwell
