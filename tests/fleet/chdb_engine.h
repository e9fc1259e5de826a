#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/run_command.h"
#include "wearwell/base/error.h"
#include "wearwell/fleet/clickhouse_text.h"
#include "wearwell/fleet/engine.h"

namespace wearwell {

/// Today's ClickHouse within a process of node: chDB, in a folder that WEARWELL_CHDB names (`npm install chdb@3.4.0` in it; 546
/// MB, which is why setup/install does not). Each call is a process of its own over the same database.
class ChdbEngine : public fleet::Engine {
 public:
  static std::string missing() {
    const char* folder = std::getenv("WEARWELL_CHDB");
    if (!folder || !std::filesystem::exists(std::filesystem::path(folder) / "node_modules/chdb"))
      return "WEARWELL_CHDB names no folder with node_modules/chdb (npm install chdb@3.4.0)";
    return "";
  }

  explicit ChdbEngine(const std::filesystem::path& folder) : folder_(folder) {
    std::ofstream(folder / "chdb.js")
        << "const { Session } = require(process.env.WEARWELL_CHDB + '/node_modules/chdb');\n"
           "const fs = require('fs');\n"
           "const session = new Session(process.argv[2]);\n"
           "let answer = '';\n"
           "try {\n"
           "  for (const each of JSON.parse(fs.readFileSync(process.argv[3])))\n"
           "    answer = session.query(each, 'TabSeparated');\n"
           "} catch (error) { console.error(String(error.message)); process.exit(1); }\n"
           "fs.writeFileSync(process.argv[4], answer);\n";
  }

  fleet::Dialect dialect() const override { return fleet::Dialect::clickhouse; }
  std::string description() const override { return "chDB"; }
  std::string table() const override { return ""; }
  std::string source() const override { return "chDB"; }
  std::vector<fleet::EngineColumn> columns() override { return {}; }
  void begin() override {}
  void commit() override {}
  void run(const std::string& statements, const Monitor&, const std::string&, long long) override {
    answer(statements);
  }
  void rows(const std::string& query, std::size_t texts,
            const std::function<void(const fleet::Row&)>& take) override {
    fleet::SeparatedText().add(answer(query), [&](const std::vector<std::string>& cells) {
      fleet::Row row{{cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(texts)}, {}};
      for (std::size_t c = texts; c < cells.size(); ++c)
        row.numbers.push_back(fleet::separated_number(cells[c]));
      take(row);
    });
  }

 private:
  std::string answer(const std::string& statements) const {
    nlohmann::json all = {
        "set max_query_size = 16777216, max_ast_elements = 1000000, "
        "max_expanded_ast_elements = 10000000"};
    for (const std::string& each : fleet::single_statements(statements)) all.push_back(each);
    std::ofstream(folder_ / "statements.json") << all.dump();
    const std::string here = folder_.string();
    const CommandResult done =
        run_command("node '" + here + "/chdb.js' '" + here + "/chdb' '" + here +
                    "/statements.json' '" + here + "/answer' >/dev/null");
    if (done.exit_code != 0) throw InputError(fleet::error_sentence(done.err));
    std::ifstream in(folder_ / "answer");
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
  }

  std::filesystem::path folder_;
};

}  // namespace wearwell
