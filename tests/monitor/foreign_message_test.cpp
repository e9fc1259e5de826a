// The line protocol of InfluxDB and JSON of OPC UA PubSub.
#include <gmock/gmock.h>

#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/monitor/foreign_message.h"
#include "wearwell/monitor/reading_mapping.h"

namespace wearwell::monitor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::string shown(const Fields& fields) {
  std::string text;
  for (const Field& each : fields) {
    text += each.name + "=";
    if (each.kind == Field::Kind::number) {
      text += each.whole ? std::to_string(each.integer) : std::to_string(each.number);
    } else if (each.kind == Field::Kind::text) {
      text += "'" + each.text + "'";
    } else {
      text += each.kind == Field::Kind::flag   ? "flag"
              : each.kind == Field::Kind::null ? "null"
                                               : "list";
    }
    text += ";";
  }
  return text;
}

struct Outcome {
  std::vector<std::string> rows, problems;
};
Outcome influx(const std::string& text, std::int64_t per_second = 1'000'000'000) {
  Outcome outcome;
  read_influx(
      text, per_second, [&](const Fields& fields) { outcome.rows.push_back(shown(fields)); },
      [&](const std::string& why) { outcome.problems.push_back(why); });
  return outcome;
}
Outcome opc_ua(const std::string& text) {
  Outcome outcome;
  read_opc_ua(
      text, [&](const Fields& fields) { outcome.rows.push_back(shown(fields)); },
      [&](const std::string& why) { outcome.problems.push_back(why); });
  return outcome;
}

TEST(InfluxLines, AreReadAsInfluxDBDoes) {
  // From the reference of the line protocol.
  EXPECT_THAT(influx("myMeasurement,tag1=value1,tag2=value2 fieldKey=\"fieldValue\" "
                     "1556813561098000000")
                  .rows,
              ElementsAre("{measurement}='myMeasurement';tag1='value1';tag2='value2';fieldKey="
                          "'fieldValue';{timestamp}=1556813561098;"));
  EXPECT_THAT(influx("m f=1,g=-1.5e1,h=12485903i,i=7u,j=t,k=FALSE").rows,
              ElementsAre("{measurement}='m';f=1;g=-15;h=12485903;i=7;j=flag;k=flag;"));
  EXPECT_THAT(
      influx(R"(my\ Measurement,tag\ Key=a\,b\=c fie\=ld="string \"value\", a=b \\ c" )").rows,
      ElementsAre(
          R"({measurement}='my Measurement';tag Key='a,b=c';fie=ld='string "value", a=b \ c';)"));
  EXPECT_THAT(influx("# a comment\nm a=1\r\n\n  m a=2.5\n").rows,
              ElementsAre("{measurement}='m';a=1;", "{measurement}='m';a=2.500000;"));
}

