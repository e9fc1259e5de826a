#include "wearwell/embed/question.h"

#include <fmt/format.h>

#include <map>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/embed/fork_guard.h"
#include "wearwell/embed/readers.h"

namespace wearwell::embed {
namespace {

Reader reader_of(const std::string& kind) {
  if (const Reader reader = plan_reader(kind)) return reader;
  if (const Reader reader = fatigue_reader(kind)) return reader;
  throw InputError(
      fmt::format("there is no question of kind '{}'; it is next, size, demonstrate, inspect, "
                  "accelerate, decide, life, against, damage, design or spectrum",
                  printable(kind)));
}

std::string heading_of(const std::string& kind) {
  static const std::map<std::string, std::string> headings = {
      {"decide", "Decisions"},
      {"life", "Life"},
      {"against", "Comparison of lives"},
      {"damage", "Life under a load history"},
      {"design", "Design curves"},
      {"spectrum", "Load history"}};
  const auto found = headings.find(kind);
  return found == headings.end() ? "Plan" : found->second;
}

}  // namespace

std::vector<Table> tables_of(const Subject& subject, const std::string& argument) {
  std::vector<Table> found;
  for (const auto& [name, table] : subject.tables)
    if (name == argument) found.push_back(table);
  return found;
}

const Table* table_of(const Subject& subject, const std::string& argument) {
  for (const auto& [name, table] : subject.tables)
    if (name == argument) return &table;
  return nullptr;
}

Answer answer(const std::string& kind, const std::string& arguments, const Subject& subject,
              Monitor monitor) {
  const ForkGuard guard;
  monitor.threads = guard.most(monitor.threads);
  const auto json = nlohmann::ordered_json::parse(arguments, nullptr, false);
  if (json.is_discarded()) throw InputError(kind + ": an argument is not Unicode");
  PlanArguments reading(kind, json);
  const Work work = reader_of(kind)(reading, subject, monitor);
  reading.finish();
  try {
    return shown(work(), heading_of(kind), reading);
  } catch (const InputError& error) {
    throw InputError(reading.in_arguments(error.what()));
  }
}

}  // namespace wearwell::embed
