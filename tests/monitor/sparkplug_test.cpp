// Sparkplug B: payloads of Google's encoder and by hand, what births, deaths and missing messages mean, and that nothing does more
// than be refused.
#include <gmock/gmock.h>

#include "monitor/fleet_rig.h"
#include "monitor/sparkplug_encoder.h"
#include "wearwell/base/rng.h"
#include "wearwell/monitor/sparkplug_decoder.h"

namespace wearwell::monitor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

SparkplugMetric whole(SparkplugMetric::Holds holds, std::uint64_t bits) {
  SparkplugMetric metric;
  metric.holds = holds;
  metric.bits = bits;
  return metric;
}

// Field numbers and wire types by hand: 1 varint 1000; 2 bytes { 1 "x", 3 varint 1000, 4 varint 10, 13 double 1.5 }; 3 varint 7.
TEST(SparkplugPayloads, ByHand) {
  const std::string bytes(
      "\x08\xe8\x07"
      "\x12\x11\x0a\x01x\x18\xe8\x07\x20\x0a\x69\x00\x00\x00\x00\x00\x00\xf8\x3f"
      "\x18\x07",
      24);
  const SparkplugPayload payload = read_sparkplug(bytes);
  EXPECT_EQ(payload.timestamp, 1000U);
  EXPECT_EQ(payload.sequence, 7U);
  ASSERT_EQ(payload.metrics.size(), 1U);
  EXPECT_EQ(payload.metrics[0].name, "x");
  EXPECT_EQ(payload.metrics[0].timestamp, 1000U);
  const Field field = field_of(payload.metrics[0], payload.metrics[0].type, "x");
  EXPECT_EQ(field.kind, Field::Kind::number);
  EXPECT_EQ(field.number, 1.5);
  // Broken off anywhere within, it is none.
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    if (size == 0 || size == 3 || size == 22) continue;  // between two fields
    EXPECT_THROW(read_sparkplug(std::string_view(bytes).substr(0, size)), InputError) << size;
  }
  EXPECT_EQ(read_sparkplug(std::string_view(bytes).substr(0, 22)).sequence, 0U);
}

TEST(SparkplugPayloads, WholeNumbersOfAllWidths) {
  using Holds = SparkplugMetric::Holds;
  const auto value = [](const SparkplugMetric& metric, std::uint32_t type) {
    const Field field = field_of(metric, type, "x");
    EXPECT_TRUE(field.whole);
    return field.integer;
  };
  // -5 in its own width, in 32 and in 64 bits.
  for (std::uint32_t type = 1; type <= 4; ++type) {
    EXPECT_EQ(value(whole(Holds::bits64, ~std::uint64_t{4}), type), -5) << type;
    if (type < 4) {
      EXPECT_EQ(value(whole(Holds::bits32, 0xfffffffb), type), -5) << type;
    }
    EXPECT_EQ(value(whole(Holds::bits32, 100), type), 100) << type;
  }
  EXPECT_EQ(value(whole(Holds::bits32, 0xfb), 1), -5);
  EXPECT_EQ(value(whole(Holds::bits32, 0xfffb), 2), -5);
  EXPECT_EQ(value(whole(Holds::bits32, 0xfb), 2), 251);
  EXPECT_EQ(value(whole(Holds::bits32, 0xfb), 5), 251);
  EXPECT_EQ(value(whole(Holds::bits64, 0xfffffffb), 7), 4294967291);
  EXPECT_EQ(value(whole(Holds::bits64, 1'700'000'000'000), 13), 1'700'000'000'000);
  EXPECT_EQ(field_of(whole(Holds::bits64, ~std::uint64_t{0}), 8, "x").number, 0x1p64);
  for (const std::uint32_t type : {1U, 2U, 5U, 6U})
    EXPECT_THROW(field_of(whole(Holds::bits32, 0x12345), type, "x"), InputError) << type;
  EXPECT_THROW(field_of(whole(Holds::bits32, 0xfffffffb), 4, "x"), InputError);  // -5, or 2^32 - 5
  EXPECT_THROW(field_of(whole(Holds::bits32, 1), 9, "x"), InputError);
  EXPECT_THROW(field_of(whole(Holds::bits32, 1), 16, "x"), InputError);
  EXPECT_THROW(field_of(whole(Holds::bits32, 1), 0, "x"), InputError);
}

