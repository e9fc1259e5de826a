#include "wearwell/in_service/table_headings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/heading.h"
#include "wearwell/input/labelled.h"

namespace wearwell::in_service {

bool has_column(const std::vector<std::string>& headings, const std::string& name,
                const std::string& si) {
  return std::any_of(headings.begin(), headings.end(), [&](const std::string& each) {
    return each == name || (!si.empty() && read_heading(each, si).name == name);
  });
}

fleet::UnitColumn column_by_heading(const std::vector<std::string>& headings,
                                    const std::string& name, const std::string& si,
                                    const std::string& source) {
  const ColumnChoice found = find_labelled(headings, name, si, source, "--columns");
  return {found.column, found.unit};
}

void fail_without_column(const std::string& name, const std::string& hint,
                         const std::vector<std::string>& headings, const std::string& source) {
  std::vector<std::string> shown;
  constexpr std::size_t most_shown = 30;
  for (std::size_t i = 0; i < std::min(headings.size(), most_shown); ++i)
    shown.push_back("'" + printable(shortened(headings[i])) + "'");
  throw InputError(fmt::format("{} has no column '{}'; it has {}. State the column: --columns {}",
                               source, name, fmt::join(shown, ", "), hint));
}

}  // namespace wearwell::in_service
