#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "wearwell/prob/response.h"

namespace wearwell {

/// A word as it is compared: small letters and digits, without accents, blanks and punctuation ("Läufer",
/// "laufer"; "Run-Out", "runout"). A word of nothing but other signs stays as it is.
std::string folded_word(std::string_view word);

/// What a word of a table says of how a test ended ("failed", "S", "Durchläufer", "censuré"), in
/// English, German, French and Spanish; nothing where it says nothing of that, or is a code.
std::optional<Censoring> censoring_by_word(std::string_view word);

/// The word of that list that was probably meant; nothing where none is near.
std::optional<std::string> near_status_word(std::string_view word);

/// Of a word of truth ("1", "True", "yes", "WAHR", "oui") whether it is true; nothing of other words.
std::optional<bool> truth_in(std::string_view word);

}  // namespace wearwell
