#pragma once

#include <string>
#include <utility>
#include <vector>

#include "wearwell/base/monitor.h"
#include "wearwell/embed/answer.h"
#include "wearwell/embed/run.h"
#include "wearwell/input/table.h"

namespace wearwell::embed {

/// What a question is about, as far as its kind asks for it.
struct Subject {
  const Run* run = nullptr;    ///< "next", "inspect", "decide", "damage", "life", "against": a fit
  const Run* other = nullptr;  ///< "against": the fit that it is compared with, if in memory
  const ReadStudy* study = nullptr;  ///< "size"
  /// Instead of `run` the folder of a result; "inspect" and "decide" also a table of lives; "size" a
  /// study file.
  std::string path = {};
  /// By argument: "candidates", "in_service", "lives", "loads", "tests"; several of one argument in
  /// their order.
  std::vector<std::pair<std::string, Table>> tables = {};
};

/// Answers what a command answers. `kind` is "next", "size", "demonstrate", "inspect" or "accelerate"
/// (of `wearwell plan`), "decide", "life" (`wearwell life`), "against" (`wearwell life --against`), or "damage", "design" or
/// "spectrum" (`wearwell fatigue life`, `design` and `rainflow`). `arguments` is a JSON object with the options of the command, hyphens
/// being underscores; values are texts, numbers, truths, or arrays of them; percentages of the
/// fatigue commands are shares, and "results" of "design" are folders by name. Texts of the answer
/// and messages name arguments, not options. Throws InputError, also if an argument is unknown or
/// of a wrong type; Cancelled.
Answer answer(const std::string& kind, const std::string& arguments, const Subject& subject,
              Monitor monitor);

}  // namespace wearwell::embed
