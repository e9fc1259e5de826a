#pragma once

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "support/disk_content.h"
#include "support/scratch.h"
#include "support/servers.h"
#include "wearwell/base/rng.h"
#include "wearwell/base/sha1.h"
#include "wearwell/monitor/store.h"
#include "wearwell/prognosis/carried_state.h"

namespace wearwell::monitor {

/// The program itself over a population that was learned from the wear of twelve machines.
class ProgramRig : public ScratchTest {
 protected:
  static constexpr const char* columns = R"(sequence = "n"
event = "event"
time = "t"
time_format = "unix s"
[reading.columns]
depth = { field = "h", unit = "um" }
force = { value = "20 N" }
distance = { field = "km", unit = "km" }
)";

  static void SetUpTestSuite() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "wearwell-fleet-XXXXXX").string();
    learned_ = mkdtemp(pattern.data());
    const CommandResult fit =
        run_wearwell("fit '" PROJECT_SOURCE_DIR "/examples/formula/study.toml' -o '" + result() +
                     "' --quiet --no-report --chains 2 --draws 300 --warmup 400");
    ASSERT_LE(fit.exit_code, 1) << fit.err;
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(learned_); }
  static std::string result() { return (learned_ / "result").string(); }

  /// A configuration with these sources, in a folder of its own.
  std::filesystem::path configure(const std::string& name, const std::string& sources,
                                  const std::string& store = "fleet.sqlite",
                                  bool topic_names_unit = false) const {
    std::filesystem::create_directories(folder() / name / "incoming");
    return write(name + "/fleet.toml",
                 fmt::format("result = \"{}\"\n[store]\nurl = "
                             "\"{}\"\n[reading]\n{}{}\n{}\n[alarm]\nhorizon = \"10 km\"\n",
                             result(), store, topic_names_unit ? "" : "unit = \"machine\"\n",
                             columns, sources));
  }
  static constexpr const char* folder_source =
      "[source.drop]\nkind = \"folder\"\nfolder = \"incoming\"\n";

  ChildProcess start(const std::filesystem::path& config) const {
    return ChildProcess({WEARWELL_BINARY, "monitor", config.string(), "--threads", "2"},
                        config.parent_path() / "log");
  }
  static std::string log(const std::filesystem::path& config) {
    return content(config.parent_path() / "log");
  }

  /// Readings of so many machines, in the order in which they are sent.
  static std::vector<std::string> readings(int machines, int each, bool with_machine = true) {
    Rng rng(11, 1);
    std::vector<double> rates;
    for (int i = 0; i < machines; ++i) rates.push_back(0.8 * std::exp(0.35 * rng.normal()));
    std::vector<std::string> lines;
    for (int n = 1; n <= each; ++n) {
      for (int i = 0; i < machines; ++i) {
        const double km = 0.5 * n;
        lines.push_back(fmt::format("{{{}\"n\": {}, \"t\": {}, \"km\": {}, \"h\": {:.4f}}}",
                                    with_machine ? fmt::format("\"machine\": \"M{:02}\", ", i) : "",
                                    n, 1'700'000'000 + 60 * n, km,
                                    rates[i] * km + 1.2 * rng.normal()));
      }
    }
    return lines;
  }
  static void append(const std::filesystem::path& file, const std::vector<std::string>& lines) {
    std::ofstream out(file, std::ios::app);
    for (const std::string& line : lines) out << line << '\n';
  }

  static std::unique_ptr<Store> look(const std::filesystem::path& config, const std::string& url) {
    return open_store(url, config.parent_path(), {{"depth", "force", "distance"}, {}, true},
                      Access::read);
  }
  static std::uint64_t stored(const std::filesystem::path& config,
                              const std::string& url = "fleet.sqlite") {
    try {
      return look(config, url)->count();
    } catch (const std::exception&) {
      return 0;
    }
  }
  /// All that a store knows but when messages came: readings in their order, and states to the last bit.
  static std::string known(const std::filesystem::path& config,
                           const std::string& url = "fleet.sqlite") {
    const auto store = look(config, url);
    std::string all;
    for (const StoredReading& each : store->after(0, SIZE_MAX / 2))
      all += fmt::format("{} {} {}\n", each.unit, each.key, json_of(each.numbers));
    std::map<std::string, std::string> states;
    const std::string population = sha1_of(prognosis::state_bytes(prognosis::read_state(result())));
    for (const Checkpoint& each : store->states(population)) {
      nlohmann::json state = nlohmann::json::from_cbor(each.bytes);
      state.erase("received_ms");
      const auto bytes = nlohmann::json::to_cbor(state);
      states[each.unit] = std::string(bytes.begin(), bytes.end());
    }
    for (const auto& [unit, bytes] : states) all += unit + bytes;
    return fmt::format("{} states\n", states.size()) + all;
  }

  static inline std::filesystem::path learned_;
};

}  // namespace wearwell::monitor
