// Laws of users as SQL, in DuckDB; `cluster_test.cpp` and `clickhouse_test.cpp` do the same with servers.
#include <gmock/gmock.h>

#include "fleet/sample_kinds.h"
#include "fleet/sample_law.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/fleet/duckdb_engine.h"

namespace wearwell::formula_model {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class LawSqlTest : public ScratchTest {};

TEST_F(LawSqlTest, DuckdbHasTheNumbersOfTheLibrary) {
  const prognosis::CarriedState state = formula_state(folder());
  std::string csv = "id,machine,F,s\n";
  for (const LawRow& each : formula_rows())
    csv += fmt::format("{},{},{},{}\n", each.id, each.machine,
                       each.force < 0 ? "" : fmt::format("{}", each.force),
                       each.distance < 0 ? "" : fmt::format("{}", 1000 * each.distance));
  const auto engine = fleet::duckdb_engine(
      {.files = {write("rows.csv", csv).string()}, .unit = "machine", .spill = folder()});
  expect_library(state, *engine, "cycles", formula_values());

  // The draws: of the median machine's successors as the fit itself has them, and narrow where readings are.
  const SqlExport made = sql_export(state, {.table = "t", .draws = 4000});
  const auto quantile = [&](std::size_t u, double p) {
    std::vector<double> k = made.draws[u].effect[0];
    std::sort(k.begin(), k.end());
    return quantile_of_draws(k, p);
  };
  // The truth of the simulated machines: median 2e-6 mm^3/(N m), scatter 0.35 of the logarithm.
  EXPECT_NEAR(std::log(quantile(0, 0.5) / 2e-15), 0, 0.35);
  EXPECT_GT(std::log(quantile(0, 0.95) / quantile(0, 0.05)), 2 * 1.64 * 0.2);
  EXPECT_LT(std::log(quantile(1, 0.95) / quantile(1, 0.05)), 0.3);

  const auto refusal = [&](SqlExportChoice choice) {
    choice.table = choice.table.empty() ? "t" : choice.table;
    return message_of<InputError>([&] { sql_export(state, choice); });
  };
  EXPECT_THAT(refusal({.value = "cum(force)"}), HasSubstr("depends on earlier rows"));
  EXPECT_THAT(refusal({.value = "erf(wear/(1 [um]))"}), HasSubstr("erf"));
  EXPECT_THAT(refusal({.value = "force"}), HasSubstr("no parameter"));
  EXPECT_THAT(refusal({.value = "wear + force"}), HasSubstr("cannot be added"));
  EXPECT_THAT(refusal({.columns = {"force=F"}}), HasSubstr("write 'force=F:N'"));
  EXPECT_THAT(refusal({.columns = {"force=F:m"}}), HasSubstr("force is N"));
  EXPECT_THAT(refusal({.columns = {"farce=F:N"}}), HasSubstr("'farce'"));
  EXPECT_THAT(refusal({.keep = {"formula_q05"}}), HasSubstr("rename it in the table"));
  EXPECT_THAT(refusal({.unit = "kg"}), HasSubstr("'kg' is kg"));
  EXPECT_THAT(refusal({.draws = 30}), HasSubstr("multiple of 20"));
  EXPECT_THAT(
      run_wearwell("sql '" + (folder() / "formula").string() + "' --dialect duckdb --table t").err,
      HasSubstr("export sql"));
  EXPECT_THAT(refusal({.table = "a..b"}), HasSubstr("empty"));
}

// Two effects, a parameter of each label, temperatures with an offset.
TEST_F(LawSqlTest, DuckdbHasTheNumbersOfTheLibraryForEveryKindOfParameter) {
  std::string csv = "id,machine,mat,T,TF,hours\n";
  for (const PadRow& each : pad_rows())
    csv += fmt::format("{},{},{},{},{},{}\n", each.id, each.machine, each.material,
                       each.temperature, 32 + 1.8 * each.temperature, each.time);
  const auto engine = fleet::duckdb_engine(
      {.files = {write("pads.csv", csv).string()}, .unit = "machine", .spill = folder()});
  expect_pads(*engine, "cycles");
  // One column would silently stand for both.
  SqlExportChoice choice;
  choice.table = "t";
  EXPECT_THAT(message_of<InputError>([&] { sql_export(pad_state(), choice); }),
              HasSubstr("'T' and 't' are the same name for DuckDB"));
}

}  // namespace
}  // namespace wearwell::formula_model
