#include "wearwell/report/plots_json.h"

#include <gmock/gmock.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace {

TEST(PlotsJson, ReadsWhatItWrote) {
  Plots plots;
  plots.quantity = "worn <volume>";
  plots.unit = "mm^3";
  plots.parameters.push_back(
      {"meaning", "flat", {{0, 1, 2}, {{0.25, 0.75}}}, Curve{{1, 2}, {0.1, 1.0 / 3}}, {{1}, {1}}});
  plots.parameters.push_back({"other", "flat", {{0, 1}, {{1}}}, {}, {{1}, {1}}});
  plots.history = {{1, 2}, {3, NAN}, {1, 1}, {2, 2}, {0, 0}, {9, 9}};
  plots.life = Curve{{5}, {0.5}};
  plots.files = {{"study.toml", "da39"}};
  plots.seconds = 0.5;
  const std::string text = to_json(plots).dump();
  const auto json = nlohmann::ordered_json::parse(text);
  const Plots again = plots_from_json(JsonReader(json, "plots.json"));
  EXPECT_EQ(to_json(again).dump(), text);
  EXPECT_EQ(again.parameters[0].exact->y[1], 1.0 / 3);
  EXPECT_FALSE(again.parameters[1].exact);
  EXPECT_FALSE(again.joint);
  EXPECT_TRUE(std::isnan(again.history.mean[1]));
  EXPECT_EQ(again.life->x, std::vector<double>{5});
}

TEST(PlotsJson, RefusesWhatIsMissing) {
  auto json = to_json(Plots{});
  json.erase("history");
  EXPECT_EQ(message_of<InputError>([&] { plots_from_json(JsonReader(json, "plots.json")); }),
            "plots.json is not what wearwell writes: history is missing");
}

}  // namespace
}  // namespace wearwell