TEST(SparkplugPayloads, OfGooglesEncoder) {
  if (!has_protoc()) GTEST_SKIP() << "protoc is not installed";
  const std::string bytes = encoded(R"(timestamp: 5 seq: 3
    metrics { name: 'f' datatype: 9 float_value: 0.1 }
    metrics { name: 'd' alias: 300 datatype: 10 double_value: -2.5e-7 is_historical: true }
    metrics { name: 'b' datatype: 11 boolean_value: true }
    metrics { name: 's' datatype: 12 string_value: 'Größe' }
    metrics { name: 't' datatype: 19 template_value { version: '1' metrics { name: 'in' int_value: 1 } } }
    metrics { name: 'set' datatype: 16 dataset_value { num_of_columns: 1 columns: 'a' } }
    metrics { name: 'n' datatype: 10 is_null: true }
    metrics { name: 'p' datatype: 10 double_value: 1 properties {
      keys: 'deep' values { propertyset_value { keys: 'engUnit' values { string_value: 'no' } } }
      keys: 'engUnit' values { type: 12 string_value: 'mm' }
      keys: 'Quality' values { type: 3 int_value: 192 } } })");
  const SparkplugPayload payload = read_sparkplug(bytes);
  ASSERT_EQ(payload.metrics.size(), 8U);
  const auto field = [&](std::size_t i) {
    return field_of(payload.metrics[i], payload.metrics[i].type, "x");
  };
  EXPECT_EQ(field(0).number, static_cast<double>(0.1F));
  EXPECT_EQ(field(1).number, -2.5e-7);
  EXPECT_TRUE(payload.metrics[1].historical);
  EXPECT_EQ(payload.metrics[1].alias, 300U);
  EXPECT_EQ(field(2).kind, Field::Kind::flag);
  EXPECT_EQ(field(3).text, "Größe");
  EXPECT_THROW(field(4), InputError);
  EXPECT_THROW(field(5), InputError);
  EXPECT_EQ(field(6).kind, Field::Kind::null);
  EXPECT_EQ(payload.metrics[7].eng_unit, "mm");
  EXPECT_EQ(payload.metrics[7].quality, 192U);
  EXPECT_THROW(read_sparkplug(encoded("uuid: 'SPBV1.0_COMPRESSED' body: 'x'")), InputError);
  // What asks for a birth certificate, read by Google.
  const std::string command = "printf '";
  std::string octal;
  for (const char c : rebirth_request(42))
    octal += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
  EXPECT_EQ(run_command(command + octal +
                        "' | protoc --proto_path='" PROJECT_SOURCE_DIR
                        "/tests/monitor' --decode=sparkplug.Payload sparkplug_b.proto")
                .out,
            "timestamp: 42\nmetrics {\n  name: \"Node Control/Rebirth\"\n  timestamp: 42\n  "
            "datatype: 11\n  boolean_value: true\n}\n");
}

TEST(SparkplugTopics, AreOfNodesAndDevices) {
  const auto topic = sparkplug_topic("spBv1.0/G 1/DDATA/E/D");
  ASSERT_TRUE(topic);
  EXPECT_EQ(name_of_topic("{edge}/{device}", *topic), "E/D");
  EXPECT_EQ(name_of_topic("{group}-{device}", *topic), "G 1-D");
  EXPECT_EQ(sparkplug_topic("spBv1.0/G/NDATA/E")->device, "");
  for (const char* bad : {"spBv1.0/STATE/h", "spAv1.0/G/NDATA/E", "spBv1.0/G/NDATA/",
                          "spBv1.0/G/DDATA/E/D/x", "", "spBv1.0//NDATA/E"})
    EXPECT_FALSE(sparkplug_topic(bad)) << bad;
  EXPECT_FALSE(names_by_topic("Serial number"));
  EXPECT_THROW(names_by_topic("{devise}"), InputError);
}

