#include "wearwell/input/duckdb_closing.h"

#include <exception>
#include <system_error>
#include <thread>

namespace wearwell {

void close_duckdb(const std::function<void()>& disconnect) {
  if (std::uncaught_exceptions() == 0) {
    disconnect();
    return;
  }
  try {
    std::thread(disconnect).join();
  } catch (const std::system_error&) {
  }
}

}  // namespace wearwell
