#include "support/printed_numbers.h"

#include <gtest/gtest.h>

namespace wearwell {
namespace {

TEST(PrintedNumbers, AgreeToTheirLastDigit) {
  EXPECT_EQ(printed_difference("B10 after 7343 h", "B10 after 7342 h"), "");
  EXPECT_EQ(printed_difference("width 0.801", "width 0.800"), "");
  EXPECT_EQ(printed_difference("18 200 to 26 600", "18 201 to 26 599"), "");
  EXPECT_EQ(printed_difference("60 000 h", "59 999 h"), "");
  EXPECT_EQ(printed_difference("0.8", "0.81"), "");  // trailing zeros are not printed
  EXPECT_EQ(printed_difference("1.234e-05", "1.235e-05"), "");
  EXPECT_EQ(printed_difference("  9   ok", " 10 ok"), "");
}

TEST(PrintedNumbers, FartherApartDiffer) {
  EXPECT_NE(printed_difference("7344 h", "7342 h"), "");
  EXPECT_NE(printed_difference("width 0.807", "width 0.800"), "");
  EXPECT_NE(printed_difference("-1", "1"), "");
  EXPECT_NE(printed_difference("1.234e-05", "1.234e-04"), "");
  EXPECT_NE(printed_difference("18 200", "18 210"), "");
}

TEST(PrintedNumbers, WordsAreExact) {
  EXPECT_NE(printed_difference("7342 h", "7342 d"), "");
  EXPECT_NE(printed_difference("unit J7", "unit J8"), "");
  EXPECT_NE(printed_difference("all passed", "all passed."), "");
  EXPECT_NE(printed_difference("", "a line"), "");
}

TEST(PrintedNumbers, GroupsAndPowersAreOneNumber) {
  EXPECT_EQ(printed_difference("after 21\u202f600\u00a0cycles", "after 21\u202f601\u00a0cycles"),
            "");
  EXPECT_NE(printed_difference("after 21\u202f600", "after 22\u202f600"), "");
  EXPECT_EQ(printed_difference("k is 7.76\u00a0×\u00a010^-4", "k is 7.77\u00a0×\u00a010^-4"), "");
  EXPECT_NE(printed_difference("k is 7.76\u00a0×\u00a010^-4", "k is 7.76\u00a0×\u00a010^-5"), "");
  EXPECT_NE(printed_difference("k is 7.76\u00a0×\u00a010^-4", "k is 7.79\u00a0×\u00a010^-4"), "");
}

}  // namespace
}  // namespace wearwell
