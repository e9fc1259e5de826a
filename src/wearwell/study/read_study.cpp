#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/study/model.h"

namespace wearwell {
namespace {

const Model& model_of(const TomlReader& root, Models models) {
  std::vector<std::string> names;
  for (const Model& model : models) {  // one may have several examples
    if (std::find(names.begin(), names.end(), model.key) == names.end())
      names.emplace_back(model.key);
  }
  const auto name = root.choice("model", names);
  if (!name) {
    for (const std::string& key : root.keys()) {
      if (near_name(key, {"model"}))
        root.fail(key, fmt::format("unknown key; did you mean 'model'? It is one of {}",
                                   fmt::join(names, ", ")));
    }
    root.fail("model", fmt::format("is missing: it is one of {}", fmt::join(names, ", ")));
  }
  return *std::find_if(models.begin(), models.end(),
                       [&](const Model& each) { return each.key == *name; });
}

}  // namespace

std::unique_ptr<const Study> read_study(const Source& source, Models models) {
  const TomlReader root = TomlReader::parse(source.study);
  const Model& model = model_of(root, models);
  const StudyKeys keys = model.keys ? model.keys() : StudyKeys();
  std::unique_ptr<const Study> study;
  try {
    study = model.read(root, source);
  } catch (const InputError& error) {
    // What a reader stumbles over first may follow from a key that is misspelt.
    const std::string faults = model.keys ? key_faults(root, keys, error.what()) : "";
    if (faults.empty()) throw;
    throw InputError(faults);
  }
  const std::string unused = unused_keys(root, keys);
  if (!unused.empty()) throw InputError(unused);
  return study;
}

}  // namespace wearwell
