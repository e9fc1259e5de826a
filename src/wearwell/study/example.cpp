#include "wearwell/study/example.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "wearwell/base/error.h"
#include "wearwell/base/staged_folder.h"

namespace wearwell {
namespace fs = std::filesystem;

namespace {

void require_new(const fs::path& folder) {
  recover_folder(behind_links(folder));
  std::error_code error;
  if (fs::exists(folder, error) &&
      !(fs::is_directory(folder, error) && fs::is_empty(folder, error)))
    throw InputError(
        fmt::format("{} is not empty; choose an empty or new folder", folder.string()));
}

}  // namespace

fs::path write_example(const Model& model, const fs::path& folder) {
  require_new(folder);
  StagedFolder staged(folder);
  // The study is written last, because it needs its data.
  for (std::size_t i = model.example.size(); i-- > 0;)
    staged.write(model.example[i].name, model.example[i].content());
  staged.commit({});
  return folder / model.example.front().name;
}

fs::path write_scaffold(const Scaffold& study, const fs::path& data, const fs::path& folder) {
  require_new(folder);
  StagedFolder staged(folder);
  std::ifstream stream(data, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream.good() && !stream.eof())
    throw InputError(fmt::format("{} cannot be read completely", data.string()));
  staged.write(data.filename().string(), bytes);
  staged.write("study.toml", study.text);
  staged.commit({});
  return folder / "study.toml";
}

fs::path write_new(const std::string& name, const std::string& text, const fs::path& folder) {
  require_new(folder);
  StagedFolder staged(folder);
  staged.write(name, text);
  staged.commit({});
  return folder / name;
}

}  // namespace wearwell
