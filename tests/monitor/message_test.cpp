// What messages are and what they are not, and that none of them, however it came about, does more than be refused.
#include <gmock/gmock.h>

#include "monitor/fleet_rig.h"
#include "wearwell/base/rng.h"
#include "wearwell/monitor/line_feed.h"
#include "wearwell/monitor/message.h"
#include "wearwell/monitor/time_text.h"
#include "wearwell/monitor/topic_pattern.h"

namespace wearwell::monitor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> problems_of(const std::string& payload, std::size_t* rows = nullptr) {
  std::vector<std::string> problems;
  std::size_t count = 0;
  for_each_row(
      payload, [&](const Fields&) { ++count; },
      [&](const std::string& problem) { problems.push_back(problem); });
  if (rows) *rows = count;
  return problems;
}

// A stream that is broken off and goes on: half a line, or no JSON at all, is one refusal.
TEST(LineFeed, AHalfLineCostsItselfWhereverItStands) {
  for (const std::string bad : {"{\"a\": 1, \"b", "{bad", "garbage", "]"}) {
    for (int place = 0; place < 3; ++place) {
      std::vector<std::string> lines = {"{\"a\": 1}", "{\"a\": 2}"};
      lines.insert(lines.begin() + place, bad);
      LineFeed feed({"a"});
      feed.push("{\"a\": 0}\n");
      const auto begin = feed.next(false);
      ASSERT_TRUE(begin);
      feed.taken(*begin);
      for (const std::string& line : lines) feed.push(line + "\n");
      const auto piece = feed.next(false);
      ASSERT_TRUE(piece);
      std::size_t rows = 0, refused = 0;
      for_each_row(
          piece->payload, [&](const Fields&) { ++rows; }, [&](const std::string&) { ++refused; },
          piece->form);
      EXPECT_EQ(rows, 2U) << bad << " at " << place;
      EXPECT_EQ(refused, 1U) << bad << " at " << place;
    }
  }
}

TEST(MessageFields, OfJson) {
  const Fields fields = fields_of_json(
      R"({"machine": "M7", "n": 12, "metrics": {"wear": 1.5e-3, "deep": {"x": true}}, "list": [1, {"a": 2}], "none": null})");
  EXPECT_EQ(find_field(fields, "machine")->text, "M7");
  EXPECT_TRUE(find_field(fields, "n")->whole);
  EXPECT_EQ(find_field(fields, "n")->integer, 12);
  EXPECT_EQ(find_field(fields, "/metrics/wear")->number, 1.5e-3);
  EXPECT_EQ(find_field(fields, "/metrics/deep/x")->kind, Field::Kind::flag);
  EXPECT_EQ(find_field(fields, "list")->kind, Field::Kind::list);
  EXPECT_EQ(find_field(fields, "none")->kind, Field::Kind::null);
  EXPECT_EQ(find_field(fields, "a"), nullptr);
}

TEST(MessageFields, OfCsv) {
  std::vector<std::string> units;
  for_each_row(
      "machine,\"wear, measured\",n\r\nM1,1.5,3\r\n\"M \"\"2\"\"\",-2,4\n",
      [&](const Fields& fields) {
        units.push_back(find_field(fields, "machine")->text);
        EXPECT_TRUE(find_field(fields, "n")->whole);
        EXPECT_EQ(find_field(fields, "wear, measured")->kind, Field::Kind::number);
      },
      [](const std::string& problem) { ADD_FAILURE() << problem; });
  EXPECT_THAT(units, ElementsAre("M1", "M \"2\""));
}

// The lines after it are read; "2"5 would be one number, and neither 2 nor 25.
TEST(MessageFields, OneBadLineOfCsvCostsItself) {
  for (const char* bad : {"\"M1,1,2", "M1,\"2\"5,1", "M1,1", "\"M1\"x,1,2"}) {
    for (int place = 0; place < 3; ++place) {
      std::vector<std::string> lines = {"M1,1,2", "M2,\"2.5\" ,3"};
      lines.insert(lines.begin() + place, bad);
      std::string payload = "machine,wear,n";
      for (const std::string& line : lines) payload += "\n" + line;
      std::size_t rows = 0;
      EXPECT_EQ(problems_of(payload, &rows).size(), 1U) << payload;
      EXPECT_EQ(rows, 2U) << payload;
    }
  }
  EXPECT_THAT(problems_of("machine,wear\nM1,\"2\"5"),
              ElementsAre(HasSubstr("goes on behind its closing quote")));
  EXPECT_THAT(problems_of("machine,wear\nM 5\" b,2"), ElementsAre());
}

