#pragma once

#include <fmt/format.h>
#include <pwd.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>

#include "support/free_port.h"
#include "support/run_command.h"

namespace wearwell {

/// A server of PostgreSQL in a folder of its own on the loopback, ended by its own process id. As root it
/// runs as `postgres`, since it refuses root.
class PostgresServer {
 public:
  static std::string programs() {
    for (int version = 20; version >= 12; --version) {
      const std::string folder = fmt::format("/usr/lib/postgresql/{}/bin", version);
      if (std::filesystem::exists(folder + "/postgres")) return folder;
    }
    return "";
  }
  /// What is missing; empty where nothing is.
  static std::string missing() {
    if (programs().empty()) return "no server of PostgreSQL is installed";
    if (geteuid() == 0 && !getpwnam("postgres")) return "there is no user postgres to run it as";
    return "";
  }

  explicit PostgresServer(const std::filesystem::path& parent)
      : folder_(parent / fmt::format("postgres-{}", counter()++)), port_(free_port()) {
    std::filesystem::create_directories(folder_);
    if (geteuid() == 0) {
      chmod(parent.c_str(), 0755);
      const passwd* user = getpwnam("postgres");
      if (chown(folder_.c_str(), user->pw_uid, user->pw_gid) != 0)
        throw std::runtime_error("chown");
    }
    const CommandResult made = run_command(fmt::format(
        "cd /; {}{}/initdb -D '{}/data' -A trust -U wearwell -E UTF8 --locale=C --no-sync",
        as_user(), programs(), folder_.string()));
    if (made.exit_code != 0) throw std::runtime_error("initdb: " + made.err);
    start();
  }
  ~PostgresServer() {
    stop();
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  int port() const { return port_; }
  std::string address() const {
    return fmt::format("postgresql://wearwell@127.0.0.1:{}/postgres", port_);
  }

  CommandResult sql(const std::string& statements) const {
    const std::filesystem::path file = folder_ / "statements.sql";
    std::ofstream(file, std::ios::binary) << statements;
    return run_command(
        fmt::format("psql -X -q -A -t -v ON_ERROR_STOP=1 '{}' -f '{}'", address(), file.string()));
  }

  /// As a machine dies: at once.
  void stop() {
    if (process_ <= 0) return;
    kill(process_, SIGQUIT);
    waitpid(process_, nullptr, 0);
    process_ = 0;
  }

 private:
  static int& counter() {
    static int count = 0;
    return count;
  }
  static std::string as_user() {
    return geteuid() == 0 ? "setpriv --reuid=postgres --regid=postgres --clear-groups " : "";
  }

  void start() {
    process_ = fork();
    if (process_ == 0) {
      const std::string line = fmt::format(
          "cd / && exec {}{}/postgres -D '{}/data' -p {} -h 127.0.0.1 -k '{}' -c fsync=off -c "
          "shared_buffers=32MB -c max_connections=20 >'{}/log' 2>&1",
          as_user(), programs(), folder_.string(), port_, folder_.string(), folder_.string());
      execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
      _exit(127);
    }
    for (int i = 0; i < 300; ++i) {
      if (sql("select 1").exit_code == 0) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    throw std::runtime_error("the server does not answer");
  }

  std::filesystem::path folder_;
  int port_;
  pid_t process_ = 0;
};

}  // namespace wearwell
