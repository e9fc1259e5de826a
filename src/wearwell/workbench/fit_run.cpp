#include "wearwell/workbench/fit_run.h"

#include <fmt/format.h>

#include <exception>
#include <functional>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/monitor.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/stoppable.h"
#include "wearwell/present/result_folder.h"
#include "wearwell/prognosis/carried_run.h"
#include "wearwell/study/result_writer.h"
#include "wearwell/workbench/folder_files.h"

namespace wearwell::workbench {
namespace {

void change(Session& session, const std::function<void(FitProgress&)>& with) {
  const std::lock_guard lock(session.mutex);
  with(session.fit);
  ++session.version;
}

void fit_study(Session& session, const Source& source, const std::string& result,
               const std::stop_token& stop) {
  const auto read = read_study(source, session.models);
  std::optional<Source> carried = prognosis::source_to_carry(source, *read);
  ResultFolder folder(path_in(session.folder, result));
  const Monitor monitor{.progress =
                            [&](const Step& step) {
                              change(session, [&](FitProgress& fit) {
                                fit.what = std::string(step.what);
                                fit.done = step.done;
                                fit.total = step.total;
                                fit.seconds = step.seconds;
                              });
                            },
                        .stop = stop};
  const Result found = prognosis::carried_run(std::move(carried), *read, {}, monitor);
  write_result(found, source.study.text, folder);
}

void run_fit_thread(Session& session, const Source& source, const std::string& result,
                    const std::stop_token& stop) {
  FitState state = FitState::done;
  std::string problem;
  try {
    stoppable(stop, [&] { fit_study(session, source, result, stop); });
  } catch (const Cancelled&) {
    state = FitState::stopped;
  } catch (const std::exception& error) {
    state = FitState::failed;
    problem = printable_lines(error.what());
  }
  const std::lock_guard lock(session.mutex);
  session.fit.state = state;
  session.fit.problem = problem;
  if (state == FitState::done) {
    session.result = result;
    session.fit.written = session.fit.run;
  }
  ++session.version;
}

}  // namespace

void start_fit(Session& session, const std::string& study,
               const std::function<void(const std::string&)>& accept) {
  const std::filesystem::path file = path_in(session.folder, study);
  if (kind_of(file) != "study")
    throw InputError(fmt::format("{} is not a study in this folder", printable(study)));
  const std::string result = file.stem().string() + "-results";
  static_cast<void>(path_in(session.folder, result));
  const Source source = source_of(file);
  accept(source.study.text);
  std::jthread before;  // has ended; joined after the lock is released
  const std::lock_guard lock(session.mutex);
  if (session.fit.state == FitState::running)
    throw InputError(
        fmt::format("{} is being fitted: wait, or stop it", printable(session.fit.study)));
  before = std::move(session.fitting);
  session.fit = {FitState::running, study, result, session.fit.run + 1, session.fit.written};
  session.study = study;
  ++session.version;
  session.fitting = std::jthread([&session, source, result](const std::stop_token& stop) {
    run_fit_thread(session, source, result, stop);
  });
}

void stop_fit(Session& session) {
  const std::lock_guard lock(session.mutex);
  session.fitting.request_stop();
}

nlohmann::ordered_json progress_json(const FitProgress& fit) {
  static constexpr const char* names[] = {"none", "running", "done", "failed", "stopped"};
  return {{"state", names[static_cast<int>(fit.state)]},
          {"study", fit.study},
          {"result", fit.result},
          {"run", fit.run},
          {"written", fit.written},
          {"what", fit.what},
          {"done", fit.done},
          {"total", fit.total},
          {"seconds", fit.seconds},
          {"problem", fit.problem}};
}

}  // namespace wearwell::workbench
