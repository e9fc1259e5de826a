#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "wearwell/study/model.h"

namespace wearwell::workbench {

/// What `wearwell open` shows first: a table, a study or a folder of results; empty: the current
/// folder.
struct Opening {
  std::filesystem::path target = {};
  int port = 0;          ///< 0: any free one
  double idle_end = 60;  ///< s without an open page, after which it ends
};

/// Serves the page on loopback until it has been closed for a while. `ready` gets the address, with
/// the token in its fragment, once requests are answered. Throws InputError if the target is none of
/// the three, MachineError if no port is available.
void serve(const Opening& opening, Models models,
           const std::function<void(const std::string&)>& ready);

}  // namespace wearwell::workbench
