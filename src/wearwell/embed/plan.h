#pragma once

#include <string>
#include <utility>
#include <vector>

#include "wearwell/base/monitor.h"
#include "wearwell/embed/run.h"
#include "wearwell/input/table.h"

namespace wearwell::embed {

/// What a question about tests or inspections to come is about, as far as its kind asks for it.
struct PlanSubject {
  const Run* run = nullptr;          ///< "next", "inspect", "decide": a fit
  const ReadStudy* study = nullptr;  ///< "size"
  /// Instead of `run` the folder of a result; "inspect" and "decide" also a table of lives; "size" a study file.
  std::string path = {};
  /// By argument: "candidates", "in_service", "lives", "tests"; several of one argument in their order.
  std::vector<std::pair<std::string, Table>> tables = {};
};

/// The answer of `wearwell plan KIND`, or of `wearwell decide`.
struct PlanAnswer {
  std::string title, text;
  std::string json;                                         ///< plan.json, decisions.json
  std::vector<std::pair<std::string, std::string>> tables;  ///< name and CSV
  std::string page;                                         ///< report.html
  bool trusted = true;                                      ///< the fit that it rests on
};

/// Answers a question: `kind` is "next", "size", "demonstrate", "inspect", "accelerate" or
/// "decide".
/// `arguments` is a JSON object with the options of the command, hyphens being underscores; values
/// are texts, numbers, truths, or arrays of them. Texts of the answer and messages name arguments,
/// not options. Throws InputError, also if an argument is unknown or of a wrong type; Cancelled.
PlanAnswer plan(const std::string& kind, const std::string& arguments, const PlanSubject& subject,
                Monitor monitor);

}  // namespace wearwell::embed
