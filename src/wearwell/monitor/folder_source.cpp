#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <set>
#include <vector>

#include "wearwell/base/disk.h"
#include "wearwell/base/printable.h"
#include "wearwell/monitor/line_feed.h"
#include "wearwell/monitor/source.h"

namespace wearwell::monitor {
namespace {

namespace fs = std::filesystem;

/// One file and the position read so far.
struct GrowingFile {
  explicit GrowingFile(const SourceSettings& source)
      : feed(needed_fields(source.mapping), source.format.form == Form::any) {}
  LineFeed feed;
  std::int64_t offset = 0;  ///< of the stored part
  std::int64_t noted = 0;   ///< the part recorded in the store
  bool resumed = false;     ///< the heading must be read
};

class FolderReader {
 public:
  FolderReader(SourceContext& context, std::stop_token stop)
      : context_(context), stop_(std::move(stop)), noted_(context.store.files()) {}

  void look();
  void note();

 private:
  void read_file(const fs::path& path);
  bool read_on(const fs::path& path, const Descriptor& file, GrowingFile& state, std::int64_t size);
  void resume(const Descriptor& file, GrowingFile& state);

  SourceContext& context_;
  std::stop_token stop_;
  std::map<std::string, std::int64_t> noted_;
  std::map<std::string, GrowingFile> files_;
  std::set<std::string> seen_;
};

bool is_lines(const fs::path& path, Form form) {
  static const std::set<std::string> endings = {".csv", ".jsonl", ".ndjson", ".json"};
  static const std::set<std::string> endings_of_influx = {".lp", ".influx", ".txt"};
  const auto& of_form = form == Form::influx ? endings_of_influx : endings;
  return of_form.contains(path.extension().string()) && !path.filename().string().starts_with('.');
}

void FolderReader::look() {
  std::error_code error;
  std::vector<fs::path> paths;
  for (fs::directory_iterator at(context_.settings.folder, error), end; !error && at != end;
       at.increment(error)) {
    if (is_lines(at->path(), context_.settings.format.form)) paths.push_back(at->path());
  }
  if (error)
    context_.notices.tell(
        "source." + context_.settings.name,
        fmt::format("{}: {}", context_.settings.folder.string(), error.message()));
  std::sort(paths.begin(), paths.end());
  seen_.clear();
  for (const fs::path& path : paths) {
    if (stop_.stop_requested()) return;
    read_file(path);
  }
  // A deleted file that reappears is a new file.
  std::erase_if(files_, [&](const auto& each) { return !seen_.contains(each.first); });
}

void FolderReader::read_file(const fs::path& path) {
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat about {};
  if (!file || fstat(file.get(), &about) != 0) {
    context_.notices.tell("source." + context_.settings.name,
                          fmt::format("{}: {}", path.string(), std::strerror(errno)));
    return;
  }
  if (!S_ISREG(about.st_mode)) return;
  // A file that replaces another of the same name is a new file.
  const std::string key = fmt::format("{}/{}#{}", context_.settings.name,
                                      valid_utf8(path.filename().string()), about.st_ino);
  seen_.insert(key);
  auto [at, fresh] = files_.try_emplace(key, context_.settings);
  GrowingFile& state = at->second;
  if (fresh) {
    if (const auto noted = noted_.find(key); noted != noted_.end()) {
      state.offset = state.noted = noted->second;
      state.resumed = state.offset > 0;
    }
  }
  if (about.st_size < state.offset) {
    context_.notices.tell(
        "source." + context_.settings.name,
        fmt::format("{} has become shorter; it is read again from its beginning", path.string()));
    state = GrowingFile(context_.settings);
  }
  while (state.offset < about.st_size && read_on(path, file, state, about.st_size)) {
  }
}

// The heading of CSV stays at its place.
void FolderReader::resume(const Descriptor& file, GrowingFile& state) {
  std::string begin(longest_row, '\0');
  const ssize_t count = pread(file.get(), begin.data(), begin.size(), 0);
  begin.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  state.feed.set_heading(begin);
}

// One piece; returns whether there may be more.
bool FolderReader::read_on(const fs::path& path, const Descriptor& file, GrowingFile& state,
                           std::int64_t size) {
  if (state.resumed && context_.settings.format.form == Form::any) resume(file, state);
  state.resumed = false;
  std::string bytes(LineFeed::piece_size, '\0');
  const ssize_t count = pread(file.get(), bytes.data(), bytes.size(), state.offset);
  if (count <= 0) return false;
  bytes.resize(static_cast<std::size_t>(count));
  LineFeed feed = state.feed;  // restored, should this not be stored
  feed.push(bytes);
  const bool last = context_.once && state.offset + count >= size;
  const auto piece = feed.next(last);
  if (!piece) return false;
  for (const std::string& each : piece->refused)
    context_.intake.refuse(context_.settings, fmt::format("{}: {}", path.string(), each));
  if (!piece->payload.empty()) {
    const Message message{"", piece->payload, piece->form, path.string()};
    if (!deliver_until_stored(context_, std::span(&message, 1), stop_)) return false;
  }
  feed.taken(*piece);
  state.offset += static_cast<std::int64_t>(piece->bytes);
  feed.forget();
  state.feed = std::move(feed);
  return !stop_.stop_requested();
}

void FolderReader::note() {
  for (auto& [key, state] : files_) {
    if (state.noted == state.offset) continue;
    context_.store.note_file(key, state.offset);
    state.noted = state.offset;
  }
}

}  // namespace

void read_folder(SourceContext& context, std::stop_token stop) {
  FolderReader folder(context, stop);
  constexpr auto between = std::chrono::milliseconds(300);
  constexpr int looks_a_note = 10;
  for (int looks = 1;; ++looks) {
    folder.look();
    const bool end = context.once || stop.stop_requested();
    if (end || looks % looks_a_note == 0) {
      try {
        folder.note();
      } catch (const StoreError& error) {
        // Only costs time: readings that are read again are found as repeats.
        context.notices.tell("store", error.what());
      }
    }
    if (end || !pause(between, stop)) break;
  }
}

}  // namespace wearwell::monitor
