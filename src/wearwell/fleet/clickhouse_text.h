#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace wearwell::fleet {

/// More of an error is not kept.
inline constexpr std::size_t most_said = 1 << 16;

/// What a server of ClickHouse says of an error: "Code: 60, e.displayText() = DB::Exception: Table default.x doesn't exist., e.what()
/// = DB::Exception", today "Code: 60. DB::Exception: Table default.x does not exist. (UNKNOWN_TABLE) (version 24.8)". 0 where no code
/// stands there.
int error_code(std::string_view said);
/// For people, on one line; behind it the cause that another server gave.
std::string error_sentence(std::string_view said);

/// The statements of a text, which its HTTP interface takes one by one; quoted texts and names may hold semicolons.
std::vector<std::string> single_statements(std::string_view text);

/// Rows of its format TabSeparated, as their bytes arrive.
class SeparatedText {
 public:
  void add(std::string_view piece,
           const std::function<void(const std::vector<std::string>&)>& take);
  /// The last row was whole.
  bool at_end() const { return rest_.empty(); }

 private:
  std::string rest_;
  std::vector<std::string> cells_;
};

/// NaN for nothing (an empty cell). Throws InputError for what is no number.
double separated_number(const std::string& cell);

}  // namespace wearwell::fleet