/// An edge node with a device "pump": Wear in um, Hours, a label.
class Sparkplug : public FleetRig {
 protected:
  void SetUp() override {
    if (!has_protoc()) GTEST_SKIP() << "protoc is not installed";
    open();
    begin();
  }
  void begin() {
    settings_.name = "plant";
    settings_.kind = SourceKind::sparkplug;
    settings_.mapping.columns = {{"wear", true, "Wear", read_unit("um", "m"), {}},
                                 {"time", false, "Hours", read_unit("h", "s"), {}}};
    decoder_ = std::make_unique<SparkplugDecoder>(settings_);
  }
  static SourceSettings usual() {
    SourceSettings settings;
    settings.mapping.unit = "{device}";
    settings.mapping.time = "{timestamp}";
    settings.mapping.format = TimeFormat::unix_ms;
    return settings;
  }
  static std::string birth(int sequence, double wear, double hours, const std::string& more = "") {
    return payload(sequence, born_metric("Wear", 1, double_type, number(wear) + more) +
                                 born_metric("Hours", 2, double_type, number(hours)) +
                                 born_metric("Else", 3, double_type, number(1)));
  }
  static std::string node_birth(int session = 1) {
    return payload(0, fmt::format("metrics {{ name: 'bdSeq' timestamp: 1000 datatype: 4 "
                                  "long_value: {} }}",
                                  session));
  }
  static std::string both(int sequence, long long time, double wear, double hours) {
    return payload(sequence, metric(1, time, number(wear)) + metric(2, time, number(hours)));
  }
  /// What became of a message: "pump 1500 0.002 3600" of a reading, or why it is none.
  std::vector<std::string> tell(const std::string& topic, const std::string& bytes) {
    std::vector<Row> rows;
    decoder_->read("spBv1.0/G/" + topic, bytes, rows);
    std::vector<std::string> reported;
    for (const Row& row : rows) {
      try {
        if (!row.problem.empty()) throw InputError(row.problem);
        const StoredReading reading = reading_of(row.fields, row.unit, settings_.mapping, 1);
        reported.push_back(fmt::format("{} {} {:.6g} {:.6g}", reading.unit, reading.key,
                                       reading.numbers[0], reading.numbers[1]));
      } catch (const InputError& error) {
        reported.push_back(error.what());
      }
    }
    return reported;
  }
  void live() {
    EXPECT_THAT(tell("NBIRTH/E", node_birth()), IsEmpty());
    EXPECT_THAT(tell("DBIRTH/E/pump", birth(1, 1000, 2)), IsEmpty());
  }
  SourceSettings settings_ = usual();
  std::unique_ptr<SparkplugDecoder> decoder_;
};

TEST_F(Sparkplug, ReadsDataByAliasAndByName) {
  live();
  EXPECT_THAT(tell("DDATA/E/pump", both(2, 1500, 2000, 3)), ElementsAre("pump 1500 0.002 10800"));
  EXPECT_THAT(
      tell("DDATA/E/pump",
           payload(3,
                   "metrics { name: 'Wear' timestamp: 1600 double_value: 3000 } metrics { name: "
                   "'Hours' timestamp: 1600 double_value: 4 } metrics { name: 'Else' }")),
      ElementsAre("pump 1600 0.003 14400"));
  EXPECT_THAT(tell("NDATA/E", payload(4, "")), IsEmpty());
  EXPECT_THAT(decoder_->rebirths(0), IsEmpty());
}

