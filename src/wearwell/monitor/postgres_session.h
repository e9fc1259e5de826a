#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <pqxx/pqxx>
#include <string>

namespace wearwell::monitor {

/// One connection to PostgreSQL, opened when first needed and reopened after it was lost. Any
/// thread may call.
class PostgresSession {
 public:
  /// `begin` is called with every new connection; an exception refuses it.
  PostgresSession(std::string url, std::function<void(pqxx::connection&)> begin)
      : url_(std::move(url)), begin_(std::move(begin)) {}

  /// One transaction. Throws StoreError if the server refuses or is unreachable; the connection is
  /// then closed.
  void run(const std::function<void(pqxx::work&)>& work);

 private:
  const std::string url_;
  const std::function<void(pqxx::connection&)> begin_;
  std::mutex lock_;
  std::unique_ptr<pqxx::connection> connection_;
};

}  // namespace wearwell::monitor
