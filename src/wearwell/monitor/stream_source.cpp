#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <vector>

#include "wearwell/monitor/line_feed.h"
#include "wearwell/monitor/source.h"

namespace wearwell::monitor {
namespace {

/// False if the store was not available before the end.
bool hand_over(SourceContext& context, LineFeed& feed, bool ended, std::stop_token stop) {
  while (const auto piece = feed.next(ended)) {
    for (const std::string& each : piece->refused) context.intake.refuse(context.settings, each);
    if (!piece->payload.empty()) {
      const Message message{"", piece->payload, piece->form};
      if (!deliver_until_stored(context, std::span(&message, 1), stop)) return false;
    }
    feed.taken(*piece);
  }
  return true;
}

}  // namespace

void read_stream(SourceContext& context, int descriptor, std::stop_token stop) {
  LineFeed feed(needed_fields(context.settings.mapping), context.settings.format.form == Form::any);
  std::vector<char> buffer(LineFeed::piece_size);
  while (!stop.stop_requested()) {
    constexpr int patience_ms = 100;
    pollfd ready{descriptor, POLLIN, 0};
    if (poll(&ready, 1, patience_ms) <= 0) continue;
    const ssize_t count = read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count > 0) feed.push({buffer.data(), static_cast<std::size_t>(count)});
    if (!hand_over(context, feed, count <= 0, stop) || count <= 0) break;
  }
  if (!feed.empty())
    context.notices.tell("source." + context.settings.name,
                         "the input ended before all of it was stored; send it again");
}

}  // namespace wearwell::monitor
