#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wearwell::embed {

/// The arguments of a question about tests or inspections to come, by name: a JSON object. Null is
/// not given. Each reader throws InputError that names the argument and says what is allowed.
class PlanArguments {
 public:
  /// `function` is the question's name in messages: "demonstrate".
  PlanArguments(std::string function, const nlohmann::ordered_json& arguments);

  /// A text; a number is written so that it reads back to the same. Unchanged if not given.
  void text(const char* name, std::string& to);
  /// One text or number, or several. An object {"force": "20 N"} is "force = 20 N".
  void texts(const char* name, std::vector<std::string>& to);
  /// Numbers or texts as "1, 3, 5".
  void list(const char* name, std::string& to);
  /// A text, or an object of such lists: {"stress": "200 to 500 by 25 MPa", "stop": [1e6, 5e6]} is
  /// "stress = 200 to 500 by 25 MPa; stop = 1000000, 5000000".
  void clauses(const char* name, std::string& to);
  /// Texts by their names, in their order.
  void named_texts(const char* name, std::vector<std::pair<std::string, std::string>>& to);
  /// One number or several.
  void numbers(const char* name, std::vector<double>& to);
  void number(const char* name, double& to);
  void number(const char* name, std::optional<double>& to);
  /// A whole number that is not negative; the other one is from `least` to `most`.
  template <class Whole>
  void whole(const char* name, Whole& to) {
    if (const auto value = whole_of(name, 0, most_whole)) to = static_cast<Whole>(*value);
  }
  template <class Whole>
  void whole(const char* name, std::optional<Whole>& to) {
    if (const auto value = whole_of(name, 0, most_whole)) to = static_cast<Whole>(*value);
  }
  void whole(const char* name, std::size_t& to, std::size_t least, std::size_t most) {
    if (const auto value = whole_of(name, least, most)) to = *value;
  }
  void truth(const char* name, bool& to);
  /// A number, or its digits: not every language has whole numbers of 64 bits.
  void seed(const char* name, std::uint64_t& to);
  /// An argument that only holds tables.
  void table(const char* name) { find(name); }

  /// Throws InputError if there is an argument that none of the above has asked for.
  void finish() const;

  /// A message or a text of the command line for callers of the function: options ("--total-risk")
  /// become arguments ("total_risk"). Needs all arguments to have been read.
  std::string in_arguments(const std::string& text) const;
  /// The option that an argument has on the command line, where it is not its name with hyphens.
  void call_option(const std::string& option, const std::string& argument);

 private:
  static constexpr std::size_t most_whole = 2'147'483'647;  // of an int

  const nlohmann::ordered_json* find(const char* name);
  std::optional<std::size_t> whole_of(const char* name, std::size_t least, std::size_t most);
  std::string one_text(const char* name, const nlohmann::ordered_json& value) const;
  std::string listed(const char* name, const nlohmann::ordered_json& value) const;

  std::string function_;
  const nlohmann::ordered_json& arguments_;
  std::vector<std::string> known_ = {};
  std::vector<std::pair<std::string, std::string>> options_ = {};  // "--total-risk", "total_risk"
};

}  // namespace wearwell::embed
