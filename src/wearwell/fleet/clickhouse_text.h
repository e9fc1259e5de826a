#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace wearwell::fleet {

/// Longer errors are truncated.
inline constexpr std::size_t most_said = 1 << 16;

/// The error message of a ClickHouse server: "Code: 60, e.displayText() = DB::Exception: Table
/// default.x doesn't exist., e.what() = DB::Exception", in current versions "Code: 60.
/// DB::Exception: Table default.x does not exist. (UNKNOWN_TABLE) (version 24.8)". 0 if it has no
/// code.
int error_code(std::string_view said);
/// For messages, on one line; followed by the cause from another server.
std::string error_sentence(std::string_view said);

/// The statements of a text, which the HTTP interface takes one by one; quoted texts and names may
/// contain semicolons.
std::vector<std::string> single_statements(std::string_view text);

/// Rows in the format TabSeparated, as their bytes arrive.
class SeparatedText {
 public:
  void add(std::string_view piece,
           const std::function<void(const std::vector<std::string>&)>& take);
  /// Whether the last row is complete.
  bool at_end() const { return rest_.empty(); }

 private:
  std::string rest_;
  std::vector<std::string> cells_;
};

/// NaN for an empty cell. Throws InputError for text that is not a number.
double separated_number(const std::string& cell);

}  // namespace wearwell::fleet
