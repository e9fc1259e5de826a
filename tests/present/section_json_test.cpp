#include "wearwell/present/section_json.h"

#include <gmock/gmock.h>

#include <cmath>

#include "support/json_mutations.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell::present {
namespace {

using testing::HasSubstr;
using Json = nlohmann::ordered_json;

std::vector<Section> sample() {
  Section section{"a", "A", {}, "Section A"};
  section.add(Prose{"text <b>", true});
  section.add(Callout{"warn", "Careful.", "why"});
  section.add(Tiles{{{"Life", "3", "h", "note"}}});
  section.add(Facts{{{"Seed", "1"}}});
  section.add(Figures{{{"f", "Figure", "caption", {{"layer", Json::array()}}},
                       {"p", "Panel", "caption", {{"layer", Json::array()}}, "Panels", true}}});
  Table table{"t", "Table", {{"x", "mm"}, {"y", "1", fixed(2), true}, {"z"}}};
  table.rows = {{1.5, Range{0, INFINITY}, "word"}, {std::nan(""), Cell(), Badge{"fail", "Failed"}}};
  section.add(Details{"more", {{table}, {Verbatim{"lines"}}}});
  return {section};
}

std::vector<Section> read(const Json& json) {
  return sections_from_json(JsonReader(json, "report.json"));
}

TEST(SectionJson, LosesNothing) {
  const Json json = to_json(sample());
  const auto again = read(Json::parse(json.dump()));
  EXPECT_EQ(to_json(again), json);
  EXPECT_EQ(html_of(again.front()), html_of(sample().front()));
  EXPECT_EQ(csv(*tables(again).front()), csv(*tables(sample()).front()));
}

TEST(SectionJson, NamesWhatIsWrong) {
  Json json = to_json(sample());
  json["sections"][0]["blocks"][5]["blocks"][0]["rows"][0].erase(0);
  EXPECT_THAT(
      message_of<InputError>([&] { read(json); }),
      HasSubstr("sections[0].blocks[5].blocks[0].rows[0] has 2 cells, but the table has 3"));
}

TEST(SectionJson, IsReadOrRefused) {
  int used = 0, refused = 0;
  mutations(to_json(sample()), [&](const std::string& what, const Json& json) {
    try {
      for (const Section& section : read(json)) html_of(section);
      ++used;
    } catch (const InputError&) {
      ++refused;
    } catch (const std::exception& error) {
      ADD_FAILURE() << what << ": " << error.what();
    }
  });
  EXPECT_GT(used, 10);
  EXPECT_GT(refused, 50);
}

TEST(SectionJson, FoldingHasAnEnd) {
  Json blocks = Json::array({{{"prose", "x"}, {"lead", false}}});
  for (int i = 0; i < 10; ++i) blocks = Json::array({{{"details", "more"}, {"blocks", blocks}}});
  Json json;
  json["sections"] = Json::array({{{"id", "a"}, {"name", "a"}, {"title", ""}, {"blocks", blocks}}});
  EXPECT_THAT(message_of<InputError>([&] { read(json); }), HasSubstr("is nested too deeply"));
}

}  // namespace
}  // namespace wearwell::present
