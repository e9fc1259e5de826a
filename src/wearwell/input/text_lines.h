#pragma once

#include <zlib.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/input/table_settings.h"

namespace wearwell {

inline constexpr std::size_t longest_line = 16 << 20;

/// An unclosed quote.
struct OpenQuote : InputError {
  using InputError::InputError;
};

/// Lines of a text in any encoding, compressed or not, as UTF-8 without line endings; a byte-order
/// mark is omitted.
class TextLines {
 public:
  /// `source` is the name in messages. Throws InputError.
  TextLines(const std::string& path, std::string source, Encoding encoding);

  /// The next line, valid until the next call. Throws InputError: too long, bytes that are invalid
  /// in the encoding.
  bool next(std::string_view& line);

  /// Throws OpenQuote: "FILE, line 3: a quote is not closed".
  [[noreturn]] void refuse_open_quote(std::size_t line) const;

  bool unpacks() const { return gzdirect(file_.get()) == 0; }

  std::size_t number = 0;   ///< of the last line, from 1
  bool has_return = false;  ///< the line ended with a carriage return
  bool last = false;        ///< the line had no line ending

 private:
  void fill();
  void decode(std::string_view bytes);

  struct CloseGzip {
    void operator()(gzFile file) const { gzclose(file); }
  };
  std::string source_;
  Encoding encoding_;
  std::unique_ptr<gzFile_s, CloseGzip> file_;
  std::vector<char> raw_;
  std::size_t kept_ = 0;  // incomplete bytes before `raw_`
  std::string text_;
  std::size_t at_ = 0;
  bool started_ = false, ended_ = false;
};

/// The encoding according to the first bytes: UTF-16 by its byte-order mark or zero bytes, else
/// UTF-8.
Encoding first_encoding(const std::string& path);

bool is_ascii(std::string_view text);
bool is_utf8(std::string_view text);

/// Its name in messages: "cp1252".
const char* encoding_name(Encoding encoding);

}  // namespace wearwell
