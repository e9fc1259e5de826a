#include "wearwell/cli/first_selection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/study/column_values.h"
#include "wearwell/study/heading_words.h"

namespace wearwell {
namespace {

// In the form that an option accepts: commas separate columns.
std::string name_for_option(const ColumnRoles& roles, const Column& column) {
  if (column.name.find(',') == column.name.npos) return column.name;
  std::string name = name_and_unit(column, "").name;
  name = name.substr(0, name.find(','));
  try {
    if (&roles.table().column(name) == &column) return name;
  } catch (const InputError&) {  // two columns have that name
  }
  return column.name;
}

}  // namespace

std::optional<Scaffold> first_selection(ColumnRoles& roles) {
  const bool stated = roles.has({"response"});
  const bool wear = roles.has({"depth", "volume", "mass", "measured"});
  const bool along = roles.has({"time", "cycles", "distance", "revolutions"});
  const auto unit = roles.find({"unit"});
  const bool of_units = unit && repeats(roles.table(), *unit->column);
  if (roles.has({"life", "status"}) || (of_units && !stated)) return {};
  std::optional<ColumnRoles::Found> response;
  if (stated) {
    response = roles.take("response", {"response"});
  } else if (wear) {
    response = roles.take("response", {"depth", "volume", "mass", "measured"});
  }
  const auto weights = roles.take("weights", {"count"});
  roles.pass_over("unit");
  std::vector<const Column*> inputs = roles.other_numbers();
  constexpr std::size_t fewest = 2;
  if (!response) {
    if (inputs.size() <= fewest) return {};
    TableQuestion question{fmt::format("Which column of {} is the response?", roles.file()), {}};
    for (const Column* each : inputs) {
      question.readings.push_back({fmt::format("'{}', with all others as inputs", each->name),
                                   {"--column", "response=" + each->name}});
    }
    roles.questions.push_back(std::move(question));
    return roles.study("a response with inputs", ReadingFit::possible, "");
  }
  const bool chosen = roles.choices().columns.contains("response");
  if (inputs.size() < (chosen ? 1 : fewest) || (!stated && along && inputs.size() <= fewest))
    return {};
  const std::size_t terms = (inputs.size() + 1) * (inputs.size() + 2) / 2;
  std::vector<std::string> names;
  for (const Column* each : inputs) {
    names.push_back(name_for_option(roles, *each));
    static_cast<void>(roles.take_column("input", *each, role_form("response")));
  }
  std::string text = fmt::format("--response {} --inputs {} --degree {} --force 1",
                                 shell_word(name_for_option(roles, *response->column)),
                                 shell_word(fmt::format("{}", fmt::join(names, ","))),
                                 3 * terms <= roles.table().rows ? 2 : 1);
  if (weights) text += " --weights " + shell_word(name_for_option(roles, *weights->column));
  roles.guesses.push_back(
      "terms are products of up to --degree inputs; the number of rows allows this degree");
  return roles.study("a response with inputs, and the products of inputs that explain it",
                     stated ? ReadingFit::specific : ReadingFit::general, std::move(text));
}

}  // namespace wearwell