// Report by exception: what does not change is not sent, and holds; what is measured counts once.
TEST_F(Sparkplug, HoldsWhatDoesNotChange) {
  live();
  EXPECT_THAT(tell("DDATA/E/pump", payload(2, metric(1, 1500, number(2000)))),
              ElementsAre("pump 1500 0.002 7200"));
  EXPECT_THAT(tell("DDATA/E/pump", payload(3, metric(2, 1600, number(5)))), IsEmpty());
  EXPECT_THAT(tell("DDATA/E/pump", payload(4, metric(1, 1700, number(3000)))),
              ElementsAre("pump 1700 0.003 18000"));
  // One of the same moment goes before one that holds, also where it stands a little later.
  EXPECT_THAT(
      tell("DDATA/E/pump", payload(5, metric(1, 2000, number(3100)) + metric(2, 2040, number(6)))),
      ElementsAre("pump 2000 0.0031 21600"));
  // Several in one message, each with its own.
  EXPECT_THAT(tell("DDATA/E/pump",
                   payload(6, metric(1, 5000, number(3300)) + metric(1, 4000, number(3200)) +
                                  metric(2, 4003, number(7)) + metric(2, 4998, number(8)))),
              ElementsAre("pump 4000 0.0032 25200", "pump 5000 0.0033 28800"));
  EXPECT_THAT(tell("DDATA/E/pump", payload(7, metric(2, 5500, "is_null: true"))), IsEmpty());
  EXPECT_THAT(tell("DDATA/E/pump", payload(8, metric(1, 6000, number(1)))),
              ElementsAre("Hours is missing"));
}

TEST_F(Sparkplug, LateValuesGoWithWhatHeldThen) {
  live();
  const std::string late = " is_historical: true";
  EXPECT_THAT(tell("DDATA/E/pump", payload(2, metric(2, 3000, number(5)))), IsEmpty());
  EXPECT_THAT(tell("DDATA/E/pump", payload(3, metric(1, 2000, number(10) + late))),
              ElementsAre("pump 2000 1e-05 7200"));
  // What held before the birth certificate is not known.
  EXPECT_THAT(tell("DDATA/E/pump", payload(4, metric(1, 500, number(10) + late))),
              ElementsAre("Hours is missing"));
  EXPECT_THAT(tell("DDATA/E/pump", payload(5, metric(1, 400, number(10) + late) +
                                                  metric(2, 400, number(1) + late))),
              ElementsAre("pump 400 1e-05 3600"));
  // And it changed nothing of what holds now.
  EXPECT_THAT(tell("DDATA/E/pump", payload(6, metric(1, 4000, number(20)))),
              ElementsAre("pump 4000 2e-05 18000"));
}

TEST_F(Sparkplug, AsksForABirthCertificateWhereOneIsMissing) {
  EXPECT_THAT(tell("DDATA/E/pump", both(9, 1500, 1, 2)),
              ElementsAre(HasSubstr("comes before a birth certificate, which is requested")));
  EXPECT_THAT(decoder_->rebirths(0), ElementsAre("spBv1.0/G/NCMD/E"));
  EXPECT_THAT(tell("DDATA/E/pump", both(10, 1500, 1, 2)), testing::SizeIs(1));
  EXPECT_THAT(decoder_->rebirths(100), IsEmpty());
  EXPECT_THAT(decoder_->rebirths(2000), ElementsAre("spBv1.0/G/NCMD/E"));
  live();
  EXPECT_THAT(tell("DDATA/E/pump", both(3, 1500, 1, 2)),
              ElementsAre(HasSubstr("has number 3 instead of 2")));
  EXPECT_THAT(tell("DDATA/E/pump", both(4, 1500, 1, 2)), testing::SizeIs(1));
  live();
  EXPECT_THAT(tell("DDATA/E/other", payload(2, "")),
              ElementsAre(HasSubstr("before its own birth certificate")));
  EXPECT_THAT(tell("DDATA/E/pump", payload(3, metric(77, 1500, number(1)))),
              ElementsAre(HasSubstr("has alias 77, which is in no birth certificate")));
  EXPECT_THAT(decoder_->rebirths(1'000'000), ElementsAre("spBv1.0/G/NCMD/E"));
  // Numbers go round after 255.
  live();
  for (int n = 2; n < 256; ++n)
    tell("NDATA/E", std::string("\x18", 1) + (n < 128 ? std::string(1, static_cast<char>(n))
                                                      : std::string({static_cast<char>(n), '\1'})));
  EXPECT_THAT(tell("DDATA/E/pump", both(0, 1500, 1000, 1)), ElementsAre("pump 1500 0.001 3600"));
}

