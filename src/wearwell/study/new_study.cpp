#include "wearwell/study/new_study.h"

#include <fmt/format.h>

#include <iterator>
#include <string_view>

#include "wearwell/base/error.h"
#include "wearwell/base/staged_folder.h"

namespace wearwell {
namespace resource {

// Files of examples/ that the program carries with it (cmake/resources.cmake).
std::string_view joint_study();
std::string_view joint_data();
std::string_view bearing_study();
std::string_view bearing_data();
std::string_view clutch_study();
std::string_view clutch_design();
std::string_view clutch_truth();
std::string_view fatigue_study();
std::string_view fatigue_data();

}  // namespace resource

namespace {

namespace fs = std::filesystem;

struct StudyFile {
  const char* trade;
  const char* name;
  std::string_view (*content)();
};

// The study comes first.
constexpr StudyFile files[] = {{"joint", "study.toml", resource::joint_study},
                               {"joint", "joint_wear.csv", resource::joint_data},
                               {"bearing", "study.toml", resource::bearing_study},
                               {"bearing", "inspections.csv", resource::bearing_data},
                               {"clutch", "study.toml", resource::clutch_study},
                               {"clutch", "design.csv", resource::clutch_design},
                               {"clutch", "truth.toml", resource::clutch_truth},
                               {"fatigue", "study.toml", resource::fatigue_study},
                               {"fatigue", "tests.csv", resource::fatigue_data}};

}  // namespace

std::vector<std::string> new_study_trades() {
  return {"joint", "bearing", "clutch", "fatigue"};
}

fs::path write_new_study(const std::string& trade, const fs::path& folder) {
  heal_folder(behind_links(folder));
  std::error_code error;
  if (fs::exists(folder, error) &&
      !(fs::is_directory(folder, error) && fs::is_empty(folder, error)))
    throw InputError(
        fmt::format("{} is not empty; a new study needs a folder of its own", folder.string()));
  StagedFolder staged(folder);
  fs::path study;
  // The study last: without its data it says nothing.
  for (auto file = std::rbegin(files); file != std::rend(files); ++file) {
    if (trade != file->trade) continue;
    staged.write(file->name, file->content());
    study = folder / file->name;
  }
  staged.commit({});
  return study;
}

}  // namespace wearwell
