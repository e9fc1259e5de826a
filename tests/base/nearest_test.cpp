#include "wearwell/base/nearest.h"

#include <gtest/gtest.h>

namespace wearwell {
namespace {

TEST(NearestName, PrefersFewestEdits) {
  EXPECT_EQ(nearest_name("volum", {"cycles", "volume", "column"}), "volume");
  EXPECT_EQ(nearest_name("lowr", {"distribution", "lower", "upper"}), "lower");
  EXPECT_EQ(nearest_name("", {"k"}), "k");
}

TEST(NearestName, TwoLettersSwappedAreOneSlip) {
  EXPECT_EQ(nearest_name("fti", {"new", "fit", "select"}), "fit");
  EXPECT_EQ(nearest_name("lfie", {"list", "life"}), "life");
}

TEST(NearestName, CapitalsAreNoSlip) {
  EXPECT_EQ(nearest_name("K", {"V0", "k"}), "k");
  EXPECT_EQ(nearest_name("LIMIT", {"timid", "limit"}), "limit");
  EXPECT_EQ(nearest_name("sn", {"SN", "sn"}), "sn");
}

TEST(NearestName, AWordOfTheNameComesBeforeShortNames) {
  const std::vector<std::string> models = {"archard-joint", "bearing-wear", "clutch-wear", "sn"};
  EXPECT_EQ(nearest_name("joint", models), "archard-joint");
  EXPECT_EQ(nearest_name("clutch", models), "clutch-wear");
  EXPECT_EQ(nearest_name("clutch-ware", models), "clutch-wear");
}

TEST(NearestName, IsOfferedWhereItIsNear) {
  EXPECT_EQ(near_name("limt", {"limit", "risk"}), "limit");
  EXPECT_FALSE(near_name("zebra", {"limit", "risk"}));
  EXPECT_FALSE(near_name("limit", {}));
  EXPECT_EQ(did_you_mean("limt", {"limit"}), "; did you mean 'limit'?");
  EXPECT_EQ(did_you_mean("zebra", {"limit"}), "");
}

}  // namespace
}  // namespace wearwell