TEST_F(Sparkplug, TheDeadAreSilent) {
  live();
  EXPECT_THAT(tell("NDEATH/E", node_birth(0)), IsEmpty());  // of an earlier connection
  EXPECT_THAT(tell("DDATA/E/pump", both(2, 1500, 1000, 1)), testing::SizeIs(1));
  EXPECT_THAT(tell("DDEATH/E/pump", payload(3, "")), IsEmpty());
  EXPECT_THAT(tell("DDATA/E/pump", both(4, 1600, 1000, 1)),
              ElementsAre(HasSubstr("before its own birth certificate")));
  EXPECT_THAT(tell("DBIRTH/E/pump", birth(5, 1000, 2)), IsEmpty());
  EXPECT_THAT(tell("DDATA/E/pump", both(6, 1700, 1000, 1)), ElementsAre("pump 1700 0.001 3600"));
  EXPECT_THAT(tell("NDEATH/E", node_birth(1)), IsEmpty());
  EXPECT_THAT(tell("DDATA/E/pump", both(7, 1800, 1000, 1)),
              ElementsAre(HasSubstr("comes before a birth certificate")));
}

TEST_F(Sparkplug, BirthsAreReadingsWhereAsked) {
  settings_.births_are_readings = true;
  begin();
  EXPECT_THAT(tell("NBIRTH/E", node_birth()), IsEmpty());
  EXPECT_THAT(tell("DBIRTH/E/pump", birth(1, 1000, 2)), ElementsAre("pump 1000 0.001 7200"));
}

TEST_F(Sparkplug, UnitsOfMeasureAreCheckedOrTaken) {
  const auto in = [](const char* unit) {
    return fmt::format(" properties {{ keys: 'engUnit' values {{ type: 12 string_value: '{}' }} }}",
                       unit);
  };
  tell("NBIRTH/E", node_birth());
  EXPECT_THAT(tell("DBIRTH/E/pump", birth(1, 1000, 2, in("mm"))), IsEmpty());
  EXPECT_THAT(tell("DDATA/E/pump", both(2, 1500, 2, 3)),
              ElementsAre("Wear comes in 'mm' by its engUnit, but in 'um' by the configuration"));
  int n = 3;
  for (const char* good : {"um", "micrometer", "no such unit"}) {
    tell("DBIRTH/E/pump", birth(n++, 1000, 2, in(good)));
    EXPECT_THAT(tell("DDATA/E/pump", both(n++, 1500, 2000, 3)),
                ElementsAre("pump 1500 0.002 10800"))
        << good;
  }
  settings_.mapping.columns[0].unit = Unit{"m", 1, 0};
  settings_.mapping.columns[0].unit_of_message = true;
  decoder_ = std::make_unique<SparkplugDecoder>(settings_);
  tell("NBIRTH/E", node_birth());
  tell("DBIRTH/E/pump", birth(1, 1000, 2, in("mm")));
  EXPECT_THAT(tell("DDATA/E/pump", both(2, 1500, 2, 3)), ElementsAre("pump 1500 0.002 10800"));
  tell("DBIRTH/E/pump", birth(3, 1000, 2));
  EXPECT_THAT(tell("DDATA/E/pump", both(4, 1500, 2, 3)), ElementsAre("Wear has no engUnit"));
  tell("DBIRTH/E/pump", birth(5, 1000, 2, in("bar")));
  EXPECT_THAT(tell("DDATA/E/pump", both(6, 1500, 2, 3)),
              ElementsAre(HasSubstr("engUnit of Wear: unit 'bar'")));
}

