#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wearwell::bearing {

/// The worn part of a journal bearing (Ligterink and de Gee 1996).
enum class Contact {
  stationary,  ///< a scar in the bushing, cut out by the journal's circle
  journal,     ///< the journal, evenly all around: the load or the bushing turns
  bushing,     ///< the inside of a turning bushing, evenly all around
};

/// The contacts in the spelling of study files, in the order of the enumeration.
const std::vector<std::string>& contact_names();

const char* contact_name(Contact contact);

/// Empty for a word that is not in `contact_names`.
std::optional<Contact> contact_named(std::string_view name);

}  // namespace wearwell::bearing
