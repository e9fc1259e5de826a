#include "wearwell/models/clutch/point_goal.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/trimmed.h"
#include "wearwell/input/option_value.h"
#include "wearwell/models/clutch/clutch_tables.h"

namespace wearwell::clutch {
namespace {

constexpr const char* goal_example =
    "'wear rate at slip_speed = 1700 rpm, torque = 50 N m, temperature = 170 degC, closing_time = "
    "2.15 s' or 'life at ...'";

void read_goal_input(const std::string& part, PointGoal& goal, std::vector<std::string>& known) {
  const std::size_t sign = part.find('=');
  const std::string name(trimmed(std::string_view(part).substr(0, sign)));
  std::vector<std::string> names;
  for (const Input& input : inputs) {
    names.emplace_back(input.name);
    if (name != input.name || sign == part.npos) continue;
    if (std::find(known.begin(), known.end(), name) != known.end())
      throw InputError(fmt::format("--goal: {} is given twice", name));
    const std::string value(trimmed(std::string_view(part).substr(sign + 1)));
    const bool is_temperature = input.value == &OperatingPoint::temperature;
    const double si = option_value("--goal: " + name, value, input.si,
                                   is_temperature ? Allowed::any : Allowed::positive);
    goal.at.*input.value = is_temperature ? si - celsius_zero : si;
    goal.text += fmt::format("{}{} {}", goal.text.empty() ? "" : ", ", name, value);
    known.push_back(name);
    return;
  }
  throw InputError(fmt::format("--goal: '{}' is not one of {}, like 'torque = 50 N m'{}",
                               printable(part), fmt::join(names, ", "), did_you_mean(name, names)));
}

}  // namespace

PointGoal read_point_goal(const std::string& text) {
  std::string lower = text;
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  PointGoal goal;
  static constexpr std::string_view rate = "wear rate at ", life = "life at ";
  goal.is_life = lower.starts_with(life);
  if (!goal.is_life && !lower.starts_with(rate))
    throw InputError(fmt::format("--goal: '{}' is unknown; a clutch map predicts {}",
                                 printable(text), goal_example));
  std::string rest = text.substr((goal.is_life ? life : rate).size());
  std::replace(rest.begin(), rest.end(), ';', ',');
  std::vector<std::string> known;
  for (std::size_t begin = 0; begin <= rest.size();) {
    const std::size_t end = std::min(rest.find(',', begin), rest.size());
    read_goal_input(std::string(trimmed(std::string_view(rest).substr(begin, end - begin))), goal,
                    known);
    begin = end + 1;
  }
  for (const Input& input : inputs)
    if (std::find(known.begin(), known.end(), input.name) == known.end())
      throw InputError(
          fmt::format("--goal: {} is missing; a goal is like {}", input.name, goal_example));
  return goal;
}

}  // namespace wearwell::clutch