TEST_F(Sparkplug, OnlyGoodQualityCounts) {
  const auto quality = [](int code) {
    return fmt::format(" properties {{ keys: 'Quality' values {{ type: 3 int_value: {} }} }}",
                       code);
  };
  live();
  EXPECT_THAT(tell("DDATA/E/pump", payload(2, metric(1, 1500, number(1) + quality(0)))),
              ElementsAre("Wear does not have good quality, by its edge node"));
  EXPECT_THAT(tell("DDATA/E/pump", payload(3, metric(1, 1600, number(1)))), testing::SizeIs(1));
  EXPECT_THAT(tell("DDATA/E/pump", payload(4, metric(1, 1700, number(1000) + quality(192)))),
              ElementsAre("pump 1700 0.001 7200"));
}

// Two pumps of one name are two machines.
TEST_F(Sparkplug, TwoDevicesOfOneNameAreNotTakenForOne) {
  live();
  tell("NBIRTH/F", node_birth());
  EXPECT_THAT(tell("DBIRTH/F/pump", birth(1, 1000, 2)),
              ElementsAre(HasSubstr("has unit 'pump', as does G/E/pump; distinguish them")));
  EXPECT_THAT(tell("DDATA/F/pump", both(2, 1500, 2000, 3)),
              ElementsAre(HasSubstr("follows a birth certificate that has unit 'pump'")));
  EXPECT_THAT(tell("DDATA/E/pump", both(2, 1500, 2000, 3)), testing::SizeIs(1));
  settings_.mapping.unit = "{edge}/{device}";
  decoder_ = std::make_unique<SparkplugDecoder>(settings_);
  live();
  EXPECT_THAT(tell("DDATA/E/pump", both(2, 1500, 2000, 3)), ElementsAre("E/pump 1500 0.002 10800"));
}

TEST_F(Sparkplug, AMetricMayNameTheMachine) {
  settings_.mapping.unit = "Serial";
  settings_.mapping.sequence = "Count";
  begin();
  tell("NBIRTH/E", node_birth());
  tell("DBIRTH/E/pump", payload(1, born_metric("Wear", 1, double_type, number(1)) +
                                       born_metric("Hours", 2, double_type, number(2)) +
                                       born_metric("Serial", 3, text_type, "string_value: 'S-7'") +
                                       born_metric("Count", 4, 8, "long_value: 0")));
  EXPECT_THAT(tell("DDATA/E/pump",
                   payload(2, metric(1, 1500, number(2000)) + metric(4, 1500, "long_value: 12"))),
              ElementsAre("S-7 12 0.002 7200"));
  EXPECT_THAT(tell("DDATA/E/pump", payload(3, metric(1, 1600, number(2000)))),
              ElementsAre("Count is missing"));  // it does not hold
  EXPECT_THAT(tell("DDATA/E/pump", payload(4, metric(3, 1600, "string_value: 'S-8'"))), IsEmpty());
  EXPECT_THAT(tell("DDATA/E/pump",
                   payload(5, metric(1, 1700, number(2000)) + metric(4, 1700, "long_value: 1"))),
              ElementsAre("S-8 1 0.002 7200"));
}