TEST(MessageFields, OneBadLineCostsItself) {
  std::size_t rows = 0;
  EXPECT_THAT(problems_of("{\"a\": 1}\n{\"a\": }\n{\"a\": 3}", &rows),
              ElementsAre(HasSubstr("is not JSON, from byte")));
  EXPECT_EQ(rows, 2U);
  EXPECT_THAT(problems_of("a,b\n1,2\n1\n3,4", &rows),
              ElementsAre(HasSubstr("has 1 cells, but the heading 2")));
  EXPECT_EQ(rows, 2U);
}

TEST(MessageFields, OneObjectOverManyLines) {
  std::size_t rows = 0;
  EXPECT_THAT(problems_of("{\n  \"a\": 1,\n  \"b\": {\"c\": 2}\n}\n", &rows), ElementsAre());
  EXPECT_EQ(rows, 1U);
}

TEST(MessageFields, AreBounded) {
  std::string deep = "{\"a\":", many = "{";
  for (int i = 0; i < 40; ++i) deep += "{\"a\":";
  for (int i = 0; i < 300; ++i) many += (i ? ",\"" : "\"") + std::to_string(i) + "\":1";
  EXPECT_THAT(problems_of(deep), ElementsAre(HasSubstr("nested more than 16 deep")));
  EXPECT_THAT(problems_of(many + "}"), ElementsAre(HasSubstr("more than 256 fields")));
  EXPECT_THAT(problems_of("{\"a\":\"" + std::string(100'000, 'x') + "\"}"),
              ElementsAre(HasSubstr("the limit is 65536")));
  EXPECT_THAT(problems_of(std::string(5 << 20, '{')), ElementsAre(HasSubstr("the limit is")));
  EXPECT_THAT(problems_of("{\"a\": 1, \"a\": 2}"), ElementsAre(HasSubstr("has 'a' twice")));
  EXPECT_THAT(problems_of("{\"a\": 1e999}"), ElementsAre(HasSubstr("too large")));
  EXPECT_THAT(problems_of("[1, 2]"), ElementsAre(HasSubstr("is a list")));
  EXPECT_THAT(problems_of(" \n "), ElementsAre("is empty"));
}

TEST(TimeText, Iso) {
  EXPECT_EQ(unix_ms_of_iso("1970-01-01T00:00:00Z"), 0);
  EXPECT_EQ(unix_ms_of_iso("2026-11-22T15:04:05.250Z"), 1795359845250);
  EXPECT_EQ(unix_ms_of_iso("2026-11-22T16:04:05.25+01:00"), 1795359845250);
  EXPECT_EQ(iso_of_unix_ms(1795359845250), "2026-11-22T15:04:05.250Z");
  for (const char* bad : {"2026-11-22T15:04:05", "2026-02-30T00:00:00Z", "22.11.2026", "",
                          "2026-11-22T25:00:00Z", "1969-12-31T23:59:59Z", "2026-11-22T15:04:05Zx"})
    EXPECT_FALSE(unix_ms_of_iso(bad)) << bad;
}

TEST(Topics, NameUnits) {
  const TopicPattern pattern("plant/+/{unit}/wear");
  EXPECT_EQ(pattern.filter(), "plant/+/+/wear");
  EXPECT_EQ(pattern.unit("plant/hall 2/M7/wear"), "M7");
  EXPECT_FALSE(pattern.unit("plant/M7/wear"));
  EXPECT_FALSE(pattern.unit("plant/a/M7/wear/x"));
  EXPECT_EQ(TopicPattern("{unit}/#").unit("M7/a/b"), "M7");
  EXPECT_EQ(topic_level("a/b+c%"), "a%2Fb%2Bc%25");
  for (const char* bad : {"", "a/{unit}/{unit}", "a/x{unit}", "a#/b", "#/a"})
    EXPECT_THROW(TopicPattern{bad}, InputError) << bad;
}

TEST(Lines, ComeWholeWhereverTheyAreCut) {
  const std::string text = "a,b\n1,2\n3,4\n\n5,6\n";
  for (std::size_t step = 1; step <= text.size(); ++step) {
    LineFeed feed({"a"});
    std::string rows;
    for (std::size_t at = 0; at < text.size(); at += step) {
      feed.push(std::string_view(text).substr(at, step));
      while (const auto piece = feed.next(false)) {
        if (!piece->payload.empty())
          for_each_row(
              piece->payload,
              [&](const Fields& fields) { rows += fields[0].text + fields[1].text; },
              [](const std::string& problem) { ADD_FAILURE() << problem; });
        feed.taken(*piece);
      }
    }
    EXPECT_EQ(rows, "123456") << step;
  }
}

// Half a line, a banner, a line that was cut: whatever comes before the heading, or before JSON, costs itself alone.
TEST(Lines, OfGarbageBeforeTheHeadingAreRefused) {
  std::vector<std::string> refused;
  const auto read = [&](const std::string& text) {
    std::string rows;
    for (std::size_t step = 1; step <= text.size(); step += 3) {
      LineFeed feed({"n", "t"});
      rows.clear();
      refused.clear();
      for (std::size_t at = 0; at < text.size(); at += step) {
        feed.push(std::string_view(text).substr(at, step));
        while (const auto piece = feed.next(at + step >= text.size())) {
          refused.insert(refused.end(), piece->refused.begin(), piece->refused.end());
          if (!piece->payload.empty())
            for_each_row(
                piece->payload, [&](const Fields& each) { rows += find_field(each, "n")->text; },
                [&](const std::string& problem) { refused.push_back(problem); }, piece->form);
          feed.taken(*piece);
        }
      }
    }
    return rows;
  };
  EXPECT_EQ(read("7,12\nlogger v1 \"up\n\nwear, n ,t\n3,1,5\n4,2,6\n"), "12");
  EXPECT_THAT(refused,
              testing::ElementsAre("'7,12' is neither JSON nor a heading with n, t",
                                   "'logger v1 \"up' is neither JSON nor a heading with n, t"));
  EXPECT_EQ(read("ready\n{\"n\": \"1\"}\n{\"n\": \"2\"}\n"), "12");
  EXPECT_EQ(refused.size(), 1U);
  EXPECT_EQ(read("3,1\n4,2"), "");
  EXPECT_EQ(refused.size(), 2U);
  // A stream that goes on has its heading from its beginning.
  LineFeed feed({"n", "t"});
  feed.set_heading("garbage\nn,t,wear\n1,2,3\n");
  feed.push("4,5,6\n");
  EXPECT_EQ(feed.next(false)->payload, "n,t,wear\n4,5,6\n");
}

TEST(Lines, OneWithoutEndIsSkipped) {
  LineFeed feed({"a"});
  std::size_t too_long = 0;
  std::string rows;
  const std::string text = "{\"a\":1}\n" + std::string(200'000, 'x') + "\n{\"a\":2}\n";
  for (std::size_t at = 0; at < text.size(); at += 10'000) {
    feed.push(std::string_view(text).substr(at, 10'000));
    while (const auto piece = feed.next(false)) {
      too_long += piece->refused.size();
      rows += piece->payload;
      feed.taken(*piece);
    }
  }
  EXPECT_EQ(too_long, 1U);
  EXPECT_EQ(rows, "{\"a\":1}\n{\"a\":2}\n");
}

/// Bytes turned, left out, doubled, moved.
std::string mutated(std::string text, Rng& rng) {
  const int changes = 1 + static_cast<int>(rng.bits() % 4);
  for (int i = 0; i < changes && !text.empty(); ++i) {
    const std::size_t at = rng.bits() % text.size(), length = 1 + rng.bits() % 8;
    switch (rng.bits() % 5) {
      case 0:
        text[at] = static_cast<char>(rng.bits());
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(rng.bits() % text.size(), length));
        break;
      case 3:
        text.insert(at, 1, "{}[]\",:\n\0\\eE+-."[rng.bits() % 16]);
        break;
      default:
        text.resize(at);
    }
  }
  return text;
}

using HostileMessages = FleetRig;

TEST(SeparatorProblem, NamesWhatMessagesAreSeparatedBy) {
  EXPECT_EQ(separator_problem("a,1.5"), "");
  EXPECT_THAT(separator_problem("a;1,5"), HasSubstr("are separated by commas"));
  EXPECT_THAT(separator_problem("a\t1"), HasSubstr("are separated by commas"));
}

TEST_F(HostileMessages, AreCountedAndLeaveTheOthersAlone) {
  open();
  Rng rng(17, 1);
  const std::string seeds[] = {message("M1", 1, 10.5),
                               message("M2", 2, 11) + "\n" + message("M2", 3, 12),
                               "machine,n,wear,time\nM3,4,1.5,3\nM3,5,1.75,4\n"};
  std::vector<Message> messages;
  std::uint64_t taken = 0, refused = 0, repeated = 0;
  constexpr int count = 100'000;
  for (int i = 0; i < count; ++i) {
    messages.push_back({"", mutated(seeds[rng.bits() % 3], rng)});
    if (messages.size() < 500) continue;
    const Delivery delivery = intake_->deliver(source(), messages);
    ASSERT_TRUE(delivery.stored) << delivery.problem;
    taken += delivery.readings;
    refused += delivery.refused;
    repeated += delivery.repeated;
    messages.clear();
  }
  catch_up();
  EXPECT_GT(refused, 50'000U);
  EXPECT_EQ(store_->count(), taken);
  EXPECT_EQ(tally_->total().refused, refused);
  EXPECT_EQ(tally_->total().repeated, repeated);
  EXPECT_EQ(tally_->total().messages, taken + refused + repeated);
  EXPECT_TRUE(deliver(message("good", 1, 2)).stored);
}

}  // namespace
}  // namespace wearwell::monitor
