#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "wearwell/monitor/message.h"

namespace wearwell::monitor {

/// Splits a stream of lines, JSON or CSV, into messages: whole lines only, and for CSV each message
/// with the heading of the stream.
class LineFeed {
 public:
  /// `needed`: the required fields of a row; a line that contains all of them is a heading of CSV.
  /// Lines before JSON or a heading are refused one by one.
  /// `has_heading`: false for a form without: all lines are messages.
  explicit LineFeed(std::vector<std::string> needed, bool has_heading = true)
      : needed_(std::move(needed)), begun_(!has_heading) {}
  void push(std::string_view bytes) { text_ += bytes; }
  /// Largest number of bytes read before `next` is called.
  static constexpr std::size_t piece_size = longest_message / 8;

  struct Piece {
    std::string payload;
    Form form = Form::any;
    std::size_t bytes = 0;  ///< of the continued stream
    bool skips = false;     ///< the following input belongs to an overlong line
    /// Why lines of it are not messages; then there is no payload.
    std::vector<std::string> refused = {};
  };
  /// The whole lines so far; `ended`: the rest of the stream is a line too. Valid until `taken`.
  std::optional<Piece> next(bool ended);
  void taken(const Piece& piece);
  bool empty() const { return text_.empty(); }

  /// Continues after the heading in this beginning of the stream, if it is CSV.
  void set_heading(std::string_view beginning);
  /// Keeps unprocessed input to be pushed again.
  void forget() { text_.clear(); }

 private:
  bool is_heading(std::string_view line) const;
  Piece begin(std::string_view lines);

  std::vector<std::string> needed_;
  std::string text_, heading_;
  bool begun_ = false, skipping_ = false;
};

}  // namespace wearwell::monitor
