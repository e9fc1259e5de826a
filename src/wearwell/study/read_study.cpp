#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/study/model.h"
#include "wearwell/study/scaffold.h"

namespace wearwell {
namespace {

const Model& model_of(const TomlReader& root, Models models) {
  std::vector<std::string> names;
  for (const Model& model : models) {  // a model may have several examples
    if (std::find(names.begin(), names.end(), model.key) == names.end())
      names.emplace_back(model.key);
  }
  for (const TomlReader::Present& each : root.present()) {
    if (each.path == "model" && each.text == "law")
      root.fail("model", "'law' is named 'formula' now", {"law", "formula", true});
  }
  const auto name = root.choice("model", names);
  if (!name) {
    for (const std::string& key : root.keys()) {
      if (near_name(key, {"model"}))
        root.fail(key,
                  fmt::format("unknown key; did you mean 'model'? It is one of {}",
                              fmt::join(names, ", ")),
                  {key, "model", true});
    }
    root.fail("model", fmt::format("is missing: it is one of {}", fmt::join(names, ", ")));
  }
  return *std::find_if(models.begin(), models.end(),
                       [&](const Model& each) { return each.key == *name; });
}

// A study with placeholders for conditions does not run.
void require_stated(const TomlReader& root, const StudyKeys& keys) {
  std::vector<std::string> missing;
  for (const TomlReader::Present& each : root.present()) {
    const bool unit = each.path.starts_with("data.columns.") && each.path.ends_with(".unit");
    if (each.text != not_stated ||
        !(unit || each.path.starts_with("conditions.") || each.path == "failure_modes.runout"))
      continue;
    const auto key = std::find_if(keys.begin(), keys.end(), [&](const StudyKey& known) {
      return matches_key(known.path, each.path);
    });
    missing.push_back(each.path + (key == keys.end() || key->example.empty() || unit
                                       ? ""
                                       : fmt::format(" (like {})", key->example)));
  }
  if (missing.empty()) return;
  throw InputError(fmt::format("{}: {} not stated; write {} in place of \"{}\"", root.file(),
                               fmt::join(missing, ", "), missing.size() > 1 ? "each" : "it",
                               not_stated));
}

}  // namespace

std::unique_ptr<const Study> read_study(const Source& source, Models models) {
  const TomlReader root = TomlReader::parse(source.study);
  const Model& model = model_of(root, models);
  const StudyKeys keys = model.keys ? model.keys() : StudyKeys();
  require_stated(root, keys);
  std::unique_ptr<const Study> study;
  try {
    study = model.read(root, source);
  } catch (const InputError& error) {
    // The reader's first error may be the consequence of a misspelled key.
    const std::string faults = model.keys ? key_faults(root, keys, error.what()) : "";
    if (faults.empty()) throw;
    throw InputError(faults);
  }
  const std::string unused = unused_keys(root, keys);
  if (!unused.empty()) throw InputError(unused);
  return study;
}

}  // namespace wearwell
