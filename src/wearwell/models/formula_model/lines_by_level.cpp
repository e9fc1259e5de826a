#include "wearwell/models/formula_model/lines_by_level.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

namespace wearwell::formula_model {

std::string of_level(const std::string& text, const std::string& name, const std::string& level) {
  const char mark = level.find('\'') == level.npos ? '\'' : '"';
  const std::regex place(R"(\[\s*)" + name + R"(\s*\])");
  std::string escaped;
  for (const char c : level) escaped += c == '$' ? std::string("$$") : std::string(1, c);
  return std::regex_replace(text, place, fmt::format("[{}{}{}]", mark, escaped, mark));
}

LinesByLevel::LinesByLevel(const TomlReader& root, std::string name,
                           std::vector<std::string> levels, const std::vector<formula::Line>& lines)
    : name_(std::move(name)), levels_(std::move(levels)), lines_(lines) {
  const std::regex place(R"(\[\s*)" + name_ + R"(\s*\])");
  for (bool more = true; more;) {
    more = false;
    for (const formula::Line& line : lines) {
      if (std::find(dependent_.begin(), dependent_.end(), line.name) != dependent_.end()) continue;
      const bool uses = std::any_of(dependent_.begin(), dependent_.end(), [&](const auto& each) {
        return std::regex_search(line.text, std::regex("\\b" + each + "\\b"));
      });
      if (!uses && !std::regex_search(line.text, place)) continue;
      if (line.name.find('(') != line.name.npos)
        root.required_table("formula").fail(
            line.name, fmt::format("depends on [{}]; only a plain intermediate value can", name_));
      dependent_.push_back(line.name);
      more = true;
    }
  }
  for (std::size_t k = 0; k < levels_.size(); ++k) {
    for (const formula::Line& line : lines) {
      if (std::find(dependent_.begin(), dependent_.end(), line.name) == dependent_.end()) continue;
      lines_.push_back({fmt::format("{}__{}", line.name, k + 1), text(line.text, k)});
    }
  }
}

std::string LinesByLevel::text(const std::string& written, std::size_t k) const {
  std::string text = written;
  for (const std::string& name : dependent_) {
    text = std::regex_replace(text, std::regex("\\b" + name + "\\b"),
                              fmt::format("{}__{}", name, k + 1));
  }
  return of_level(text, name_, levels_[k]);
}

}  // namespace wearwell::formula_model
