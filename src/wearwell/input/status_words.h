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

/// The truth value of a word ("1", "True", "yes", "WAHR", "oui"); empty for other words.
std::optional<bool> truth_in(std::string_view word);

}  // namespace wearwell
