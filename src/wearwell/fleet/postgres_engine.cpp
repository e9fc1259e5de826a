#include "wearwell/fleet/postgres_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <chrono>
#include <cmath>
#include <future>
#include <limits>
#include <pqxx/pqxx>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell::fleet {
namespace {

/// The first line of the server's error, without "ERROR: ".
std::string sentence(const std::string& message) {
  std::string line = message.substr(0, message.find('\n'));
  if (boost::algorithm::starts_with(line, "ERROR:")) line.erase(0, 6);
  return printable(boost::algorithm::trim_copy(line));
}

/// Types of numbers in pg_type, the same in every version: bigint, smallint, integer, real, double
/// precision, numeric.
constexpr unsigned numbers[] = {20, 21, 23, 700, 701, 1700};
constexpr unsigned reals[] = {700, 701, 1700};
/// date; timestamp, timestamp with time zone.
constexpr unsigned dates[] = {1082}, times[] = {1114, 1184};

class PostgresEngine : public Engine {
 public:
  PostgresEngine(const std::string& address, const std::string& table, bool read_only)
      : name_(table), table_(table_identifier(Dialect::postgresql, table)), read_only_(read_only) {
    try {
      connection_ = std::make_unique<pqxx::connection>(address);
      // JIT compilation of a thousand expressions takes longer than running them.
      // All rows of a cursor are fetched: a plan for the first ones is not wanted.
      execute(
          "set jit = off; set client_min_messages = error; set datestyle = iso; set "
          "cursor_tuple_fraction = 1");
    } catch (const pqxx::broken_connection& error) {
      throw InputError(fmt::format("PostgreSQL cannot be reached: {}", sentence(error.what())));
    }
  }

  Dialect dialect() const override { return Dialect::postgresql; }
  std::string description() const override {
    const int version = connection_->server_version();
    return fmt::format("PostgreSQL {}.{}", version / 10000, version % 10000);
  }
  std::string table() const override { return table_; }
  std::string source() const override {
    const char* host = connection_->hostname();
    return fmt::format("{} at {}:{}", printable(name_), printable(host ? host : "this machine"),
                       printable(connection_->port()));
  }

  std::vector<EngineColumn> columns() override;
  void begin() override {
    execute(fmt::format("begin transaction isolation level repeatable read{}",
                        read_only_ ? " read only" : ""));
  }
  void commit() override { execute("commit"); }
  void run(const std::string& statements, const Monitor& monitor, const std::string& what,
           long long total) override;
  void rows(const std::string& query, std::size_t texts,
            const std::function<void(const Row&)>& take) override;

 private:
  pqxx::result execute(const std::string& statements);

  std::string name_, table_;
  bool read_only_;
  std::unique_ptr<pqxx::connection> connection_;
};

pqxx::result PostgresEngine::execute(const std::string& statements) {
  try {
    pqxx::nontransaction work(*connection_);
    return work.exec(statements);
  } catch (const pqxx::broken_connection& error) {
    throw InputError(fmt::format("{}: the connection broke: {}", source(), sentence(error.what())));
  } catch (const pqxx::sql_error& error) {
    const std::string said = sentence(error.what());
    if (said.find("user request") != std::string::npos) throw Cancelled();
    if (error.sqlstate().starts_with("53"))  // insufficient resources
      throw MachineError(fmt::format("{}: {}", source(), said));
    // The right to create is missing: in the schema, or since the server is a standby.
    const bool cannot_create = !read_only_ && (said.find("for schema") != std::string::npos ||
                                               error.sqlstate() == "25006");
    throw InputError(fmt::format(
        "{}: {}{}", source(), said,
        cannot_create ? "; --read-only creates no tables and sums all cycles in one query" : ""));
  }
}

std::vector<EngineColumn> PostgresEngine::columns() {
  const pqxx::result result = execute("select * from " + table_ + " limit 0");
  std::vector<EngineColumn> found;
  for (pqxx::row_size_type c = 0; c < result.columns(); ++c) {
    const auto among = [&](const auto& types) {
      return std::find(std::begin(types), std::end(types), result.column_type(c)) !=
             std::end(types);
    };
    found.push_back(
        {result.column_name(c), among(numbers), among(reals), among(dates), among(times)});
  }
  return found;
}

void PostgresEngine::run(const std::string& statements, const Monitor& monitor,
                         const std::string& what, long long) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  auto work = std::async(std::launch::async, [&] { execute(statements); });
  while (work.wait_for(std::chrono::milliseconds(200)) != std::future_status::ready) {
    if (monitor.stop.stop_requested()) connection_->cancel_query();
    // The server does not report its progress.
    if (monitor.progress)
      monitor.progress({what, 0, 0, std::chrono::duration<double>(Clock::now() - start).count()});
  }
  work.get();
}

void PostgresEngine::rows(const std::string& query, std::size_t texts,
                          const std::function<void(const Row&)>& take) {
  constexpr int at_once = 2000;
  execute("declare wearwell no scroll cursor for " + query);
  Row row;
  row.texts.resize(texts);
  for (;;) {
    const pqxx::result some = execute(fmt::format("fetch {} from wearwell", at_once));
    for (const pqxx::row& each : some) {
      row.numbers.resize(each.size() - texts);
      for (std::size_t c = 0; c < each.size(); ++c) {
        const pqxx::field field = each[static_cast<pqxx::row_size_type>(c)];
        if (c < texts) {
          row.texts[c] = field.is_null() ? "" : field.c_str();
        } else {
          row.numbers[c - texts] =
              field.is_null() ? std::numeric_limits<double>::quiet_NaN() : field.as<double>();
        }
      }
      take(row);
    }
    if (some.size() < at_once) break;
  }
  execute("close wearwell");
}

}  // namespace

std::unique_ptr<Engine> postgres_engine(const std::string& address, const std::string& table,
                                        bool read_only) {
  return std::make_unique<PostgresEngine>(address, table, read_only);
}

}  // namespace wearwell::fleet
