#pragma once

#include <string>

namespace wearwell::monitor {

/// A page with all that it needs inside; it fetches nothing but what its own server answers.
struct ServedPage {
  std::string html;
  std::string policy;  ///< its Content-Security-Policy
  std::string tag;     ///< its ETag
};

/// The fleet and its units. `token`: whether who looks at it has signed in, and may sign out.
ServedPage fleet_page(bool token);

/// Asks for the token, and says what is wrong with the one that was given.
ServedPage login_page(bool wrong);

}  // namespace wearwell::monitor
