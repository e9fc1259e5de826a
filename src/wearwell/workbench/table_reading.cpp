#include "wearwell/workbench/table_reading.h"

#include <algorithm>
#include <exception>
#include <fstream>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/monitor.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/stoppable.h"
#include "wearwell/input/workbook.h"
#include "wearwell/workbench/folder_files.h"
#include "wearwell/workbench/table_view.h"

namespace wearwell::workbench {
namespace {

using nlohmann::ordered_json;
using Settings = std::map<std::string, std::string>;

// Of a file of text, so that something is seen while it is read. Nothing is interpreted.
std::vector<std::string> first_lines(const std::filesystem::path& file) {
  constexpr std::size_t lines = 20, longest = 200, most = 64 << 10;
  std::ifstream stream(file, std::ios::binary);
  std::string begin(most, '\0');
  stream.read(begin.data(), static_cast<std::streamsize>(most));
  begin.resize(static_cast<std::size_t>(stream.gcount()));
  if (begin.find('\0') != begin.npos || file.extension() == ".gz") return {};
  std::vector<std::string> found;
  for (std::size_t at = 0; at < begin.size() && found.size() < lines;) {
    const std::size_t end = std::min(begin.find('\n', at), begin.size());
    std::string line = begin.substr(at, end - at);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    found.push_back(printable(shortened(valid_utf8(line), longest), "\t"));
    at = end + 1;
  }
  return found;
}

ordered_json sheets_json(const std::string& file, const std::vector<std::string>& sheets) {
  return {{"kind", "sheets"}, {"file", file}, {"sheets", sheets}};
}

// Does `change` if no later reading has begun.
void end_reading(Session& session, std::uint64_t number, ReadState state,
                 const std::function<void()>& change = {}) {
  const std::lock_guard lock(session.mutex);
  if (session.read.number == number) {
    session.read.state = state;
    if (change) change();
    ++session.version;
  }
  session.read_ended.notify_all();
}

void read_in_thread(Session& session, const std::string& file, const Settings& settings,
                    std::uint64_t number, const std::function<void()>& refused,
                    const std::stop_token& stop) {
  try {
    std::shared_ptr<OpenTable> open;
    stoppable(stop, [&] {
      const std::string stamp = stamp_of(path_in(session.folder, file));
      open = std::make_shared<OpenTable>(open_table(session.folder, file, settings));
      open->stamp = stamp;
      open->number = number;
      open->shown = table_json(*open);
      open->shown["first_lines"] = first_lines(path_in(session.folder, file));
    });
    end_reading(session, number, ReadState::done, [&] {
      session.table = open;
      session.workbook.clear();
    });
  } catch (const SeveralSheets& several) {
    end_reading(session, number, ReadState::sheets, [&] {
      session.workbook = file;
      for (const std::string& each : several.names) session.read.sheets.push_back(printable(each));
    });
  } catch (const Cancelled&) {
    end_reading(session, number, ReadState::stopped);
  } catch (const std::exception& error) {
    if (refused) refused();
    end_reading(session, number, ReadState::failed,
                [&] { session.read.problem = printable_lines(error.what()); });
  }
}

// Begins the thread. It first waits for the end of the reading before it, which is asked to stop.
std::uint64_t begin_reading(Session& session, const std::string& file, const Settings& settings,
                            std::function<void()> refused) {
  session.reading.request_stop();
  const std::uint64_t number = ++session.readings;
  session.read = {ReadState::running, file, number, std::chrono::steady_clock::now()};
  ++session.version;
  session.reading =
      std::jthread([&session, file, settings, number, refused = std::move(refused),
                    before = std::move(session.reading)](const std::stop_token& stop) mutable {
        if (before.joinable()) before.join();
        read_in_thread(session, file, settings, number, refused, stop);
      });
  return number;
}

}  // namespace

ordered_json start_reading(Session& session, const std::string& file, const Settings& settings,
                           std::function<void()> refused) {
  std::unique_lock lock(session.mutex);
  const std::uint64_t number = begin_reading(session, file, settings, std::move(refused));
  session.read_ended.wait_for(lock, session.patience, [&] {
    return session.read.number != number || session.read.state != ReadState::running;
  });
  const ReadState state = session.read.number == number ? session.read.state : ReadState::running;
  if (state == ReadState::failed) throw InputError(session.read.problem);
  if (state == ReadState::sheets) return sheets_json(file, session.read.sheets);
  if (state == ReadState::done) return {{"kind", "table"}, {"table", shown_table(*session.table)}};
  lock.unlock();
  return {{"kind", "reading"},
          {"file", file},
          {"number", number},
          {"lines", first_lines(path_in(session.folder, file))}};
}

void stop_reading(Session& session) {
  const std::lock_guard lock(session.mutex);
  session.reading.request_stop();
}

ordered_json reading_json(const ReadProgress& read) {
  static constexpr const char* names[] = {"none", "running", "done", "sheets", "failed", "stopped"};
  const std::chrono::duration<double> since = std::chrono::steady_clock::now() - read.begin;
  return {{"state", names[static_cast<int>(read.state)]},
          {"file", read.file},
          {"number", read.number},
          {"seconds", read.state == ReadState::running ? since.count() : 0.0},
          {"sheets", read.sheets},
          {"problem", read.problem}};
}

}  // namespace wearwell::workbench