TEST(InfluxLines, TimesHaveAPrecision) {
  const std::string expected = "{measurement}='m';a=1;{timestamp}=1700000000000;";
  EXPECT_THAT(influx("m a=1 1700000000000000000").rows, ElementsAre(expected));
  EXPECT_THAT(influx("m a=1 1700000000000000", 1'000'000).rows, ElementsAre(expected));
  EXPECT_THAT(influx("m a=1 1700000000000", 1000).rows, ElementsAre(expected));
  EXPECT_THAT(influx("m a=1 1700000000", 1).rows, ElementsAre(expected));
  // Each of the four in the precision of another is refused.
  const std::int64_t precisions[] = {1, 1000, 1'000'000, 1'000'000'000};
  for (const std::int64_t written : precisions) {
    for (const std::int64_t read : precisions) {
      const Outcome outcome = influx("m a=1 " + std::to_string(1'700'000'000 * written), read);
      EXPECT_EQ(outcome.rows.size(), written == read ? 1U : 0U) << written << " " << read;
      if (written != read) {
        EXPECT_THAT(outcome.problems[0], HasSubstr("source's precision"));
      }
    }
  }
}

TEST(InfluxLines, RefuseWhatIsNone) {
  const auto problem = [](const std::string& line) {
    const Outcome outcome = influx(line);
    EXPECT_THAT(outcome.rows, IsEmpty()) << line;
    return outcome.problems.size() == 1 ? outcome.problems[0] : "?";
  };
  EXPECT_EQ(problem(""), "is empty");
  EXPECT_EQ(problem("m"), "has no fields");
  EXPECT_EQ(problem("m,a=1"), "has no fields");
  EXPECT_EQ(problem("m,a b=1"), "tag 'a' has no value");
  EXPECT_EQ(problem("m a"), "field 'a' has no value");
  EXPECT_EQ(problem("m a= 5"), "'a' is '', but must be a number, true, false, or a text in quotes");
  EXPECT_THAT(problem("m a=1,5"), HasSubstr("field '5' has no value"));
  EXPECT_THAT(problem("m a=nan"), HasSubstr("must be a number"));
  EXPECT_THAT(problem("m a=1e999"), HasSubstr("must be a number"));
  EXPECT_THAT(problem("m a=1.5i"), HasSubstr("must be a whole number"));
  EXPECT_THAT(problem("m a=\"x"), HasSubstr("has an unclosed quote"));
  EXPECT_THAT(problem("m a=1 12x"), HasSubstr("has the time '12x'"));
  EXPECT_THAT(problem("m,a=1 a=2"), HasSubstr("has 'a' twice"));
  EXPECT_THAT(problem("m,=1 a=2"), HasSubstr("has an empty name or value"));
  EXPECT_THAT(problem("{\"a\": 1}"), HasSubstr("has no value"));
}

constexpr const char* key_frame = R"({
  "MessageId": "32235546-05d9-4fd7-97df-ea3ff3408574", "MessageType": "ua-data",
  "PublisherId": "MQTT-Localhost", "DataSetClassId": "2dc07ece-cab9-4470-8f8a-2c1ead207e0e",
  "Messages": [{"DataSetWriterId": 1, "SequenceNumber": 224,
    "MetaDataVersion": {"MajorVersion": 672338910, "MinorVersion": 672341762},
    "Timestamp": "2021-09-27T18:45:19.5551234Z",
    "Payload": {"Wear": {"Type": 11, "Body": 31.5}, "Hours": {"Value": 1200, "SourceTimestamp": "2021-09-27T11:32:38Z"},
                "Serial": "M1", "Plain": 5, "Lost": {"Value": 3, "Status": {"Code": 2147483648}},
                "Both": {"Value": {"Type": 6, "Body": 8}}}},
   {"DataSetWriterName": "second", "MessageType": "ua-keyframe", "Payload": {"Wear": 1}}]})";

TEST(OpcUaMessages, AreReadWithTheirHeaders) {
  const Outcome outcome = opc_ua(key_frame);
  EXPECT_THAT(outcome.problems, IsEmpty());
  EXPECT_THAT(
      outcome.rows,
      ElementsAre("Wear=31.500000;Hours=1200;Serial='M1';Plain=5;Lost=null;Both=8;{publisher}="
                  "'MQTT-Localhost';{writer}=1;{sequence}=224;{timestamp}=1632768319555;",
                  "Wear=1;{publisher}='MQTT-Localhost';{writer}='second';"));
  EXPECT_THAT(opc_ua(R"({"DataSetWriterId": 3, "Payload": {"a": 1}})").rows,
              ElementsAre("a=1;{writer}=3;"));
  EXPECT_THAT(opc_ua("{\"Payload\": {\"a\": 1}}\n{\"Payload\": {\"a\": 2}}\n").rows,
              ElementsAre("a=1;", "a=2;"));
  EXPECT_THAT(opc_ua(R"([{"Payload": {"a": 1}}, {"Payload": {"a": 2}}])").rows,
              ElementsAre("a=1;", "a=2;"));
  const Outcome silent = opc_ua(R"({"MessageType": "ua-metadata", "MetaData": {}})");
  EXPECT_THAT(silent.rows, IsEmpty());
  EXPECT_THAT(silent.problems, IsEmpty());
}

TEST(OpcUaMessages, LoseNoLineBesideAMalformedOne) {
  for (const char* text :
       {"{\"Payload\": {\"a\": 1}\n{\"Payload\": {\"a\": 2}}\n{\"Payload\": {\"a\": 3}}\n",
        "{\"Payload\": {\"a\": 2}}\noops\n{\"Payload\": {\"a\": 3}}"}) {
    const Outcome outcome = opc_ua(text);
    EXPECT_THAT(outcome.rows, ElementsAre("a=2;", "a=3;"));
    EXPECT_THAT(outcome.problems, ElementsAre("is not JSON"));
  }
  // A message over several lines is one message, also a malformed one.
  EXPECT_THAT(opc_ua("{\"Payload\":\n{\"a\": 1}\n}").rows, ElementsAre("a=1;"));
  EXPECT_THAT(opc_ua("{\"Payload\":\n{\"a\": 1,}\n}").problems, SizeIs(1));
}

TEST(OpcUaMessages, HaveStatusCodes) {
  // Status codes are 32 bits, signed or not.
  const auto value = [](const std::string& status) {
    return opc_ua(R"({"Payload": {"a": {"Value": 3, "Status": )" + status + "}}}").rows.at(0);
  };
  for (const char* good : {"0", "{\"Code\": 0}", "null", "{}", "1073741824", "11141120",
                           "{\"Symbol\": \"GoodClamped\"}"})
    EXPECT_EQ(value(good), "a=3;") << good;
  for (const char* bad :
       {"2147483648", "{\"Code\": 2150891520}", "-2147483648", "-2144075776", "{\"Code\": -1}",
        "3221225472", "\"Bad\"", "true", "1.5", "{\"Symbol\": \"BadTimeout\"}"})
    EXPECT_EQ(value(bad), "a=null;") << bad;
}

// The reading says why its value is missing.
TEST(OpcUaMessages, NameTheBadStatusOfAValue) {
  ReadingMapping mapping;
  mapping.unit = "m";
  mapping.sequence = "n";
  mapping.columns = {{"wear", true, "w", Unit{"m", 1, 0}, {}, false}};
  const auto refusal = [&](const std::string& fields) {
    std::string why;
    read_opc_ua(
        R"({"Messages": [{"Payload": {"m": "M1", "n": 1, "w": 2}}, {"Payload": )" + fields + "}]}",
        [&](const Fields& row) {
          try {
            reading_of(row, "", mapping, 5);
          } catch (const InputError& error) {
            why += error.what();
          }
        },
        [&](const std::string& problem) { why += problem; }, Form::opc_ua);
    return why;
  };
  EXPECT_EQ(refusal(R"({"m": "M1", "n": 2, "w": {"Value": 3, "Status": 2150891520}})"),
            "w is missing: it has the bad status 2150891520");
  EXPECT_EQ(refusal(R"({"m": "M1", "n": 2, "w": {"Value": {"Value": 3, "StatusCode": )"
                    R"({"Code": 2150891520, "Symbol": "BadTimeout"}}}})"),
            R"(w is missing: it has the bad status {"Code":2150891520,"Symbol":"BadTimeout"})");
  EXPECT_EQ(refusal(R"({"m": {"Value": "M1", "Status": 2150891520}, "n": 2, "w": 3})"),
            "m is missing: it has the bad status 2150891520");
  EXPECT_EQ(refusal(R"({"m": "M1", "n": 2})"), "w is missing");
  EXPECT_EQ(refusal(R"({"m": "M1", "n": 2, "w": {"Value": 3, "Status": 0}})"), "");
}

TEST(OpcUaMessages, RefuseWhatCannotBeAReading) {
  const auto problem = [](const std::string& text) {
    const Outcome outcome = opc_ua(text);
    EXPECT_THAT(outcome.rows, IsEmpty()) << text;
    return outcome.problems.size() == 1 ? outcome.problems[0] : "?";
  };
  EXPECT_THAT(problem(R"({"MessageType": "ua-deltaframe", "Payload": {"a": 1}})"),
              HasSubstr("is a delta frame"));
  EXPECT_THAT(problem(R"({"Status": 2147483648, "Payload": {"a": 1}})"), HasSubstr("bad status"));
  EXPECT_THAT(problem(R"({"a": 1})"), HasSubstr("neither Messages nor Payload"));
  EXPECT_THAT(problem(R"({"Payload": 5})"), HasSubstr("no Payload with fields"));
  EXPECT_THAT(problem(R"({"Timestamp": "yesterday", "Payload": {"a": 1}})"),
              HasSubstr("Timestamp"));
  EXPECT_THAT(problem(R"({"Payload": {"a": 1, "a": 2}})"), HasSubstr("has 'a' twice"));
  EXPECT_EQ(problem("{"), "is not JSON");
  EXPECT_EQ(problem("5"), "is not a message of OPC UA PubSub");
  EXPECT_THAT(problem(std::string(100'000, '[')), HasSubstr("nested"));
}

// Whatever comes is read or refused.
TEST(ForeignMessages, SurviveMutations) {
  Rng rng(3, 1);
  const std::string sources[] = {key_frame,
                                 R"(m\ x,tag=a\,b f=1.5,g="a \"b\"",h=3i 1700000000000000000)"};
  for (int round = 0; round < 20'000; ++round) {
    std::string text = sources[round % 2];
    const int changes = 1 + static_cast<int>(rng.uniform() * 6);
    for (int i = 0; i < changes; ++i) {
      const auto at = static_cast<std::size_t>(rng.uniform() * static_cast<double>(text.size()));
      const double kind = rng.uniform();
      if (kind < 0.4) {
        text[at] = static_cast<char>(rng.uniform() * 256);
      } else if (kind < 0.7) {
        text.erase(at, 1 + static_cast<std::size_t>(rng.uniform() * 9));
      } else {
        text.insert(at, text.substr(static_cast<std::size_t>(rng.uniform() * 30), 12));
      }
      if (text.empty()) text = "x";
    }
    for (const Outcome& outcome : {influx(text), opc_ua(text)}) {
      for (const std::string& each : outcome.problems) EXPECT_FALSE(each.empty());
    }
  }
}

}  // namespace
}  // namespace wearwell::monitor
