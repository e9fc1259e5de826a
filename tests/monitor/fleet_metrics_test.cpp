#include "wearwell/monitor/fleet_metrics.h"

#include <gmock/gmock.h>

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "monitor/generated_fleet.h"

namespace wearwell::monitor {
namespace {

using testing::HasSubstr;

/// What `promtool check metrics` finds fault with, and what its parser refuses; "" where nothing is wrong.
std::string fault_in(const std::string& text) {
  static const std::regex help("# HELP ([a-zA-Z_:][a-zA-Z0-9_:]*) \\S.*");
  static const std::regex type("# TYPE ([a-zA-Z_:][a-zA-Z0-9_:]*) (counter|gauge)");
  static const std::regex sample(
      "([a-zA-Z_:][a-zA-Z0-9_:]*)(?:\\{((?:[a-zA-Z_][a-zA-Z0-9_]*=\"(?:[^\"\\\\]|\\\\[\"\\\\n])*\","
      "?)*)"
      "\\})? (NaN|[+-]Inf|[-+0-9.e]+)");
  if (text.empty() || text.back() != '\n') return "no line feed at the end";
  std::set<std::string> families, series;
  std::string family, kind, helped;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (std::regex_match(line, found, help)) {
      helped = found[1];
      if (!families.insert(helped).second) return "two families: " + helped;
    } else if (std::regex_match(line, found, type)) {
      family = found[1];
      kind = found[2];
      if (family != helped) return "no help: " + family;
      const bool total = family.ends_with("_total");
      if (total != (kind == "counter")) return "_total and counters: " + family;
      for (const char* unit : {"milliseconds", "_ms", "minutes", "hours", "percent", "kb"}) {
        if (family.find(unit) != family.npos) return "no base unit: " + family;
      }
    } else if (std::regex_match(line, found, sample)) {
      if (found[1] != family) return "not of its family: " + line;
      const std::string labels = "," + found[2].str();
      for (const char* reserved : {",quantile=", ",le=", ",__"}) {
        if (labels.find(reserved) != labels.npos) return "reserved label: " + line;
      }
      if (!series.insert(found[1].str() + labels).second) return "two samples: " + line;
    } else {
      return "neither help, type nor sample: " + line;
    }
  }
  return "";
}

TEST(FleetMetrics, AreAsPrometheusWantsThem) {
  const GeneratedFleet fleet(40);
  const auto units = fleet.units("", 0, 1000, nullptr);
  const std::string text = metrics_text(fleet.fleet(), units, {3, 2, {{200, 41}, {404, 1}}});
  EXPECT_EQ(fault_in(text), "");
  EXPECT_THAT(text, HasSubstr("\nwearwell_fleet_limit 80\n"));
  EXPECT_THAT(text, HasSubstr("\nwearwell_http_responses_total{code=\"200\"} 41\n"));
  EXPECT_THAT(text, HasSubstr("{unit=\"never heard of\",percentile=\"95\"} +Inf\n"));
  EXPECT_THAT(text, HasSubstr("{unit=\"Pumpe Süd \\\"3\\\" \\\\ µ\"}"));
}

// The dashboard of Grafana asks for what there is: each metric and label of its queries.
TEST(FleetMetrics, AreThoseOfTheDashboard) {
  const GeneratedFleet fleet(40);
  const std::string text = metrics_text(fleet.fleet(), fleet.units("", 0, 1000, nullptr), {});
  std::ifstream file(PROJECT_SOURCE_DIR "/setup/package/grafana.json");
  const auto dashboard = nlohmann::json::parse(file);
  std::vector<std::string> queries;
  for (const auto& panel : dashboard["panels"]) {
    for (const auto& target : panel["targets"]) queries.push_back(target["expr"]);
  }
  for (const auto& each : dashboard["templating"]["list"]) {
    if (each["type"] == "query") queries.push_back(each["definition"]);
  }
  EXPECT_GT(queries.size(), 10U);
  const std::regex metric("wearwell_[a-z_0-9]+"), label("([a-z]+)=~?\"([^\"]*)\"");
  for (const std::string& query : queries) {
    std::smatch found;
    ASSERT_TRUE(std::regex_search(query, found, metric)) << query;
    const std::string name = found[0];
    EXPECT_THAT(text, HasSubstr("# TYPE " + name + " ")) << query;
    for (std::sregex_iterator at(query.begin(), query.end(), label), end; at != end; ++at)
      EXPECT_TRUE(std::regex_search(text, std::regex(name + "\\{[^\n]*" + (*at)[1].str() + "=\"")))
          << query;
  }
}

TEST(FleetMetrics, KeepLinesWhole) {
  UnitView unit;
  unit.unit = "a\n# TYPE b gauge\"} 1\\";
  unit.risk = std::numeric_limits<double>::quiet_NaN();
  const std::string text = metrics_text({}, {unit}, {});
  EXPECT_EQ(fault_in(text), "");
  EXPECT_THAT(text, HasSubstr("{unit=\"a\\n# TYPE b gauge\\\"} 1\\\\\"} NaN\n"));
}

TEST(FleetMetrics, TheTestFindsFaults) {
  EXPECT_NE(fault_in("a 1\n"), "");
  EXPECT_NE(fault_in("# HELP a x\n# TYPE a counter\na 1\n"), "");
  EXPECT_NE(fault_in("# HELP a x\n# TYPE a gauge\na 1\na 2\n"), "");
  EXPECT_NE(fault_in("# HELP a x\n# TYPE a gauge\na{b=\"\"\"} 2\n"), "");
}

}  // namespace
}  // namespace wearwell::monitor
