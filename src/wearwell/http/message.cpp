#include "wearwell/http/message.h"

#include <fmt/format.h>

#include "wearwell/base/printable.h"

namespace wearwell {

HttpResponse refusal(unsigned status, const std::string& problem) {
  // Quoted as JSON by hand: after `printable` only quotes and backslashes need escapes.
  std::string text;
  for (const char each : printable(problem)) {
    if (each == '"' || each == '\\') text += '\\';
    text += each;
  }
  return {status, "application/json", fmt::format("{{\"error\":\"{}\"}}\n", text)};
}

}  // namespace wearwell
