#pragma once

#include <fmt/format.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/free_port.h"
#include "support/run_command.h"
#include "support/servers.h"

namespace wearwell {

/// The ports of a server of ClickHouse.
struct ClickhousePorts {
  int tcp = free_port(), http = free_port(), https = free_port(), between = free_port();
};

/// A cluster `two` of shards with replicas each, as every server of it knows it.
struct ClickhouseCluster {
  int zookeeper = 0;  ///< its port
  std::vector<std::vector<ClickhousePorts>> shards;
};

/// A server of ClickHouse in a folder of its own on the loopback, ended by its own process id.
class ClickhouseServer {
 public:
  static std::string missing() {
    if (run_command("PATH=$PATH:/usr/sbin command -v clickhouse-server").exit_code != 0 ||
        run_command("command -v clickhouse-client").exit_code != 0)
      return "no server of ClickHouse is installed";
    return "";
  }

  /// `more` of its configuration.
  explicit ClickhouseServer(const std::filesystem::path& parent, const std::string& more = "")
      : folder_(parent / "clickhouse") {
    start(more);
  }
  /// One of a cluster. Its profile would skip shards that are dead.
  ClickhouseServer(const std::filesystem::path& parent, const ClickhouseCluster& cluster,
                   std::size_t shard, std::size_t replica)
      : folder_(parent / fmt::format("clickhouse-{}-{}", shard, replica)),
        ports_(cluster.shards[shard][replica]) {
    std::string shards;
    for (const auto& replicas : cluster.shards) {
      shards += "<shard><internal_replication>true</internal_replication>";
      for (const ClickhousePorts& each : replicas)
        shards += fmt::format("<replica><host>127.0.0.1</host><port>{}</port></replica>", each.tcp);
      shards += "</shard>";
    }
    start(
        fmt::format("<remote_servers><two>{}</two></remote_servers><zookeeper><node><host>127.0.0.1"
                    "</host><port>{}</port></node></zookeeper><macros><shard>{}</shard><replica>{}"
                    "</replica></macros><interserver_http_port>{}</interserver_http_port>"
                    "<interserver_http_host>127.0.0.1</interserver_http_host>",
                    shards, cluster.zookeeper, shard, replica, ports_.between),
        "<skip_unavailable_shards>1</skip_unavailable_shards>");
  }

  CommandResult sql(const std::string& statements) const {
    const std::filesystem::path file = folder_ / "statements.sql";
    std::ofstream(file, std::ios::binary) << statements;
    return run_command(fmt::format(
        "clickhouse-client --host 127.0.0.1 --port {} --multiquery --max_query_size "
        "16777216 --max_ast_elements 1000000 --max_expanded_ast_elements 10000000 < '{}'",
        ports_.tcp, file.string()));
  }
  std::string address(const std::string& user = "") const {
    return fmt::format("clickhouse://{}127.0.0.1:{}", user, ports_.http);
  }
  const ClickhousePorts& ports() const { return ports_; }

  /// As a machine dies: at once.
  void stop() { process_.end(SIGKILL); }

 private:
  void start(const std::string& more, const std::string& profile = "") {
    const std::string here = folder_.string();
    std::filesystem::create_directories(folder_ / "data");
    std::ofstream(folder_ / "config.xml") << fmt::format(
        "<yandex><logger><level>warning</level><log>{0}/log</log><errorlog>{0}/errors</errorlog>"
        "</logger><tcp_port>{1}</tcp_port><http_port>{2}</http_port><listen_host>127.0.0.1"
        "</listen_host><path>{0}/data/</path><tmp_path>{0}/tmp/</tmp_path><users_config>{0}"
        "/users.xml</users_config><default_profile>default</default_profile><default_database>"
        "default</default_database><mark_cache_size>67108864</mark_cache_size>{3}</yandex>",
        here, ports_.tcp, ports_.http, more);
    const auto user = [](const char* name, const char* password) {
      return fmt::format(
          "<{0}><password>{1}</password><networks><ip>127.0.0.1</ip></networks><profile>default"
          "</profile><quota>default</quota></{0}>",
          name, password);
    };
    std::ofstream(folder_ / "users.xml") << fmt::format(
        "<yandex><profiles><default><max_memory_usage>2000000000</max_memory_usage>{}</default>"
        "</profiles><users>{}{}</users><quotas><default></default></quotas></yandex>",
        profile, user("default", ""), user("reader", "se cret/@%"));
    // It refuses data of another user than its own.
    process_ = ChildProcess({"sh", "-c",
                             fmt::format("cd '{0}' && PATH=$PATH:/usr/sbin exec clickhouse-server "
                                         "--config-file='{0}/config.xml' </dev/null",
                                         here)},
                            folder_ / "out");
    // Another's server may answer where this one could not begin.
    if (!eventually([&] { return !process_.runs() || sql("select 1").exit_code == 0; }) ||
        !process_.runs())
      throw std::runtime_error("the server does not answer");
  }

  std::filesystem::path folder_;
  ClickhousePorts ports_;
  ChildProcess process_;
};

/// A server of ZooKeeper on the loopback, which tables of several replicas want.
class ZookeeperServer {
 public:
  static std::string missing() {
    if (!std::filesystem::exists("/usr/share/java/zookeeper.jar") ||
        run_command("command -v java").exit_code != 0)
      return "no ZooKeeper is installed";
    return "";
  }

  explicit ZookeeperServer(const std::filesystem::path& parent)
      : folder_(parent / "zookeeper"), port_(free_port()) {
    std::filesystem::create_directories(folder_);
    const std::string here = folder_.string();
    std::ofstream(folder_ / "zoo.cfg") << fmt::format(
        "tickTime=500\ndataDir={}/data\nclientPort={}\nclientPortAddress=127.0.0.1\n"
        "admin.enableServer=false\n",
        here, port_);
    process_ = ChildProcess(
        {"sh", "-c",
         fmt::format("exec java -Xmx96m -XX:+UseSerialGC -XX:TieredStopAtLevel=1 -cp "
                     "/usr/share/java/zookeeper.jar "
                     "org.apache.zookeeper.server.ZooKeeperServerMain '{0}/zoo.cfg' </dev/null",
                     here)},
        folder_ / "out");
    // It listens before it serves: until then `srvr` has another answer.
    const std::string ask = fmt::format(
        "bash -c 'exec 3<>/dev/tcp/127.0.0.1/{} && echo srvr >&3 && timeout 5 cat <&3'", port_);
    if (!eventually(
            [&] { return run_command(ask).out.find("Mode: standalone") != std::string::npos; }))
      throw std::runtime_error("ZooKeeper does not answer");
  }
  int port() const { return port_; }

 private:
  std::filesystem::path folder_;
  int port_;
  ChildProcess process_;
};

}  // namespace wearwell
