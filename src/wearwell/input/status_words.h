#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "wearwell/prob/response.h"

namespace wearwell {

/// A word in normalized form: lower-case letters and digits, without accents, blanks and
/// punctuation ("Läufer" becomes "laufer", "Run-Out" becomes "runout"). A word of other characters
/// only is unchanged.
std::string folded_word(std::string_view word);

/// The status that a word of a table means ("failed", "S", "Durchläufer", "censuré"), in English,
/// German, French and Spanish; empty for other words and for codes.
std::optional<Censoring> censoring_by_word(std::string_view word);

/// The nearest known word; empty if none is near.
std::optional<std::string> near_status_word(std::string_view word);

/// The word for a run-out that this one is probably meant to be, misspelt ("still runing"): one edit
/// from a word of six letters or more, two from one of ten. Empty for a known word, and for others.
std::optional<std::string> misspelt_runout(std::string_view word);

/// Whether a word means a failure without saying how the part failed ("failed", "Ausfall"), unlike
/// "crack".
bool is_failure_of_no_mode(std::string_view word);

/// The truth value of a word ("1", "True", "yes", "WAHR", "oui"); empty for other words.
std::optional<bool> truth_in(std::string_view word);

}  // namespace wearwell
