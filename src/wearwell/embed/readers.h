#pragma once

#include <functional>
#include <string>
#include <vector>

#include "wearwell/embed/plan_arguments.h"
#include "wearwell/embed/question.h"
#include "wearwell/plan/answer.h"

/// The kinds of questions: each reads its arguments and returns the work that answers it.
namespace wearwell::embed {

using Work = std::function<plan::Answer()>;
/// The subject outlives the work.
using Reader = Work (*)(PlanArguments&, const Subject&, const Monitor&);

/// Null for another kind.
Reader plan_reader(const std::string& kind);
Reader fatigue_reader(const std::string& kind);

/// The tables that an argument holds; null if it holds none.
std::vector<Table> tables_of(const Subject& subject, const std::string& argument);
const Table* table_of(const Subject& subject, const std::string& argument);

}  // namespace wearwell::embed
