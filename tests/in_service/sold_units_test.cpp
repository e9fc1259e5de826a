// `wearwell returns`: counts of units sold and returned, in files and databases.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/run_command.h"
#include "support/scratch.h"
#include "support/servers.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string units_file = PROJECT_SOURCE_DIR "/examples/warranty/units.csv";

class SoldUnitsTest : public ScratchTest {
 protected:
  std::string out() const { return (folder() / "returns.csv").string(); }
  CommandResult count(const std::string& arguments) {
    return run_wearwell("returns " + arguments + " -o '" + out() + "'");
  }
  std::string triangle(const std::string& arguments) {
    const CommandResult run = count(arguments);
    EXPECT_EQ(run.exit_code, 0) << arguments << run.err;
    std::ifstream stream(out());
    std::string lines{std::istreambuf_iterator<char>(stream), {}};
    std::erase(lines, '\r');
    return lines;
  }
  std::string table(const std::string& content) {
    return "'" + write("t.csv", content).string() + "'";
  }
  void refused(const std::string& content, const std::string& why,
               const std::string& columns = "sold=sold returned=back") {
    const CommandResult run = count(table(content) + " --columns " + columns + " --until 2024-03");
    EXPECT_EQ(run.exit_code, 2) << content;
    EXPECT_THAT(run.err, HasSubstr(why));
    EXPECT_FALSE(std::filesystem::exists(out()));
  }
};

TEST_F(SoldUnitsTest, CountsByMonth) {
  EXPECT_EQ(triangle(table("sold,back\n2024-01-01,\n2024-01-31,2024-01-31\n2024-01-15,2024-03-01\n"
                           "2024-03-31,\n2024-02-29,2024-04-01\n2024-04-01,\n") +
                     " --columns sold=sold returned=back --until 2024-03"),
            "sold,units,2024-01,2024-02,2024-03\n2024-01,3,1,0,1\n2024-02,1,,0,0\n2024-03,1,,,0\n");
  EXPECT_THAT(
      count("'" + (folder() / "t.csv").string() +
            "' --columns sold=sold returned=back --until 2024-03")
          .out,
      HasSubstr("5 units sold from 2024-01 to 2024-03, 2 returned until 2024-03\nLeft out: 1 "
                "unit sold after 2024-03\nIn use: 1 unit returned after 2024-03\n"));
}

TEST_F(SoldUnitsTest, QuantitiesAndModesAreCounted) {
  EXPECT_EQ(triangle(table("sold,back,n,why\n2024-01-01,,7,\n2024-01-02,2024-02-01,2,seal\n"
                           "2024-01-02,2024-02-01,1,motor\n2024-02-02,2024-02-03,1,\n") +
                     " --columns sold=sold returned=back quantity=n mode=why --until 2024-02"),
            "sold,mode,units,2024-01,2024-02\n2024-01,,10,0,0\n2024-01,motor,10,0,1\n"
            "2024-01,seal,10,0,2\n2024-02,,1,,1\n2024-02,motor,1,,0\n2024-02,seal,1,,0\n");
}

TEST_F(SoldUnitsTest, Refusals) {
  refused("sold,back\n2024-02-01,2024-01-31\n2024-02-01,\n",
          "have a return in 2024-01, before the sale");
  refused("sold,back\n2024-02-01,2024-02-02\n,2024-02-03\n",
          "1 row without a date in column 'sold'");
  refused("sold,back\nMay,2024-01-31\n", "column 'sold' does not hold dates");
  refused("sold,back\n2024-02-01,2024-03-01\n", "has no column 'bak' (nearest: 'back')",
          "sold=sold returned=bak");
  refused("sold,back,n\n2024-02-01,2024-03-01,1.5\n", "no whole number in column 'n'",
          "sold=sold returned=back quantity=n");
  refused("sold,back,why\n2024-02-01,,seal\n2024-02-01,2024-03-01,seal\n",
          "have the failure mode 'seal', but no date", "sold=sold returned=back mode=why");
  refused("sold,back\n2024-05-01,2024-06-01\n", "no unit was sold until 2024-03");
  refused("sold,back\n2024-02-01,2024-03-01\n", "'returned' is missing", "sold=sold");
  EXPECT_THAT(count(table("sold,back\n2024-02-01,2024-03-01\n") +
                    " --columns sold=sold returned=back --until soon")
                  .err,
              HasSubstr("'soon' is no month"));
}

// The triangle that is counted has the fit and the forecast of the table of single units.
TEST_F(SoldUnitsTest, TheTriangleHasTheForecastOfSingleUnits) {
  const std::string counted = triangle(
      "'" + units_file + "' --columns 'sold=sale date' 'returned=failure date' --until 2025-12");
  std::ifstream stream(PROJECT_SOURCE_DIR "/examples/warranty/units.toml");
  std::string study{std::istreambuf_iterator<char>(stream), {}};
  const auto replace = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(study.find(from), study.npos) << from;
    study.replace(study.find(from), study.find('\n', study.find(from)) - study.find(from), to);
  };
  replace("file = ", "file = \"returns.csv\"");
  replace("sold     = ", "sold = \"sold\"");
  replace("returned = ", "quantity = \"units\"");
  replace("until ", "");
  write("triangle.toml", study);
  const auto forecast = [&](const std::string& file) {
    const CommandResult run =
        run_wearwell("fit '" + file + "' --method exact --no-report --json -o '" +
                     (folder() / "fit").string() + "'");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return json::parse(run.out)["returns"]["forecast"];
  };
  const json of_triangle = forecast((folder() / "triangle.toml").string()),
             of_units = forecast(PROJECT_SOURCE_DIR "/examples/warranty/units.toml");
  EXPECT_EQ(of_triangle.dump(), of_units.dump());
  EXPECT_EQ(
      run_wearwell("new '" + (folder() / "new").string() + "' --from '" + out() + "'").exit_code,
      0);
}

TEST_F(SoldUnitsTest, PostgresHasTheCountsOfFiles) {
  const std::string missing = PostgresServer::missing();
  if (!missing.empty()) GTEST_SKIP() << "NOT TESTED with PostgreSQL: " << missing;
  const std::string of_file = triangle(
      "'" + units_file + "' --columns 'sold=sale date' 'returned=failure date' --until 2025-12");
  const PostgresServer server(folder() / "postgres");
  const CommandResult made = server.sql(
      "create table units (serial text, sold date, back date);\n"
      "\\copy units from '" +
      units_file +
      "' with (format csv, header true)\n"
      "create view clock as select (sold + time '23:30') at time zone 'UTC' as sold, "
      "(back + time '23:30') at time zone 'UTC' as back, 1::numeric as n from units;\n"
      "alter database postgres set timezone = 'Asia/Tokyo';\n");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string at = " --engine " + server.url();
  EXPECT_EQ(triangle(at + " --table units --columns sold=sold returned=back --until 2025-12"),
            of_file);
  // Timestamps with a time zone count in UTC, whatever the time zone of the session.
  EXPECT_EQ(
      triangle(at + " --table clock --columns sold=sold returned=back quantity=n --until 2025-12"),
      of_file);
}

}  // namespace
}  // namespace wearwell
