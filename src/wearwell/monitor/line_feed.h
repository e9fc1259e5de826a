#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "wearwell/monitor/message.h"

namespace wearwell::monitor {

/// Makes messages of a stream of lines, JSON or CSV: whole lines only, and of CSV each message with the heading of the stream.
class LineFeed {
 public:
  /// `needed`: the fields without which no row is a reading: a line that has them all is a heading of CSV. What comes before JSON or a
  /// heading is refused, line by line.
  explicit LineFeed(std::vector<std::string> needed) : needed_(std::move(needed)) {}
  void push(std::string_view bytes) { text_ += bytes; }
  /// So many bytes are read at most before `next` is asked.
  static constexpr std::size_t piece_size = longest_message / 8;

  struct Piece {
    std::string payload;
    Form form = Form::any;
    std::size_t bytes = 0;  ///< of the stream that it takes up
    bool skips = false;     ///< what follows belongs to a line that was too long
    /// Why lines of it are no messages; then there is no payload.
    std::vector<std::string> refused = {};
  };
  /// The whole lines so far; `ended`: the rest of the stream is a line too. It stays until `taken`.
  std::optional<Piece> next(bool ended);
  void taken(const Piece& piece);
  bool empty() const { return text_.empty(); }

  /// Goes on behind the heading that this beginning of the stream has, if it is CSV.
  void set_heading(std::string_view beginning);
  /// Leaves what is not taken to be pushed again.
  void forget() { text_.clear(); }

 private:
  bool is_heading(std::string_view line) const;
  Piece begin(std::string_view lines);

  std::vector<std::string> needed_;
  std::string text_, heading_;
  bool begun_ = false, skipping_ = false;
};

}  // namespace wearwell::monitor
