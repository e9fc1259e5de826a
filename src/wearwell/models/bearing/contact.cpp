#include "wearwell/models/bearing/contact.h"

#include <algorithm>

namespace wearwell::bearing {

const std::vector<std::string>& contact_names() {
  static const std::vector<std::string> names = {"stationary", "journal", "bushing"};
  return names;
}

const char* contact_name(Contact contact) {
  return contact_names()[static_cast<std::size_t>(contact)].c_str();
}

std::optional<Contact> contact_named(std::string_view name) {
  const auto& names = contact_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return {};
  return static_cast<Contact>(found - names.begin());
}

}  // namespace wearwell::bearing
