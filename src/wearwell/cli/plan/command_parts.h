#pragma once

#include <filesystem>
#include <functional>

#include "wearwell/plan/answer.h"
#include "wearwell/study/model.h"

namespace CLI {
class App;
}

/// The subcommands of `wearwell plan`, one file each, and what they share.
namespace wearwell::plan {

/// How an answer is given.
struct AnswerOptions {
  std::filesystem::path output;  ///< folder of page, tables and plan.json; may be empty
  bool json = false;             ///< print one JSON object instead of the text
};
void add_answer_options(CLI::App& command, AnswerOptions& options);

/// Opens the folder, works, writes and prints. The exit code: 0, or 1 where the fit beneath is not
/// trusted.
int give_answer(const AnswerOptions& options, const std::function<Answer()>& work);

void add_inspect_command(CLI::App& plan, Models models, int& exit_code);
void add_size_command(CLI::App& plan, Models models, int& exit_code);
void add_next_command(CLI::App& plan, Models models, int& exit_code);
void add_accelerate_command(CLI::App& plan, int& exit_code);
void add_demonstrate_command(CLI::App& plan, int& exit_code);

}  // namespace wearwell::plan
