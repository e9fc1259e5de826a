#pragma once

#include <string>
#include <utility>
#include <vector>

#include "wearwell/embed/plan_arguments.h"
#include "wearwell/plan/answer.h"

namespace wearwell::embed {

/// The answer to a question, as the command of the question prints and writes it.
struct Answer {
  std::string title, text;
  std::string json;                                         ///< its JSON file
  std::vector<std::pair<std::string, std::string>> tables;  ///< name and CSV
  std::string page;                                         ///< report.html
  bool trusted = true;                                      ///< the fit that it rests on
};

/// Makes files of an answer, with arguments in place of options in its texts. `heading` is that of the
/// page.
Answer shown(plan::Answer answer, const std::string& heading, const PlanArguments& arguments);

}  // namespace wearwell::embed
