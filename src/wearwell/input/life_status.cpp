#include "wearwell/input/life_status.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/status_words.h"

namespace wearwell {

namespace {

// With failure = 0 the code states how a life is censored; with failure = 1, whether it ended.
std::optional<Censoring> find_code(int failure, const std::string& word) {
  if (const auto truth = truth_in(word))
    return *truth == (failure == 1) ? Censoring::none : Censoring::right;
  const char *left = failure == 0 ? "-1" : "2", *interval = failure == 0 ? "2" : "3";
  if (word == left) return Censoring::left;
  if (word == interval) return Censoring::interval;
  return {};
}

bool is_code(const std::string& word) {
  return find_code(0, word) || find_code(1, word);
}

std::optional<Censoring> find_own(const LifeStatus& status, const std::string& word) {
  const std::string folded = folded_word(word);
  for (const auto& [name, seen] : status.words) {
    if (folded == name) return seen;
  }
  return {};
}

// The study's words for each status.
void add_own_words(const TomlReader& choice, LifeStatus& status) {
  const std::pair<const char*, Censoring> ends[] = {{"failure", Censoring::none},
                                                    {"runout", Censoring::right},
                                                    {"left", Censoring::left},
                                                    {"interval", Censoring::interval}};
  for (const auto& [key, seen] : ends) {
    if (choice.is_integer(key)) continue;
    for (const std::string& word : choice.texts(key)) {
      if (const auto before = find_own(status, word); before && before != seen)
        choice.fail(key, fmt::format("'{}' is given for two statuses", word));
      status.words.emplace_back(folded_word(word), seen);
    }
  }
}

}  // namespace

std::string letters_of(const std::string& heading) {
  std::string letters = folded_word(heading);
  std::erase_if(letters, [](unsigned char c) { return c >= 0x80 || !std::isalpha(c); });
  return letters;
}

std::optional<int> failure_code_of(const std::string& heading) {
  const std::string lower = letters_of(heading);
  const auto says = [&](std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(),
                       [&](const char* each) { return lower.find(each) != lower.npos; });
  };
  const bool of_censoring =
      says({"cens", "zensier", "runout", "suspen", "surviv", "durchlauf", "uberleb", "ueberleb"});
  const bool of_event =
      says({"event", "evenement", "ereignis", "fail", "broke", "dead", "death", "died", "ausfall",
            "ausgefallen", "bruch", "defekt", "defaill", "rupture", "rotura", "fallo"});
  if (of_censoring == of_event) return {};
  return of_censoring ? 0 : 1;
}

std::optional<LifeStatus> read_life_status(const TomlReader& columns, const Table& table) {
  const auto chosen = read_word_column(columns, "status", table);
  if (!chosen) return {};
  LifeStatus status{chosen->column};
  const Column& column = table.column(status.column);
  if (!columns.is_text("status")) {
    const TomlReader choice = columns.required_table("status");
    if (choice.is_integer("failure"))
      status.failure_code = static_cast<int>(*choice.integer("failure", 0, 1));
    add_own_words(choice, status);
    if (status.failure_code) return status;
  }
  for (std::size_t i = 0; i < table.rows; ++i) {
    if (const std::string word = cell_word(column, i); is_code(word) && !find_own(status, word)) {
      status.failure_code = failure_code_of(status.column);
      if (status.failure_code) return status;
      columns.fail(
          "status",
          fmt::format("{}: {} is ambiguous: either 0 is a failure and 1 a runout (\"censored\"), "
                      "or 1 is a failure and 0 a runout (\"event\"); write status = {{ column = "
                      "\"{}\", failure = 0 }} or failure = 1, or use words",
                      place(table, status.column, i), word, status.column));
    }
  }
  return status;
}

Censoring seen_in(const Table& table, const LifeStatus& status, std::size_t row) {
  const std::string word = cell_word(table.column(status.column), row);
  if (const auto seen = find_own(status, word)) return *seen;
  if (const auto seen = censoring_by_word(word)) return *seen;
  if (status.failure_code) {
    if (const auto seen = find_code(*status.failure_code, word)) return *seen;
  }
  if (word.empty())
    throw InputError(
        fmt::format("{}: no value; state how this test ended", place(table, status.column, row)));
  const auto near = near_status_word(word);
  throw InputError(fmt::format(
      "{}: '{}' is not a status; use failure, runout (or right), left or interval (or F, S{}){}; "
      "or define your own word in the study: status = {{ column = \"{}\", failure = \"{}\" }}, or "
      "runout, left or interval = \"{}\"",
      place(table, status.column, row), word,
      !status.failure_code        ? "; or codes"
      : *status.failure_code == 0 ? "; or the codes 0 failure, 1 runout, -1 left, 2 interval"
                                  : "; or the codes 1 failure, 0 runout, 2 left, 3 interval",
      near ? fmt::format(" (nearest: '{}')", *near) : "", status.column, word, word));
}

}  // namespace wearwell
