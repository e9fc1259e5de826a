// The program among a broker and an edge node of Sparkplug B that is played by the test.
#include <gmock/gmock.h>

#include "monitor/program_rig.h"
#include "monitor/sparkplug_encoder.h"

namespace wearwell::monitor {
namespace {

using testing::HasSubstr;

class SparkplugPrograms : public ProgramRig {
 protected:
  void SetUp() override {
    if (!Broker::installed() || !has_protoc() ||
        run_command("command -v mosquitto_pub mosquitto_sub").exit_code != 0)
      GTEST_SKIP() << "mosquitto, its clients or protoc are not installed";
    broker_ = std::make_unique<Broker>(folder() / "broker");
  }
  std::filesystem::path configure_sparkplug() const {
    std::filesystem::create_directories(folder() / "a");
    return write("a/fleet.toml", fmt::format(R"(result = "{}"
[store]
url = "fleet.sqlite"
[alarm]
horizon = "10 km"
[reading]
unit = "{{device}}"
sequence = "{{timestamp}}"
time = "{{timestamp}}"
time_format = "unix ms"
[reading.columns]
depth = {{ field = "Wear/Depth", unit = "um" }}
force = {{ field = "Force", unit = "{{engUnit}}" }}
distance = {{ field = "Distance", unit = "km" }}
[source.plant]
kind = "sparkplug"
broker = "{}"
group = "Plant 1"
host = "wearwell"
)",
                                             result(), broker_->url()));
  }
  void send(const std::string& topic, const std::string& bytes) const {
    const auto file = write("payload", bytes);
    const CommandResult run =
        run_command(fmt::format("mosquitto_pub -p {} -t 'spBv1.0/Plant 1/{}' -f '{}'",
                                broker_->port(), topic, file.string()));
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  void be_born() const {
    send("NBIRTH/E",
         payload(0, "metrics { name: 'bdSeq' timestamp: 1000 datatype: 4 long_value: 0 }"));
    for (int i = 0; i < machines; ++i)
      send(fmt::format("DBIRTH/E/M{:02}", i),
           payload(1 + i,
                   born_metric("Wear/Depth", 10 * i, double_type, number(0)) +
                       born_metric("Force", 10 * i + 1, double_type,
                                   "double_value: 0.02 properties { keys: 'engUnit' values { type: "
                                   "12 string_value: 'kN' } }") +
                       born_metric("Distance", 10 * i + 2, 9, "float_value: 0")));
  }
  void send_data(int n, int from_sequence) const {
    for (int i = 0; i < machines; ++i) {
      const long long time = 1'700'000'000'000 + 60'000 * n;
      send(fmt::format("DDATA/E/M{:02}", i),
           payload(from_sequence + i,
                   metric(10 * i, time, number(0.8 * 0.5 * n)) +
                       metric(10 * i + 2, time + 3, fmt::format("float_value: {}", 0.5 * n))));
    }
  }
  std::string state() const {
    return run_command(fmt::format("mosquitto_sub -p {} -t 'spBv1.0/STATE/wearwell' -C 1 -W 5",
                                   broker_->port()))
        .out;
  }
  bool follows(const std::filesystem::path& config, std::size_t from = 0) const {
    return eventually([&] {
      return log(config).find("follows spBv1.0/Plant 1/+/+/#", from) != std::string::npos;
    });
  }
  static constexpr int machines = 3;
  std::unique_ptr<Broker> broker_;
};

TEST_F(SparkplugPrograms, FollowAnEdgeNodeThroughBirthsAndKills) {
  const auto config = configure_sparkplug();
  ChildProcess monitor = start(config);
  ASSERT_TRUE(follows(config)) << log(config);
  EXPECT_THAT(state(), HasSubstr("{\"online\":true,\"timestamp\":"));
  be_born();
  send_data(1, 4);
  send_data(2, 7);
  EXPECT_TRUE(eventually([&] { return stored(config) == 2 * machines; })) << log(config);
  EXPECT_THAT(look(config, "fleet.sqlite")->after(0, 1).at(0).numbers,
              testing::ElementsAre(testing::DoubleEq(0.4e-6), testing::DoubleEq(20),
                                   testing::DoubleEq(500)));
  // Killed, it asks for what it does not know any more.
  monitor.end(SIGKILL);
  EXPECT_TRUE(eventually([&] { return state().find("\"online\":false") != std::string::npos; }));
  const std::size_t reported_before = log(config).size();
  monitor = start(config);
  ASSERT_TRUE(follows(config, reported_before)) << log(config);
  const auto asked = folder() / "asked";
  ChildProcess edge({"mosquitto_sub", "-p", std::to_string(broker_->port()), "-t",
                     "spBv1.0/Plant 1/NCMD/E", "-C", "1", "-F", "%x"},
                    asked);
  ASSERT_TRUE(eventually([&] {
    send("NDATA/E", payload(77, ""));
    return !content(asked).empty();
  })) << log(config);
  EXPECT_THAT(content(asked),
              HasSubstr("4e6f646520436f6e74726f6c2f52656269727468"));  // Node Control/Rebirth
  EXPECT_THAT(log(config), HasSubstr("asks for birth certificates: spBv1.0/Plant 1/NCMD/E"));
  be_born();
  send_data(2, 4);  // again
  send_data(3, 7);
  EXPECT_TRUE(eventually([&] { return stored(config) == 3 * machines; })) << log(config);
  // The same of the broker.
  broker_->kill();
  broker_->start();
  EXPECT_TRUE(eventually([&] {
    be_born();
    send_data(4, 4);
    return stored(config) == 4 * machines;
  })) << log(config);
  EXPECT_EQ(monitor.end(SIGTERM), 0) << log(config);
  EXPECT_THAT(state(), HasSubstr("\"online\":false"));
}

}  // namespace
}  // namespace wearwell::monitor
