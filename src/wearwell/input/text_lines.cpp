#include "wearwell/input/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell {
namespace {

constexpr std::size_t piece = 1 << 18;

void append_utf8(std::string& out, std::uint32_t code) {
  const auto add = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
  if (code < 0x80) {
    add(code);
  } else if (code < 0x800) {
    add(0xC0 | code >> 6);
    add(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    add(0xE0 | code >> 12);
    add(0x80 | (code >> 6 & 0x3F));
    add(0x80 | (code & 0x3F));
  } else {
    add(0xF0 | code >> 18);
    add(0x80 | (code >> 12 & 0x3F));
    add(0x80 | (code >> 6 & 0x3F));
    add(0x80 | (code & 0x3F));
  }
}

// Windows-1252 from 0x80 to 0x9F (https://encoding.spec.whatwg.org/index-windows-1252.txt); 0 for
// unassigned codes.
constexpr std::array<std::uint16_t, 32> cp1252_high = {
    0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152, 0,      0x017D, 0,      0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};

}  // namespace

TextLines::TextLines(const std::string& path, std::string source, Encoding encoding)
    : source_(std::move(source)), encoding_(encoding), raw_(piece) {
  file_.reset(gzopen(path.c_str(), "rb"));
  if (!file_) throw InputError(fmt::format("{} cannot be read", source_));
  gzbuffer(file_.get(), 1 << 17);
}

void TextLines::decode(std::string_view bytes) {
  kept_ = 0;
  if (encoding_ == Encoding::utf8) {
    text_ += bytes;
    return;
  }
  if (encoding_ == Encoding::cp1252) {
    for (const char byte : bytes) {
      const auto c = static_cast<unsigned char>(byte);
      const std::uint32_t code = c >= 0x80 && c < 0xA0 ? cp1252_high[c - 0x80] : c;
      if (code == 0 && c != 0)
        throw InputError(
            fmt::format("{} is neither UTF-8 nor cp1252 (Windows): there is a byte {:#04x} after "
                        "line {}; save it as UTF-8",
                        source_, c, number));
      append_utf8(text_, code);
    }
    return;
  }
  const bool little = encoding_ == Encoding::utf16_le;
  const auto unit = [&](std::size_t i) -> std::uint32_t {
    const auto a = static_cast<unsigned char>(bytes[i]),
               b = static_cast<unsigned char>(bytes[i + 1]);
    return little ? a | b << 8 : a << 8 | b;
  };
  std::size_t i = 0;
  const auto refuse = [&] {
    throw InputError(
        fmt::format("{}: invalid UTF-16 after line {}; save it as UTF-8", source_, number));
  };
  for (; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (code >= 0xDC00 && code < 0xE000) refuse();
    if (code >= 0xD800 && code < 0xDC00) {
      if (i + 3 >= bytes.size()) break;
      const std::uint32_t low = unit(i + 2);
      if (low < 0xDC00 || low >= 0xE000) refuse();
      code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
      i += 2;
    }
    append_utf8(text_, code);
  }
  kept_ = bytes.size() - i;
  std::copy(bytes.end() - static_cast<std::ptrdiff_t>(kept_), bytes.end(), raw_.begin());
}

void TextLines::fill() {
  const int count =
      gzread(file_.get(), raw_.data() + kept_, static_cast<unsigned>(raw_.size() - kept_));
  if (count < 0) throw InputError(fmt::format("{} cannot be read completely", source_));
  if (count == 0) {
    if (kept_ > 0)
      throw InputError(fmt::format("{} is truncated within a UTF-16 character", source_));
    ended_ = true;
    return;
  }
  decode({raw_.data(), kept_ + static_cast<std::size_t>(count)});
  if (!started_ && text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  started_ = true;
}

bool TextLines::next(std::string_view& line) {
  for (;;) {
    const char* begin = text_.data() + at_;
    const std::size_t left = text_.size() - at_;
    if (const void* end = left ? std::memchr(begin, '\n', left) : nullptr) {
      line = {begin, static_cast<std::size_t>(static_cast<const char*>(end) - begin)};
      at_ += line.size() + 1;
      has_return = line.ends_with('\r');
      if (has_return) line.remove_suffix(1);
      ++number;
      return true;
    }
    if (left > longest_line)
      throw InputError(fmt::format("{}, line {}: the line exceeds the limit of {} MB", source_,
                                   number + 1, longest_line >> 20));
    if (ended_) {
      if (left == 0) return false;
      line = {begin, left};
      at_ = text_.size();
      ++number;
      last = true;
      return true;
    }
    text_.erase(0, at_);
    at_ = 0;
    fill();
  }
}

void TextLines::refuse_open_quote(std::size_t line) const {
  throw OpenQuote(fmt::format("{}, line {}: a quote is not closed", source_, line));
}

Encoding first_encoding(const std::string& path) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), &gzclose);
  std::array<char, 4096> bytes{};
  const int count = file ? gzread(file.get(), bytes.data(), bytes.size()) : 0;
  const std::string_view text(bytes.data(), static_cast<std::size_t>(std::max(count, 0)));
  if (text.starts_with("\xFF\xFE")) return Encoding::utf16_le;
  if (text.starts_with("\xFE\xFF")) return Encoding::utf16_be;
  // Every second byte of letters and digits is zero in UTF-16.
  std::array<std::size_t, 2> zeros{};
  for (std::size_t i = 0; i < text.size(); ++i) zeros[i % 2] += text[i] == '\0';
  const auto mostly = [&](std::size_t i) {
    return zeros[i] > text.size() / 4 && zeros[1 - i] * 8 < zeros[i];
  };
  if (mostly(1)) return Encoding::utf16_le;
  if (mostly(0)) return Encoding::utf16_be;
  return Encoding::utf8;
}

bool is_ascii(std::string_view text) {
  unsigned bits = 0;  // no early exit, so that the loop is vectorized
  for (const char c : text) bits |= static_cast<unsigned char>(c);
  return bits < 0x80;
}

bool is_utf8(std::string_view text) {
  return is_ascii(text) || valid_utf8(text) == text;
}

const char* encoding_name(Encoding encoding) {
  switch (encoding) {
    case Encoding::utf8:
      return "UTF-8";
    case Encoding::cp1252:
      return "cp1252";
    default:
      return "UTF-16";
  }
}

}  // namespace wearwell
