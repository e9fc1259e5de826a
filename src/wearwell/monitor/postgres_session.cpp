#include "wearwell/monitor/postgres_session.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/printable.h"
#include "wearwell/monitor/store.h"

namespace wearwell::monitor {
namespace {

/// With timeouts for an unreachable server, unless the URL has its own.
std::string bounded(const std::string& url) {
  std::string text = url;
  for (const char* each :
       {"connect_timeout=5", "tcp_user_timeout=15000", "application_name=wearwell"}) {
    const std::string name = std::string(each).substr(0, std::string(each).find('='));
    if (text.find(name) != std::string::npos) continue;
    text += (text.find('?') == std::string::npos ? "?" : "&") + std::string(each);
  }
  return text;
}

std::string description(const std::exception& error) {
  std::string text = error.what();
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  return printable(valid_utf8(text));
}

}  // namespace

std::string shown_url(const std::string& url) {
  const std::size_t begin = url.find("://") + 3;
  const std::size_t slash = std::min(url.find('/', begin), url.size());
  const std::size_t at = url.rfind('@', slash);
  const std::size_t host = at == url.npos || at < begin ? begin : at + 1;
  return "postgresql://" + url.substr(host, url.find('?', host) - host);
}

void PostgresSession::run(const std::function<void(pqxx::work&)>& work) {
  const std::lock_guard lock(lock_);
  try {
    if (!connection_) {
      auto fresh = std::make_unique<pqxx::connection>(bounded(url_));
      // An automatic reconnection would lose its lock unnoticed.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"  // later versions never return
      fresh->inhibit_reactivation(true);
#pragma GCC diagnostic pop
      fresh->set_client_encoding("UTF8");
      begin_(*fresh);
      connection_ = std::move(fresh);
    }
    pqxx::work transaction(*connection_);
    work(transaction);
    transaction.commit();
  } catch (const StoreError&) {
    connection_.reset();
    throw;
  } catch (const pqxx::pqxx_exception& error) {
    connection_.reset();
    throw StoreError(fmt::format("{}: {}", shown_url(url_), description(error.base())));
  }
}

}  // namespace wearwell::monitor
