#include "wearwell/base/nearest.h"

#include <gtest/gtest.h>

namespace wearwell {
namespace {

TEST(NearestName, PrefersFewestEdits) {
  EXPECT_EQ(nearest_name("volum", {"cycles", "volume", "column"}), "volume");
  EXPECT_EQ(nearest_name("lowr", {"law", "lower", "upper"}), "lower");
  EXPECT_EQ(nearest_name("", {"k"}), "k");
}

}  // namespace
}  // namespace wearwell
