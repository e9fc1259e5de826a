#include "wearwell/models/recurrence/event_words.h"

#include <fmt/format.h>

#include "wearwell/base/contains.h"
#include "wearwell/base/error.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/life_status.h"
#include "wearwell/input/status_words.h"

namespace wearwell::recurrence {
namespace {

std::optional<bool> is_failure(const EventWords& words, const std::string& word) {
  const std::string folded = folded_word(word);
  if (contains(words.failures, folded)) return true;
  if (contains(words.ends, folded)) return false;
  return is_failure_word(word, words.failure_code);
}

}  // namespace

EventWords read_event_words(const TomlReader& columns, const Table& table) {
  const auto chosen = read_word_column(columns, "event", table);
  if (!chosen) columns.fail("event", "is missing: the column of failures and ends of observation");
  EventWords words{chosen->column, failure_code_of(chosen->column)};
  if (columns.is_text("event")) return words;
  const TomlReader choice = columns.required_table("event");
  if (choice.is_integer("failure"))
    words.failure_code = static_cast<int>(*choice.integer("failure", 0, 1));
  else
    for (const std::string& each : choice.texts("failure"))
      words.failures.push_back(folded_word(each));
  for (const std::string& each : choice.texts("end")) words.ends.push_back(folded_word(each));
  return words;
}

bool read_event(const Table& table, const EventWords& words, std::size_t row) {
  const std::string word = cell_word(table.column(words.column), row);
  if (const auto failed = is_failure(words, word)) return *failed;
  const std::string where = place(table, words.column, row);
  if (word.empty())
    throw InputError(
        fmt::format("{}: no value; write failure, or end for the end of observation", where));
  if (truth_in(word))
    throw InputError(
        fmt::format("{}: {} is ambiguous: either 1 is a failure and 0 the end of observation, or 0 "
                    "is a failure; write event = "
                    "{{ column = \"{}\", failure = 1 }} or failure = 0",
                    where, word, words.column));
  throw InputError(
      fmt::format("{}: '{}' is not an event; use failure, or end for the end of observation; or "
                  "define your own word in "
                  "the study: event = {{ column = \"{}\", failure = \"{}\" }}, or end = \"{}\"",
                  where, word, words.column, word, word));
}

// Nelson (1995) and SAS code a failure as 1 and the end as -1; R's Surv codes the end as 0.
std::optional<bool> is_failure_word(const std::string& word, std::optional<int> failure_code) {
  if (word == "-1") return false;
  if (const auto truth = truth_in(word)) {
    if (!failure_code) return {};
    return *truth == (*failure_code == 1);
  }
  const std::string folded = folded_word(word);
  for (const char* each : {"end", "ende", "fin", "endofobservation", "endofhistory", "now"}) {
    if (folded == each) return false;
  }
  for (const char* each : {"repair", "repaired", "reparatur", "replacement"}) {
    if (folded == each) return true;
  }
  const auto seen = censoring_by_word(word);
  if (seen == Censoring::none) return true;
  if (seen == Censoring::right) return false;
  return {};
}

}  // namespace wearwell::recurrence
