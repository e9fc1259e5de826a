#include "wearwell/input/life_status.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <cctype>
#include <utility>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/input/columns.h"

namespace wearwell {

namespace {

using Words = std::vector<std::pair<std::string, Seen>>;

const Words& plain_words() {
  static const Words words = {{"failure", Seen::exactly}, {"F", Seen::exactly},
                              {"runout", Seen::above},    {"run-out", Seen::above},
                              {"right", Seen::above},     {"S", Seen::above},
                              {"left", Seen::below},      {"interval", Seen::between}};
  return words;
}

// Where a failure is 0, the code tells how a life is censored; where it is 1, whether it ended.
const Words& codes(int failure) {
  static const Words censored = {{"0", Seen::exactly},     {"1", Seen::above},
                                 {"false", Seen::exactly}, {"true", Seen::above},
                                 {"-1", Seen::below},      {"2", Seen::between}};
  static const Words ended = {{"1", Seen::exactly},   {"0", Seen::above}, {"true", Seen::exactly},
                              {"false", Seen::above}, {"2", Seen::below}, {"3", Seen::between}};
  return failure == 0 ? censored : ended;
}

std::optional<Seen> find(const Words& words, const std::string& word) {
  for (const auto& [name, seen] : words) {
    if (word == name) return seen;
  }
  return {};
}

// Truth values in any letters: "True", as Python writes them.
std::optional<Seen> find_code(int failure, const std::string& word) {
  return find(codes(failure), boost::algorithm::to_lower_copy(word));
}

bool is_code(const std::string& word) {
  return find_code(0, word) || find_code(1, word);
}

}  // namespace

std::string letters_of(const std::string& heading) {
  std::string lower;
  for (const char each : heading) {
    if (std::isalpha(static_cast<unsigned char>(each)))
      lower += static_cast<char>(std::tolower(static_cast<unsigned char>(each)));
  }
  return lower;
}

std::optional<int> failure_code_of(const std::string& heading) {
  const std::string lower = letters_of(heading);
  const auto says = [&](std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(),
                       [&](const char* each) { return lower.find(each) != lower.npos; });
  };
  const bool of_censoring = says({"cens", "runout", "suspen", "surviv"});
  const bool of_event = says({"event", "fail", "broke", "dead", "death", "died"});
  if (of_censoring == of_event) return {};
  return of_censoring ? 0 : 1;
}

std::optional<LifeStatus> read_life_status(const TomlReader& columns, const Table& table) {
  const auto chosen = read_word_column(columns, "status", table);
  if (!chosen) return {};
  LifeStatus status{chosen->column};
  const Column& column = table.column(status.column);
  const bool in_table = !columns.is_text("status");
  if (const auto said =
          in_table ? columns.required_table("status").integer("failure", 0, 1) : std::nullopt) {
    status.failure_code = static_cast<int>(*said);
    return status;
  }
  for (std::size_t i = 0; i < table.rows; ++i) {
    if (const std::string word = cell_word(column, i); is_code(word)) {
      status.failure_code = failure_code_of(status.column);
      if (status.failure_code) return status;
      columns.fail(
          "status",
          fmt::format("{}: {} can be read two ways: 0 a failure and 1 a runout (\"censored\"), or "
                      "1 a failure and 0 a runout (\"event\"); write status = "
                      "{{ column = \"{}\", failure = 0 }} or failure = 1, or words",
                      place(table, status.column, i), word, status.column));
    }
  }
  return status;
}

Seen seen_in(const Table& table, const LifeStatus& status, std::size_t row) {
  const std::string word = cell_word(table.column(status.column), row);
  if (const auto seen = find(plain_words(), word)) return *seen;
  if (status.failure_code) {
    if (const auto seen = find_code(*status.failure_code, word)) return *seen;
  }
  const std::vector<std::string> names = {"failure", "runout", "left", "interval"};
  throw InputError(fmt::format(
      "{}: '{}' is no status; it is failure, runout (or right), left or interval (or F, S{}) "
      "(nearest: '{}')",
      place(table, status.column, row), word,
      !status.failure_code        ? "; or codes"
      : *status.failure_code == 0 ? "; or the codes 0 failure, 1 runout, -1 left, 2 interval"
                                  : "; or the codes 1 failure, 0 runout, 2 left, 3 interval",
      nearest_name(word, names)));
}

}  // namespace wearwell
