#include "wearwell/workbench/serve.h"

#include <fmt/format.h>

#include <chrono>
#include <system_error>
#include <thread>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/http/listener.h"
#include "wearwell/http/secret.h"
#include "wearwell/workbench/actions.h"
#include "wearwell/workbench/folder_files.h"
#include "wearwell/workbench/routes.h"

namespace wearwell::workbench {
namespace {

namespace fs = std::filesystem;

// The folder, and the name in it; "" for the folder itself.
std::pair<fs::path, std::string> folder_and_name(const fs::path& target) {
  if (target.empty()) return {fs::current_path(), ""};
  std::error_code error;
  if (!fs::exists(target, error))
    throw InputError(fmt::format("{} does not exist", printable(target.string())));
  const fs::path real = fs::canonical(target);
  if (fs::is_directory(real, error) && kind_of(real).empty()) return {real, ""};
  return {real.parent_path(), real.filename().string()};
}

bool is_fitting(Session& session) {
  const std::lock_guard lock(session.mutex);
  return session.fit.state == FitState::running;
}

HttpSettings settings_of(const Opening& opening) {
  HttpSettings settings;
  settings.port = opening.port;
  settings.limits.body_bytes = std::size_t{512} << 20;  // a table is chosen whole
  settings.limits.body = std::chrono::minutes(5);
  settings.limits.large_bodies = 2;
  settings.limits.between = std::chrono::milliseconds(150);
  return settings;
}

}  // namespace

void serve(const Opening& opening, Models models,
           const std::function<void(const std::string&)>& ready) {
  const auto [folder, name] = folder_and_name(opening.target);
  Session session(folder, models);
  if (!name.empty()) {
    // A table that cannot be read is refused on the command line, a large one is shown while it is read.
    const auto patience = std::exchange(session.patience, std::chrono::seconds(2));
    static_cast<void>(open_file(session, {{"file", name}}));
    session.patience = patience;
  }
  const std::string token = random_token();
  Routes routes(session, token);
  HttpListener listener(settings_of(opening), {}, routes);
  routes.set_port(listener.port());
  ready(fmt::format("{}#{}", listener.address(), token));
  // A run goes on to its end, whether its page is open or not.
  while (!routes.was_used() || routes.idle_seconds() < opening.idle_end || is_fitting(session))
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
}

}  // namespace wearwell::workbench
