// The statements for ClickHouse in the ClickHouse of today.
#include <gmock/gmock.h>

#include "fleet/chdb_engine.h"
#include "fleet/sample_fleet.h"
#include "fleet/sample_law.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

class Chdb : public ScratchTest {
 protected:
  void SetUp() override {
    const std::string missing = ChdbEngine::missing();
    if (!missing.empty()) GTEST_SKIP() << "NOT TESTED with the ClickHouse of today: " << missing;
  }
};

TEST_F(Chdb, PrintedStatementsHaveTheNumbersOfPredict) {
  const auto cycles = clutch::fleet_cycles(600, 4, 14);
  const std::string model =
      "'" +
      write("model.json", to_json(clutch::fleet_model(clutch::ScatterKind::linear)).dump(1))
          .string() +
      "'";
  const std::string table = "'" + write("cycles.csv", clutch::fleet_csv(cycles)).string() + "'";
  ChdbEngine engine(folder());
  std::string rows =
      "create table cycles (vin String, cycle Int64, n Float64, m Nullable(Float64), temp Float64, "
      "t "
      "Float64, e Float64) engine = MergeTree order by vin;\ninsert into cycles values";
  for (const clutch::FleetCycle& c : clutch::shuffled(cycles, 6))
    rows += fmt::format(" ('{}', {}, {}, {}, {}, {}, {})", c.unit, c.number, c.slip_speed, c.torque,
                        c.temperature, c.closing_time, c.energy);
  engine.run(rows, {}, "", 0);
  const auto part = [&](const std::string& name) {
    const CommandResult printed = run_wearwell(
        "sql " + model + " --dialect clickhouse --table cycles --part " + name +
        " --columns unit=vin cycle=cycle slip_speed=n:rad/s 'torque=m:N m' temperature=temp:degC "
        "closing_time=t:s energy=e:J");
    EXPECT_EQ(printed.exit_code, 0) << printed.err;
    return printed.out;
  };
  for (int i = 0; i < 2; ++i) engine.run(part("setup") + part("query"), {}, "", 0);
  const auto expected =
      nlohmann::json::parse(run_wearwell("clutch predict " + model + " " + table + " --json").out);
  std::string combine = part("combine");
  combine.erase(combine.rfind(';'));
  std::size_t found = 0;
  engine.rows(combine, 1, [&](const fleet::Row& row) {
    for (const auto& p : expected["plates"]) {
      if (p["plate"] != row.texts[0]) continue;
      ++found;
      EXPECT_EQ(row.numbers[0], p["cycles"].get<double>());
      EXPECT_NEAR(row.numbers[3] / p["volume"].get<double>(), 1, 1e-9);
      EXPECT_NEAR(row.numbers[4] / p["sd_scatter"].get<double>(), 1, 1e-9);
      EXPECT_NEAR(row.numbers[7] / p["sd_full"].get<double>(), 1, 1e-9);
    }
  });
  EXPECT_EQ(found, 4u);
}

TEST_F(Chdb, ALawHasTheNumbersOfTheLibrary) {
  ChdbEngine engine(folder());
  engine.run(
      "create table liners (id Int32, machine String, F Nullable(Float64), s Nullable(Float64)) "
      "engine = "
      "MergeTree order by id;\ninsert into liners values" +
          formula_model::formula_row_values("\\'"),
      {}, "", 0);
  formula_model::expect_library(formula_model::formula_state(folder()), engine, "liners",
                                formula_model::formula_values());
}

}  // namespace
}  // namespace wearwell
