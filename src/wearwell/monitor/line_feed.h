#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "wearwell/monitor/message.h"

namespace wearwell::monitor {

/// Makes messages of a stream of lines, JSON or CSV: whole lines only, and of CSV each message with the heading of the stream.
class LineFeed {
 public:
  void push(std::string_view bytes) { text_ += bytes; }
  /// So many bytes are read at most before `next` is asked.
  static constexpr std::size_t piece_size = longest_message / 8;

  struct Piece {
    std::string payload;
    Form form = Form::any;
    std::size_t bytes = 0;  ///< of the stream that it takes up
    bool too_long = false;  ///< a line without end: nothing of it is a message
    bool skips = false;     ///< what follows belongs to such a line
  };
  /// The whole lines so far; `ended`: the rest of the stream is a line too. It stays until `taken`.
  std::optional<Piece> next(bool ended);
  void taken(const Piece& piece);
  bool empty() const { return text_.empty(); }

  /// Goes on behind a heading that was read before.
  void set_heading(std::string_view line) { heading_ = line; }
  /// Leaves what is not taken to be pushed again.
  void forget() { text_.clear(); }
  static bool is_json(std::string_view line);

 private:
  std::string text_, heading_;
  bool begun_ = false, skipping_ = false;
};

}  // namespace wearwell::monitor
