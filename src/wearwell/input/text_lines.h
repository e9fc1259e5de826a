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

/// A quote that no other closes.
struct OpenQuote : InputError {
  using InputError::InputError;
};

/// Lines of a text in any encoding, compressed or not, as UTF-8 and without their ends; a mark of
/// the encoding at its beginning is left out.
class TextLines {
 public:
  /// `source` is the name in messages. Throws InputError.
  TextLines(const std::string& path, std::string source, Encoding encoding);

  /// The next line, which lives until the one after it. Throws InputError: too long, bytes that the
  /// encoding does not have.
  bool next(std::string_view& line);

  /// Throws OpenQuote: "FILE, line 3: a quote is opened and never closed".
  [[noreturn]] void refuse_open_quote(std::size_t line) const;

  bool unpacks() const { return gzdirect(file_.get()) == 0; }

  std::size_t number = 0;   ///< of the line that came last, from 1
  bool has_return = false;  ///< it ended with a carriage return
  bool last = false;        ///< it had no end

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
  std::size_t kept_ = 0;  // bytes in front of `raw_` that wait for more
  std::string text_;
  std::size_t at_ = 0;
  bool started_ = false, ended_ = false;
};

/// The encoding that the first bytes show: UTF-16 by its mark or by its zeros, else UTF-8.
Encoding first_encoding(const std::string& path);

bool is_ascii(std::string_view text);
bool is_utf8(std::string_view text);

/// "cp1252": how messages call it.
const char* encoding_name(Encoding encoding);

}  // namespace wearwell
