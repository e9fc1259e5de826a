#include "wearwell/present/terminal_style.h"

#include <langinfo.h>
#include <unistd.h>

#include <clocale>
#include <cstdlib>
#include <cstring>
#include <string>

namespace wearwell {

TerminalStyle terminal_style() {
  if (!isatty(STDOUT_FILENO)) return {};
  const char* no_colour = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  const bool dumb = !terminal || std::strcmp(terminal, "dumb") == 0;
  const char* before = std::setlocale(LC_CTYPE, nullptr);
  const std::string kept = before ? before : "C";
  std::setlocale(LC_CTYPE, "");
  const bool utf8 = std::strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
  std::setlocale(LC_CTYPE, kept.c_str());
  return {!(no_colour && *no_colour) && !dumb, utf8};
}

}  // namespace wearwell
