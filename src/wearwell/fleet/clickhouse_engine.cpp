#include "wearwell/fleet/clickhouse_engine.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>

#include "wearwell/base/printable.h"
#include "wearwell/fleet/clickhouse_address.h"
#include "wearwell/fleet/clickhouse_text.h"

namespace wearwell::fleet {
namespace {

using Clock = std::chrono::steady_clock;

/// Settings that prevent partial answers, whatever a user's profile says; and allow statements of
/// thousands of columns, in blocks of few rows (groups come in one block each only if they may be
/// spilled).
constexpr const char* settings =
    "&wait_end_of_query=1&skip_unavailable_shards=0&max_parallel_replicas=1"
    "&fallback_to_stale_replicas_for_distributed_queries=0&read_overflow_mode=throw"
    "&timeout_overflow_mode=throw&group_by_overflow_mode=throw&sort_overflow_mode=throw"
    "&result_overflow_mode=throw&set_overflow_mode=throw&join_overflow_mode=throw"
    "&transfer_overflow_mode=throw&distinct_overflow_mode=throw&join_use_nulls=0"
    "&join_default_strictness=ALL&max_query_size=16777216&max_ast_elements=1000000"
    "&max_expanded_ast_elements=10000000&group_by_two_level_threshold=1&max_bytes_before_external_"
    "group_by=1000000000"
    "&max_block_size=8192";
constexpr int session_seconds = 3600;  // the default maximum of a server
constexpr double poll_seconds = 20;
constexpr int polls_in_vain = 3;

std::string new_id() {
  std::random_device random;
  return fmt::format("wearwell-{}-{:08x}{:08x}", getpid(), random(), random());
}

class ClickhouseEngine : public Engine {
 public:
  ClickhouseEngine(const std::string& address, const std::string& table)
      : address_(read_clickhouse_address(address)),
        name_(table),
        table_(table_identifier(Dialect::clickhouse, table)) {
    begin();
  }

  Dialect dialect() const override { return Dialect::clickhouse; }
  std::string description() const override { return "ClickHouse " + printable(version_); }
  std::string table() const override { return table_; }
  std::string source() const override {
    const HttpPlace& place = address_.hosts[host_];
    return fmt::format("{} at {}:{}", printable(name_), printable(place.host), place.port);
  }

  std::vector<EngineColumn> columns() override;
  void begin() override;
  void commit() override {}
  void refuse_split_units(const std::string& unit) override;
  void run(const std::string& statements, const Monitor& monitor, const std::string& what,
           long long total) override;
  void rows(const std::string& query, std::size_t texts,
            const std::function<void(const Row&)>& take) override {
    rows(query, "", texts, take);
  }

 private:
  using Take = std::function<void(std::string_view)>;
  struct ProgressReport {
    const Monitor& monitor;
    const std::string& what;
    long long total = 0;
  };

  void rows(const std::string& query, const std::string& more, std::size_t texts,
            const std::function<void(const Row&)>& take);
  HttpRequest request(const std::string& statement, const std::string& parameters) const;
  /// In the session; `more` parameters: "&name=value".
  void ask(const std::string& statement, const std::string& more, const Take& take,
           const ProgressReport* reported);
  void watch(const std::string& query_id, const ProgressReport* reported, Clock::time_point start);
  std::string quick(const std::string& statement) const;
  [[noreturn]] void fail(const std::string& said) const;
  std::string at() const {
    return fmt::format("{}:{}", address_.hosts[host_].host, address_.hosts[host_].port);
  }

