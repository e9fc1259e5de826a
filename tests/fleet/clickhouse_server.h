#pragma once

#include <fmt/format.h>
#include <pwd.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>

#include "fleet/postgres_server.h"
#include "support/run_command.h"

namespace wearwell {

/// A server of ClickHouse in a folder of its own on the loopback, ended by its own process id.
class ClickhouseServer {
 public:
  static std::string missing() {
    if (run_command("PATH=$PATH:/usr/sbin command -v clickhouse-server").exit_code != 0 ||
        run_command("command -v clickhouse-client").exit_code != 0)
      return "no server of ClickHouse is installed";
    return "";
  }

  explicit ClickhouseServer(const std::filesystem::path& parent)
      : folder_(parent / "clickhouse"), port_(free_port()) {
    const std::string here = folder_.string();
    std::filesystem::create_directories(folder_ / "data");
    std::ofstream(folder_ / "config.xml") << fmt::format(
        "<yandex><logger><level>warning</level><log>{0}/log</log><errorlog>{0}/errors</errorlog>"
        "</logger><tcp_port>{1}</tcp_port><listen_host>127.0.0.1</listen_host><path>{0}/data/</"
        "path>"
        "<tmp_path>{0}/tmp/</tmp_path><users_config>{0}/users.xml</users_config><default_profile>"
        "default</default_profile><default_database>default</default_database><mark_cache_size>"
        "67108864</mark_cache_size></yandex>",
        here, port_);
    std::ofstream(folder_ / "users.xml")
        << "<yandex><profiles><default><max_memory_usage>2000000000</max_memory_usage></default>"
           "</profiles><users><default><password></password><networks><ip>127.0.0.1</ip></networks>"
           "<profile>default</profile><quota>default</quota></default></users><quotas><default>"
           "</default></quotas></yandex>";
    // It refuses data of another user than its own.
    process_ = fork();
    if (process_ == 0) {
      const std::string line = fmt::format(
          "cd '{0}' && PATH=$PATH:/usr/sbin exec clickhouse-server --config-file='{0}/config.xml' "
          ">'{0}/out' 2>&1",
          here);
      execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
      _exit(127);
    }
    for (int i = 0; i < 300; ++i) {
      if (sql("select 1").exit_code == 0) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    throw std::runtime_error("the server does not answer");
  }
  ~ClickhouseServer() {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  ClickhouseServer(const ClickhouseServer&) = delete;
  ClickhouseServer& operator=(const ClickhouseServer&) = delete;

  CommandResult sql(const std::string& statements) const {
    const std::filesystem::path file = folder_ / "statements.sql";
    std::ofstream(file, std::ios::binary) << statements;
    return run_command(fmt::format(
        "clickhouse-client --host 127.0.0.1 --port {} --multiquery --max_query_size "
        "16777216 --max_ast_elements 1000000 --max_expanded_ast_elements 10000000 < '{}'",
        port_, file.string()));
  }

 private:
  std::filesystem::path folder_;
  int port_;
  pid_t process_ = 0;
};

}  // namespace wearwell
