#include "wearwell/base/nearest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <tuple>

namespace wearwell {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

// Optimal string alignment: Levenshtein edits and transposition of neighbours.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      row[j + 1] = std::min({last[j] + (a[i] != b[j]), last[j + 1] + 1, row[j] + 1});
      if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j])
        row[j + 1] = std::min(row[j + 1], before[j - 1] + 1);
    }
    before = last;
    last = row;
  }
  return last.back();
}

// Whether `word` is one of the words of "archard-joint" or "log10_a".
bool has_word(std::string_view name, std::string_view word) {
  const auto apart = [&](std::size_t i) {
    return i >= name.size() || !std::isalnum(static_cast<unsigned char>(name[i]));
  };
  for (std::size_t at = name.find(word); at != name.npos; at = name.find(word, at + 1)) {
    if ((at == 0 || apart(at - 1)) && apart(at + word.size())) return true;
  }
  return false;
}

// In half edits.
std::size_t distance(std::string_view name, std::string_view candidate) {
  const std::string a = lower(name), b = lower(candidate);
  constexpr std::size_t a_word = 3, shortest = 3;
  const std::size_t slips = 2 * edits(a, b);
  const bool word =
      (a.size() >= shortest && has_word(b, a)) || (b.size() >= shortest && has_word(a, b));
  return word ? std::min(slips, a_word) : slips;
}

}  // namespace

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
  const auto rank = [&](const std::string& candidate) {
    return std::make_tuple(distance(name, candidate), edits(name, candidate));
  };
  return *std::min_element(candidates.begin(), candidates.end(),
                           [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
}

std::optional<std::string> near_name(std::string_view name,
                                     const std::vector<std::string>& candidates) {
  if (candidates.empty()) return {};
  std::string nearest = nearest_name(name, candidates);
  const std::size_t most = std::min<std::size_t>(4, std::max<std::size_t>(2, name.size()));
  if (distance(name, nearest) > most) return {};
  return nearest;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates) {
  const auto near = near_name(name, candidates);
  return near ? fmt::format("; did you mean '{}'?", *near) : "";
}

}  // namespace wearwell
