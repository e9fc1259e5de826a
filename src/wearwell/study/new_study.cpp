#include "wearwell/study/new_study.h"

#include <fmt/format.h>

#include <fstream>
#include <string_view>

#include "wearwell/base/error.h"

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
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) {
    throw InputError(fmt::format("cannot make the folder {}{}", folder.string(),
                                 error ? ": " + error.message() : ""));
  }
  if (!fs::is_empty(folder, error) || error) {
    throw InputError(
        fmt::format("{} is not empty; a new study needs a folder of its own", folder.string()));
  }
  fs::path study;
  for (const StudyFile& file : files) {
    if (trade != file.trade) continue;
    if (study.empty()) study = folder / file.name;
    std::ofstream stream(folder / file.name, std::ios::binary);
    stream << file.content();
    stream.close();
    if (!stream) throw MachineError(fmt::format("cannot write {}", (folder / file.name).string()));
  }
  return study;
}

}  // namespace wearwell
