#include "wearwell/input/equal_names.h"

#include <fmt/format.h>

#include <boost/algorithm/string/case_conv.hpp>
#include <map>

#include "wearwell/base/error.h"

namespace wearwell {

void refuse_equal_names(const std::vector<std::string>& names, const std::string& source) {
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string& name = names[i];
    if (name.empty()) continue;
    const auto [other, fresh] = seen.emplace(boost::algorithm::to_lower_copy(name), i);
    if (fresh) continue;
    if (names[other->second] == name)
      throw InputError(fmt::format("{} has two columns named '{}': columns {} and {}; rename one",
                                   source, name, other->second + 1, i + 1));
    throw InputError(
        fmt::format("{} has two columns, '{}' (column {}) and '{}' (column {}), whose names differ "
                    "only in case; rename one",
                    source, names[other->second], other->second + 1, name, i + 1));
  }
}

}  // namespace wearwell
