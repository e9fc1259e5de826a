#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/study/model.h"

namespace wearwell {

std::unique_ptr<const Study> read_study(const Source& source, Models models) {
  const TomlReader root = TomlReader::parse(source.study);
  std::vector<std::string> keys;
  for (const Model& model : models) {  // one may have several examples
    if (std::find(keys.begin(), keys.end(), model.key) == keys.end()) keys.emplace_back(model.key);
  }
  const auto key = root.choice("model", keys);
  if (!key) root.fail("model", fmt::format("is missing: it is one of {}", fmt::join(keys, ", ")));
  const auto model = std::find_if(models.begin(), models.end(),
                                  [&](const Model& each) { return each.key == *key; });
  std::unique_ptr<const Study> study = model->read(root, source);
  root.finish();
  return study;
}

}  // namespace wearwell
