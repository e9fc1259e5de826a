#include "wearwell/cli/table_question.h"

#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <cstdio>
#include <iostream>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell {

bool is_somebody_there() {
  return isatty(STDIN_FILENO) == 1 && isatty(STDOUT_FILENO) == 1;
}

std::size_t read_choice(const TableQuestion& question) {
  fmt::print("{}\n", printable(question.text));
  for (std::size_t i = 0; i < question.readings.size(); ++i)
    fmt::print("  {}  {}\n", i + 1, printable(question.readings[i].text));
  std::string line;
  for (;;) {
    fmt::print("1 to {}: ", question.readings.size());
    std::fflush(stdout);
    if (!std::getline(std::cin, line)) throw InputError(question.text + " No answer came");
    std::size_t number = 0;
    const auto [end, failure] = std::from_chars(line.data(), line.data() + line.size(), number);
    if (failure == std::errc{} && end == line.data() + line.size() && number >= 1 &&
        number <= question.readings.size())
      return number - 1;
  }
}

std::string as_refusal(const TableQuestion& question, const std::vector<std::string>& commands) {
  std::string text = question.text + " Run the right one:";
  for (std::size_t i = 0; i < question.readings.size(); ++i)
    text += fmt::format("\n  {}\n      {}", question.readings[i].text, commands[i]);
  return text;
}

}  // namespace wearwell
