#pragma once

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {

/// A table that goes from file to a fitted study: `wearwell new --from`, then `wearwell fit`.
class NewFromTable : public ScratchTest {
 protected:
  CommandResult here(const std::string& words) {
    return run_command("cd '" + folder().string() + "' && '" WEARWELL_BINARY "' " + words);
  }
  std::string content(const std::string& file) {
    std::ifstream in(folder() / file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// What the first command prints; the result of the second is in `result_`.
  std::string fitted(const std::string& table, const std::string& text,
                     const std::string& options = "") {
    write(table, text);
    const CommandResult run = here("new --from " + table + " out " + options);
    EXPECT_EQ(run.exit_code, 0) << run.err << run.out << content("out/study.toml");
    EXPECT_THAT(run.out, testing::HasSubstr("wearwell fit out/study.toml"));
    EXPECT_EQ(content("out/" + table), text);
    const CommandResult fit =
        here("fit out/study.toml --method exact --draws 100 --json --no-report -o r");
    EXPECT_LE(fit.exit_code, 1) << fit.err << content("out/study.toml");
    if (fit.exit_code <= 1) result_ = nlohmann::json::parse(fit.out);
    return run.out;
  }
  nlohmann::json result_;
};

}  // namespace wearwell
