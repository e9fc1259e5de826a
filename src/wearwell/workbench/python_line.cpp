#include "wearwell/workbench/python_line.h"

#include <fmt/format.h>

namespace wearwell::workbench {

std::string python_text(const std::string& text) {
  std::string out = "\"";
  for (const char each : text) {
    const auto code = static_cast<unsigned char>(each);
    if (each == '"' || each == '\\')
      out += fmt::format("\\{}", each);
    else if (code < 0x20 || code == 0x7f)
      out += fmt::format("\\x{:02x}", code);
    else
      out += each;
  }
  return out + "\"";
}

std::string python_question(const std::string& function, const std::string& folder,
                            const std::vector<std::pair<std::string, std::string>>& arguments) {
  std::string call = fmt::format("{}({}", function, python_text(folder));
  for (const auto& [name, value] : arguments)
    if (!value.empty()) call += fmt::format(", {}={}", name, python_text(value));
  return fmt::format("import wearwell as ww; print(ww.{}))", call);
}

}  // namespace wearwell::workbench
