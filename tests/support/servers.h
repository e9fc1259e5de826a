#pragma once

#include <pwd.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "support/free_port.h"
#include "support/run_command.h"

namespace wearwell {

inline bool is_listening(int port) {
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = loopback(port);
  const bool there = connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  close(fd);
  return there;
}

/// Whether it came true within so many seconds.
inline bool eventually(const std::function<bool()>& true_now, double seconds = 60) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!true_now()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

/// A program of our own, ended by its process id with this object at the latest.
class ChildProcess {
 public:
  ChildProcess() = default;
  /// Standard output and error go to `log`; standard input is `input`, closed where that is -1.
  ChildProcess(const std::vector<std::string>& command, const std::filesystem::path& log,
               int input = -1) {
    pid_ = fork();
    if (pid_ < 0) throw std::runtime_error("fork");
    if (pid_ > 0) return;
    if (FILE* out = std::fopen(log.c_str(), "a")) {
      dup2(fileno(out), 1);
      dup2(fileno(out), 2);
    }
    if (input >= 0) {
      dup2(input, 0);
    } else {
      close(0);
    }
    for (int fd = 3; fd < 1000; ++fd) close(fd);
    std::vector<char*> arguments;
    for (const std::string& each : command) arguments.push_back(const_cast<char*>(each.c_str()));
    arguments.push_back(nullptr);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  ~ChildProcess() { end(SIGKILL); }
  ChildProcess(ChildProcess&& other) noexcept : pid_(std::exchange(other.pid_, -1)) {}
  ChildProcess& operator=(ChildProcess&& other) noexcept {
    end(SIGKILL);
    pid_ = std::exchange(other.pid_, -1);
    return *this;
  }

  bool runs() {
    if (pid_ <= 0) return false;
    if (waitpid(pid_, &status_, WNOHANG) != pid_) return true;
    pid_ = -1;
    return false;
  }
  /// Sends a signal and waits for its end; its exit code, or 128 and the signal that ended it. After two minutes it is
  /// killed, so that a program that does not end is a failure and not a test without an end.
  int end(int signal) {
    constexpr auto longest = std::chrono::minutes(2);
    if (pid_ <= 0) return code();
    kill(pid_, signal);
    const auto begin = std::chrono::steady_clock::now();
    while (runs()) {
      if (std::chrono::steady_clock::now() - begin > longest) kill(pid_, SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return code();
  }
  int wait() {
    if (pid_ > 0) waitpid(std::exchange(pid_, -1), &status_, 0);
    return code();
  }
  pid_t pid() const { return pid_; }

 private:
  int code() const { return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_); }
  pid_t pid_ = -1;
  int status_ = 0;
};

/// The mosquitto of Debian on a port of its own, its messages kept in a folder of its own.
class Broker {
 public:
  static bool installed() { return std::filesystem::exists("/usr/sbin/mosquitto"); }

  /// `certificate`: a folder with authority.pem, server.pem and server.key, for TLS.
  explicit Broker(const std::filesystem::path& folder,
                  const std::filesystem::path& certificate = {})
      : folder_(folder), port_(free_port()), tls_(!certificate.empty()) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "mosquitto.conf")
        << "listener " << port_ << " 127.0.0.1\nallow_anonymous true\npersistence true\n"
        << "persistence_location " << folder_.string() << "/\nautosave_on_changes true\n"
        << "autosave_interval 1\nmax_queued_messages 0\nmax_inflight_messages 0\n"
        << (geteuid() == 0 ? "user root\n" : "");
    if (tls_)
      std::ofstream(folder_ / "mosquitto.conf", std::ios::app)
          << "certfile " << (certificate / "server.pem").string() << "\nkeyfile "
          << (certificate / "server.key").string() << "\n";
    start();
  }
  void start() {
    process_ = ChildProcess({"/usr/sbin/mosquitto", "-c", (folder_ / "mosquitto.conf").string()},
                            folder_ / "log");
    if (!eventually([&] { return is_listening(port_); }))
      throw std::runtime_error("mosquitto does not start");
  }
  void kill() { process_.end(SIGKILL); }
  /// As a service is stopped: with what it holds on the disk.
  void stop() { process_.end(SIGTERM); }
  int port() const { return port_; }
  std::string url() const {
    return (tls_ ? "mqtts://127.0.0.1:" : "mqtt://127.0.0.1:") + std::to_string(port_);
  }

 private:
  std::filesystem::path folder_;
  int port_;
  bool tls_;
  ChildProcess process_;
};

/// A server of PostgreSQL on a port of its own, with a new cluster in a folder of its own. As root it runs as `postgres`, since it
/// refuses root.
class PostgresServer {
 public:
  /// What is missing; empty where nothing is.
  static std::string missing() {
    if (programs().empty()) return "no server of PostgreSQL is installed";
    if (geteuid() == 0 && !getpwnam("postgres")) return "there is no user postgres to run it as";
    return "";
  }

  explicit PostgresServer(const std::filesystem::path& folder)
      : folder_(folder), port_(free_port()) {
    std::filesystem::create_directories(folder_);
    if (geteuid() == 0) run_or_throw("chown postgres '" + folder_.string() + "'");
    // Who is not root must come to it.
    for (auto at = folder_.parent_path(); geteuid() == 0 && at != at.root_path() && at != "/tmp";
         at = at.parent_path())
      run_or_throw("chmod a+x '" + at.string() + "'");
    run_or_throw("cd / && " + as_user() + programs() + "/initdb -D '" + data() +
                 "' -A trust -U wearwell --no-sync -E UTF8 --locale=C");
    start();
  }
  ~PostgresServer() { process_.end(SIGQUIT); }
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  void start() {
    process_ = ChildProcess(
        {"sh", "-c",
         "cd / && exec " + as_user() + programs() + "/postgres -D '" + data() + "' -p " +
             std::to_string(port_) + " -h 127.0.0.1 -k '' -c shared_buffers=32MB </dev/null"},
        folder_ / "log");
    if (!eventually([&] { return sql("select 1").exit_code == 0; }))
      throw std::runtime_error("postgres does not start");
  }
  /// All of it at once, as when the machine loses its power. Its children see their parent go and end.
  void kill() {
    process_.end(SIGKILL);
    std::filesystem::remove(data() + "/postmaster.pid");
  }
  int port() const { return port_; }
  std::string url() const {
    return "postgresql://wearwell@127.0.0.1:" + std::to_string(port_) + "/postgres";
  }
  CommandResult sql(const std::string& statements) const {
    const std::filesystem::path file = folder_ / "statements.sql";
    std::ofstream(file, std::ios::binary) << statements;
    return run_command("psql -X -q -A -t -v ON_ERROR_STOP=1 '" + url() + "' -f '" + file.string() +
                       "'");
  }

 private:
  static std::string programs() {
    for (int version = 20; version >= 12; --version) {
      const std::string folder = "/usr/lib/postgresql/" + std::to_string(version) + "/bin";
      if (std::filesystem::exists(folder + "/postgres")) return folder;
    }
    return "";
  }
  std::string data() const { return (folder_ / "data").string(); }
  static std::string as_user() {
    return geteuid() == 0 ? "setpriv --reuid=postgres --regid=postgres --clear-groups " : "";
  }
  static void run_or_throw(const std::string& line) {
    const CommandResult result = run_command(line);
    if (result.exit_code != 0) throw std::runtime_error(line + ": " + result.err);
  }

  std::filesystem::path folder_;
  int port_;
  ChildProcess process_;
};

}  // namespace wearwell
