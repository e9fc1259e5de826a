#include "wearwell/models/formula_model/fail_at_place.h"

#include <sstream>

namespace wearwell {

void fail_at_place(const TomlReader& root, const TomlReader& table, const std::string& message) {
  const std::size_t bracket = message.find("] "), colon = message.find(": ");
  if (!message.starts_with('[') || bracket > colon || colon == std::string::npos)
    table.fail("", message);
  const std::string path = message.substr(1, bracket - 1), why = message.substr(colon + 2);
  const std::size_t dot = path.find('.');
  const std::string first = path.substr(0, dot);
  const std::string inner = dot == std::string::npos ? "" : path.substr(dot + 1);
  if (!root.has(first)) table.fail("", message);
  const TomlReader outer = root.required_table(first);
  if (!inner.empty() && !outer.has(inner)) table.fail("", message);
  const TomlReader at = inner.empty() ? outer : outer.required_table(inner);
  std::istringstream words(message.substr(bracket + 2, colon - bracket - 2));
  std::string key, of_key;
  words >> key;
  if (words >> of_key && at.has(key)) at.required_table(key).fail(of_key, why);
  at.fail(key, why);
}

}  // namespace wearwell
