#pragma once

#include <string>

namespace wearwell::monitor {

/// A self-contained page; it requests nothing except from its own server.
struct ServedPage {
  std::string html;
  std::string policy;  ///< its Content-Security-Policy
  std::string tag;     ///< its ETag
};

/// The fleet and its units. `token`: whether the viewer has signed in, and may sign out.
ServedPage fleet_page(bool token);

/// Asks for the token, and reports a wrong one.
ServedPage login_page(bool wrong);

}  // namespace wearwell::monitor