  ClickhouseAddress address_;
  std::string name_, table_, version_, session_;
  std::size_t host_ = 0;
  bool lost_ = false;
  Clock::time_point polled_ = {};
  int in_vain_ = 0;
};

HttpRequest ClickhouseEngine::request(const std::string& statement,
                                      const std::string& parameters) const {
  // Not in the target, which servers log.
  return {.target = "/?database=" + url_part(address_.database) + parameters,
          .fields = {{"X-ClickHouse-User", address_.user}, {"X-ClickHouse-Key", address_.password}},
          .body = statement};
}

/// A short query outside the session.
std::string ClickhouseEngine::quick(const std::string& statement) const {
  HttpRequest asked = request(statement, "");
  asked.seconds = poll_seconds;
  std::string answer;
  int status = 0;
  http_post(address_.hosts[host_], asked, [&](int code, std::string_view piece) {
    status = code;
    if (answer.size() < most_said) answer += piece;
  });
  if (status != 200) fail(answer);
  return answer;
}

/// The next host that answers, with a new session: the state of the previous one is lost.
void ClickhouseEngine::begin() {
  std::string why;
  if (lost_) host_ = (host_ + 1) % address_.hosts.size();
  for (std::size_t i = 0; i < address_.hosts.size(); ++i) {
    try {
      version_ = boost::algorithm::trim_copy(quick("select version()"));
      lost_ = false;
      session_.clear();
      const std::string id = new_id();
      ask(
          "select 1", fmt::format("&session_id={}&session_timeout={}", id, session_seconds),
          [](std::string_view) {}, nullptr);
      session_ = id;
      return;
    } catch (const HttpBroken& error) {
      why += fmt::format("{}{}: {}", why.empty() ? "" : ", ", at(), printable(error.what()));
      host_ = (host_ + 1) % address_.hosts.size();
    }
  }
  throw InputError(fmt::format("ClickHouse cannot be reached: {}", why));
}

void ClickhouseEngine::fail(const std::string& said) const {
  const int code = error_code(said);
  const std::string sentence = fmt::format("{}: {}", source(), error_sentence(said));
  switch (code) {
    case 394:  // QUERY_WAS_CANCELLED
      throw Cancelled();
    case 241:  // MEMORY_LIMIT_EXCEEDED
    case 243:  // NOT_ENOUGH_SPACE
      throw MachineError(sentence);
    case 395:  // FUNCTION_THROW_IF_VALUE_IS_NON_ZERO, which the statements use
      throw InputError(sentence + ": a number is out of range");
    case 32:    // ATTEMPT_TO_READ_AFTER_EOF
    case 101:   // UNEXPECTED_PACKET_FROM_SERVER
    case 209:   // SOCKET_TIMEOUT
    case 210:   // NETWORK_ERROR
    case 279:   // ALL_CONNECTION_TRIES_FAILED
    case 372:   // SESSION_NOT_FOUND
    case 1000:  // of its network library
      throw Lost(sentence + "; a part of the table does not answer");
    default:
      throw InputError(sentence);
  }
}

/// Ten times a second while waiting for an answer.
void ClickhouseEngine::watch(const std::string& query_id, const ProgressReport* reported,
                             Clock::time_point start) {
  if (reported && reported->monitor.stop.stop_requested()) {
    try {
      quick("kill query where query_id = " + literal(Dialect::clickhouse, query_id));
    } catch (const std::exception&) {
      // It ends by itself, or is gone.
    }
    throw Cancelled();
  }
  const auto now = Clock::now();
  if (now - polled_ < std::chrono::seconds(1)) return;
  polled_ = now;
  double read = 0;
  try {
    const std::string answer = quick("select read_rows from system.processes where query_id = " +
                                     literal(Dialect::clickhouse, query_id));
    read = std::strtod(answer.c_str(), nullptr);
    in_vain_ = 0;
  } catch (const HttpBroken&) {
    // A machine that is gone sends nothing.
    if (++in_vain_ >= polls_in_vain) throw;
  } catch (const std::exception&) {
    in_vain_ = 0;  // It answers, even if only to refuse the query.
  }
  polled_ = Clock::now();
  if (reported && reported->monitor.progress)
    reported->monitor.progress(
        {reported->what, std::min(static_cast<long long>(read), reported->total), reported->total,
         std::chrono::duration<double>(now - start).count()});
}

void ClickhouseEngine::ask(const std::string& statement, const std::string& more, const Take& take,
                           const ProgressReport* reported) {
  const std::string id = new_id();
  std::string parameters = fmt::format("&query_id={}{}{}", id, settings, more);
  if (!session_.empty())
    parameters +=
        fmt::format("&session_id={}&session_timeout={}&session_check=1", session_, session_seconds);
  HttpRequest asked = request(statement, parameters);
  const auto start = Clock::now();
  polled_ = start;
  in_vain_ = 0;
  asked.wait = [&] { watch(id, reported, start); };
  std::string said;
  int status = 0;
  try {
    http_post(address_.hosts[host_], asked, [&](int code, std::string_view piece) {
      status = code;
      if (code == 200) {
        take(piece);
      } else if (said.size() < most_said) {
        said += piece;
      }
    });
  } catch (const HttpBroken& error) {
    if (session_.empty()) throw;
    lost_ = true;
    throw Lost(fmt::format("{}: the connection broke: {}", source(), printable(error.what())));
  }
  if (status == 200 || (status == 0 && said.empty())) return;
  try {
    fail(said);
  } catch (const Lost&) {
    lost_ = true;
    throw;
  }
}

void ClickhouseEngine::rows(const std::string& query, const std::string& more, std::size_t texts,
                            const std::function<void(const Row&)>& take) {
  SeparatedText text;
  Row row;
  const auto take_row = [&](const std::vector<std::string>& cells) {
    if (cells.size() < texts)
      throw InputError(fmt::format("{}: an answer has too few columns", source()));
    row.texts.assign(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(texts));
    row.numbers.clear();
    for (std::size_t c = texts; c < cells.size(); ++c)
      row.numbers.push_back(separated_number(cells[c]));
    take(row);
  };
  ask(
      query + "\nformat TabSeparated", more,
      [&](std::string_view piece) { text.add(piece, take_row); }, nullptr);
  if (!text.at_end())
    throw Lost(fmt::format("{}: the connection broke within a row of the answer", source()));
}

std::vector<EngineColumn> ClickhouseEngine::columns() {
  std::vector<EngineColumn> found;
  rows("describe table " + table_, "", 2, [&](const Row& row) {
    std::string type = row.texts[1];
    for (const char* wrap : {"LowCardinality(", "Nullable("}) {
      if (boost::algorithm::starts_with(type, wrap))
        type = type.substr(std::string_view(wrap).size());
    }
    const auto starts = [&](const char* name) { return boost::algorithm::starts_with(type, name); };
    const bool real = starts("Float") || starts("Decimal");
    found.push_back({row.texts[0], real || (starts("Int") && !starts("Interval")) || starts("UInt"),
                     real, starts("Date") && !starts("DateTime"), starts("DateTime")});
  });
  return found;
}

/// Each shard returns its own units; the outer query combines them.
void ClickhouseEngine::refuse_split_units(const std::string& unit) {
  rows(fmt::format("select unit from (select toString({}) as unit from {} group by unit) group by "
                   "unit having count() > 1 order by unit limit 1",
                   identifier(Dialect::clickhouse, unit), table_),
       "&distributed_group_by_no_merge=1", 1, [&](const Row& row) {
         throw InputError(
             fmt::format("{}: unit {} has cycles in more than one shard: all rows of a unit must "
                         "be in one (shard the table by a hash of the unit)",
                         source(), printable(row.texts.front())));
       });
}

void ClickhouseEngine::run(const std::string& statements, const Monitor& monitor,
                           const std::string& what, long long total) {
  const ProgressReport reported{monitor, what, total};
  for (const std::string& each : single_statements(statements))
    ask(
        each, "", [](std::string_view) {}, &reported);
}

}  // namespace

bool is_clickhouse(const std::string& address) {
  for (const char* scheme : {"clickhouse://", "clickhouses://", "http://", "https://"})
    if (boost::algorithm::starts_with(address, scheme)) return true;
  return false;
}

std::unique_ptr<Engine> clickhouse_engine(const std::string& address, const std::string& table) {
  return std::make_unique<ClickhouseEngine>(address, table);
}

}  // namespace wearwell::fleet