TEST_F(Sparkplug, HostileMessagesAreCountedAndLeaveTheOthersAlone) {
  settings_.mapping.time.clear();
  settings_.mapping.sequence = "{timestamp}";
  begin();
  const std::vector<std::pair<std::string, std::string>> seeds = {
      {"NBIRTH/E", node_birth()},
      {"DBIRTH/E/pump", birth(1, 1000, 2,
                              " properties { keys: 'engUnit' values { type: 12 "
                              "string_value: 'um' } keys: 'Quality' values { "
                              "int_value: 192 } }")},
      {"DDATA/E/pump", both(2, 1500, 2000, 3)},
      {"DDATA/E/pump", both(2, 1600, 2000, 3)},
      {"NDEATH/E", node_birth()}};
  Rng rng(29, 1);
  std::vector<Row> rows;
  std::uint64_t taken = 0, refused = 0;
  constexpr int count = 100'000;
  for (int i = 0; i < count; ++i) {
    auto [topic, bytes] = seeds[rng.bits() % seeds.size()];
    if (rng.bits() % 4 == 0) {  // alive again, so that what follows is read
      decoder_->read("spBv1.0/G/NBIRTH/E", seeds[0].second, rows);
      decoder_->read("spBv1.0/G/DBIRTH/E/pump", seeds[1].second, rows);
    }
    for (std::uint64_t k = rng.bits() % 4; k > 0 && !bytes.empty(); --k) {
      const std::size_t at = rng.bits() % bytes.size(), length = 1 + rng.bits() % 8;
      switch (rng.bits() % 5) {
        case 0:
          bytes[at] = static_cast<char>(rng.bits());
          break;
        case 1:
          bytes.erase(at, length);
          break;
        case 2:
          bytes.insert(at, bytes.substr(rng.bits() % bytes.size(), length));
          break;
        case 3:
          bytes.insert(at, 10, '\xff');  // a length or a number without end
          break;
        default:
          bytes.resize(at);
      }
    }
    decoder_->read("spBv1.0/G/" + topic, bytes, rows);
    decoder_->rebirths(i);
    if (rows.size() < 500) continue;
    const Delivery delivery = intake_->deliver(settings_, rows);
    ASSERT_TRUE(delivery.stored) << delivery.problem;
    EXPECT_EQ(delivery.readings + delivery.refused + delivery.repeated, rows.size());
    taken += delivery.readings;
    refused += delivery.refused;
    rows.clear();
  }
  catch_up();
  EXPECT_GT(taken, 10U);
  EXPECT_GT(refused, 10'000U);
  EXPECT_EQ(store_->count(), taken);
  decoder_ = std::make_unique<SparkplugDecoder>(settings_);
  live();
  EXPECT_THAT(tell("DDATA/E/pump", both(2, 1'000'000, 2000, 3)), testing::SizeIs(1));
}

TEST_F(Sparkplug, IsBounded) {
  live();
  // Properties within properties, deeper than any stack: passed over, not followed.
  const auto within = [](char tag, const std::string& inner) {
    std::string outer(1, tag);
    for (std::size_t n = inner.size();; n >>= 7) {
      outer += static_cast<char>((n & 127) | (n > 127 ? 128 : 0));
      if (n <= 127) return outer + inner;
    }
  };
  std::string set;
  for (int i = 0; i < 20'000; ++i)
    set =
        within(0x0a, "a") + within(0x12, within(0x4a, set));  // keys, values { propertyset_value }
  EXPECT_THAT(tell("DDATA/E/pump", within(0x12, "\x10\x01" + within(0x4a, set)) + "\x18\x02"),
              ElementsAre(HasSubstr("Wear has no time")));
  std::string many;
  for (int i = 0; i <= 100'000; ++i) many += std::string("\x12\x00", 2);
  EXPECT_THAT(tell("DDATA/E/pump", many), ElementsAre(HasSubstr("has more than 100000 metrics")));
  EXPECT_THAT(tell("DDATA/E/pump", std::string(5 << 20, 'x')),
              ElementsAre(HasSubstr("the limit is")));
  EXPECT_THAT(tell("WHAT/E", ""), ElementsAre(HasSubstr("is not a topic of an edge node")));
  EXPECT_THAT(tell("NDATA/E/pump", ""), ElementsAre(HasSubstr("is not a topic of an edge node")));
}

}  // namespace
}  // namespace wearwell::monitor
