#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "wearwell/http/handler.h"
#include "wearwell/http/served_page.h"
#include "wearwell/workbench/session.h"

namespace wearwell::workbench {

/// The routes of one session (docs/how-to/workbench.md). A request needs the token, `Authorization:
/// Bearer TOKEN`; without it there are only the page, which holds no data, and the report and
/// the page of a comparison under addresses that only the page learns. Names in `Host` and `Origin` must be those of loopback with our port.
class Routes final : public HttpHandler {
 public:
  Routes(Session& session, std::string token);

  /// The port that `Host` must name; requests before it are refused.
  void set_port(unsigned short port) { port_ = port; }
  /// Whether an authorized request has come, and the time since the last one or since a page was
  /// last known to be open, in s.
  bool was_used() const { return last_used_ > 0; }
  double idle_seconds() const;

  std::optional<HttpResponse> refuse(const HttpRequest& question) const override;
  bool is_events(const HttpRequest& question) const override;
  bool is_supervision(const HttpRequest&) const override { return false; }
  bool is_delivery(const HttpRequest& question) const override;
  HttpResponse answer(const HttpRequest& question, const HttpCounts& counts) const override;
  std::uint64_t version() const override;
  std::string event(std::optional<std::uint64_t> version, std::uint64_t* reached) const override;
  std::string beat() const override;
  std::optional<std::uint64_t> version_of(const std::string&) const override { return {}; }

 private:
  bool is_ours(const HttpRequest& question) const;
  bool authorized(const HttpRequest& question) const;
  void note_use() const;
  HttpResponse page(const HttpRequest& question) const;
  HttpResponse report() const;
  HttpResponse comparison() const;

  Session& session_;
  const std::string token_, report_path_, comparison_path_;
  const ServedPage page_;
  std::atomic<unsigned short> port_ = 0;             ///< set while requests already come
  mutable std::atomic<std::int64_t> last_used_ = 0;  ///< steady clock, ms
};

}  // namespace wearwell::workbench
