#pragma once

#include <filesystem>
#include <string>

namespace wearwell {

/// A folder of results that appears whole or not at all: files are written into a folder beside the
/// target, which takes the target's place at `commit` and is removed when that never comes. So are
/// the folders above the target that had to be made.
class ResultFolder {
 public:
  /// Throws InputError when `target` is something else than an earlier result or an empty folder,
  /// or cannot be written.
  explicit ResultFolder(std::filesystem::path target);
  ~ResultFolder();
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  const std::filesystem::path& path() const { return target_; }

  /// `name` is one of the files that make a result. Throws MachineError when the disk refuses.
  void write(const std::string& name, const std::string& content) const;
  void copy(const std::filesystem::path& file, const std::string& name) const;

  /// Throws MachineError; the earlier result stays then.
  void commit();

 private:
  std::filesystem::path target_, staging_, made_parent_;
};

/// Replaces one file of a result folder, whole or not at all. Throws InputError when the folder
/// cannot be written, MachineError when the disk refuses.
void replace_file(const std::filesystem::path& file, const std::string& content);

}  // namespace wearwell
