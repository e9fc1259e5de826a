#include "wearwell/input/toml_edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "wearwell/base/error.h"
#include "wearwell/input/guarded_toml.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell {
namespace {

// The offset of a toml++ position in the text; columns count characters.
std::size_t offset(const std::string& text, const toml::source_position& at) {
  std::size_t i = 0;
  for (toml::source_index line = 1; line < at.line && i < text.size(); ++line)
    i = std::min(text.find('\n', i), text.size() - 1) + 1;
  const auto continues = [&](std::size_t k) {
    return k < text.size() && (static_cast<unsigned char>(text[k]) & 0xc0) == 0x80;
  };
  for (toml::source_index column = 1; column < at.column && i < text.size(); ++column) {
    ++i;
    while (continues(i)) ++i;
  }
  return i;
}

}  // namespace

TextFile with_predict(const TextFile& study,
                      const std::vector<std::pair<std::string, std::string>>& keys) {
  std::string lines;
  for (const auto& [key, value] : keys) lines += fmt::format("{} = {}\n", key, value);
  TextFile changed = study;
  static_cast<void>(TomlReader::parse(study));  // reports invalid TOML
  const toml::table root = toml::parse(study.text);
  if (!root.contains("predict")) {
    changed.text += "\n[predict]\n" + lines;
    return changed;
  }
  const toml::table* const predict = root["predict"].as_table();
  const std::size_t heading = predict ? offset(study.text, predict->source().begin) : 0;
  if (!predict || predict->is_inline() || study.text.compare(heading, 1, "[") != 0)
    throw InputError(
        fmt::format("{}: 'predict' must be a separate table, [predict]", study.path.string()));
  std::vector<std::pair<std::size_t, std::size_t>> gone;
  for (const auto& [key, value] : *predict) {
    if (std::any_of(keys.begin(), keys.end(),
                    [name = key.str()](const auto& each) { return each.first == name; }))
      gone.emplace_back(offset(study.text, key.source().begin),
                        offset(study.text, value.source().end));
  }
  std::sort(gone.begin(), gone.end(), std::greater<>());
  for (const auto& [from, to] : gone) changed.text.erase(from, to - from);
  const std::size_t end = std::min(changed.text.find('\n', heading), changed.text.size());
  changed.text.insert(end, "\n" + lines.substr(0, lines.size() - 1));
  return changed;
}

}  // namespace wearwell
