#include "wearwell/formula/complaint.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell::formula {
namespace {

constexpr std::size_t widest = 76;  // of an excerpt

bool begins_character(char c) {
  return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
}

std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), begins_character));
}

}  // namespace

void complain(const Text& text, std::size_t at, const std::string& what, const std::string& hint) {
  const std::string& all = text.text;
  at = std::min(at, all.size());
  const std::size_t newline = at == 0 ? all.npos : all.rfind('\n', at - 1);
  std::size_t start = newline == all.npos ? 0 : newline + 1;
  std::size_t end = std::min(all.find('\n', at), all.size());
  const bool cut_left = at - start > widest / 2 && end - start > widest;
  if (cut_left) start = at - widest / 2;
  while (start > 0 && start < at && !begins_character(all[start])) ++start;
  const bool cut_right = end - start > widest;
  if (cut_right) end = start + widest;
  while (end > at && end < all.size() && !begins_character(all[end])) --end;
  const std::string before = (cut_left ? "..." : "") + printable(all.substr(start, at - start));
  const std::string behind = printable(all.substr(at, end - at)) + (cut_right ? "..." : "");
  throw InputError(fmt::format("{}: {}{}{}\n    {}{}\n    {}^", text.where, what,
                               hint.empty() ? "" : "; ", hint, before, behind,
                               std::string(width(before), ' ')));
}

}  // namespace wearwell::formula
