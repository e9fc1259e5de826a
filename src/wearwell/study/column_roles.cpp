#include "wearwell/study/column_roles.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string_view>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/unit.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/input/columns.h"
#include "wearwell/study/column_values.h"
#include "wearwell/study/heading_words.h"
#include "wearwell/study/table_scope.h"

// Longer than others: one pass over the columns, each role with its questions and its reasons.
namespace wearwell {
namespace {

std::string dimension_of(const RoleForm& form, const std::string& unit) {
  for (const std::string_view si : form.si) {
    if (is_unit_of(unit, si)) return std::string(si);
  }
  return "";
}

// The unit in a dimension that the role allows; `si` is tried first and becomes the unit's
// dimension.
NameAndUnit name_and_unit(const Column& column, const RoleForm& form, std::string& si) {
  NameAndUnit heading = name_and_unit(column, si);
  for (const std::string_view each : form.si) {
    if (!heading.unit.empty()) break;
    if (NameAndUnit other = name_and_unit(column, each); !other.unit.empty()) {
      heading = std::move(other);
      si = each;
    }
  }
  return heading;
}

bool may_be_of(const RoleForm& form, const std::string& unit) {
  if (unit.empty() || form.si.empty()) return true;
  // "life (N)" counts cycles.
  const bool counts =
      std::find(form.si.begin(), form.si.end(), std::string_view("cycle")) != form.si.end();
  if (counts && unit == "N") return true;
  if (form.name == "temperature" && (unit == "C" || unit == "F" || unit == "°F")) return true;
  return !dimension_of(form, unit).empty();
}

bool has_cell(const Table& table, const Column& column) {
  for (std::size_t row = 0; row < table.rows; ++row) {
    if (!cell_word(column, row).empty()) return true;
  }
  return false;
}

// Whether a present value is as asked; the first one decides, as tables can have millions of rows.
bool has_value(const Table& table, const Column& column, const std::function<bool(double)>& is) {
  if (!column.doubt.empty()) return false;
  const std::shared_ptr<const std::vector<double>> read =
      column.is_number ? nullptr : shared_numbers(table, column);
  const std::vector<double>& values = column.is_number ? column.numbers : *read;
  return std::any_of(values.begin(), values.end(),
                     [&](double value) { return std::isfinite(value) && is(value); });
}

// Whether a heading has a small m where M would be a million: "mcycles" may mean millions, or not.
bool would_be_millions(const std::string& heading, const std::string& unit, const RoleForm& role,
                       std::size_t word) {
  const std::string_view of = role.words.empty() ? std::string_view() : role.words[word].text;
  for (std::size_t at = heading.find('m'); at != heading.npos; at = heading.find('m', at + 1)) {
    std::string capital = heading;
    capital[at] = 'M';
    if (with_multiple(capital, unit, of) != with_multiple(heading, unit, of)) return true;
  }
  return false;
}

// A life can be in several dimensions, or a plain number; it has none that its heading contradicts.
void refuse_other_dimension(const std::string& file, const Column& column, const RoleForm& role) {
  const std::string unit = stated_unit(column);
  if (role.si.size() < 2 || unit.empty() || unit == "1" || may_be_of(role, unit)) return;
  throw InputError(fmt::format("{}: column '{}': unit '{}' does not fit {}, which is in {}", file,
                               column.name, unit, role.name, fmt::join(role.si, ", ")));
}

}  // namespace

ColumnRoles::ColumnRoles(const Table& table, std::string file, const TableChoices& choices,
                         bool preset_named)
    : table_(table), file_(std::move(file)), choices_(choices), preset_named_(preset_named) {}

bool ColumnRoles::is_free(const Column& column) const {
  if (std::find(used_.begin(), used_.end(), &column) != used_.end()) return false;
  const auto is_this = [&](const std::string& heading) {
    return !heading.empty() && &table_.column(heading) == &column;
  };
  if (std::any_of(choices_.unused.begin(), choices_.unused.end(), is_this)) return false;
  return std::none_of(choices_.columns.begin(), choices_.columns.end(),
                      [&](const auto& each) { return is_this(each.second); });
}

bool ColumnRoles::holds(const Column& column, Cells cells) const {
  if (cells == Cells::names)
    return has_cell(table_, column) &&
           !has_value(table_, column, [](double each) { return each != std::floor(each); });
  if (cells == Cells::any) return has_cell(table_, column);
  return !column.doubt.empty() || has_value(table_, column, [](double) { return true; });
}

const Column* ColumnRoles::chosen(std::string_view role) const {
  const auto found = choices_.columns.find(std::string(role));
  if (found == choices_.columns.end() || found->second.empty()) return nullptr;
  return &table_.column(found->second);
}

bool ColumnRoles::is_of_longer_word(const Column& column, const RoleForm& form,
                                    std::string_view word) const {
  const std::string wanted = plain_words(word);
  const std::string_view bare = std::string_view(wanted).substr(1, wanted.size() - 2);
  const std::string unit = stated_unit(column);
  for (const RoleForm& other : role_forms()) {
    if (other.name == form.name || !may_be_of(other, unit)) continue;
    for (const RoleWord& each : other.words) {
      const std::string longer = plain_words(each.text);
      if (longer.size() <= wanted.size() || longer.find(bare) == longer.npos) continue;
      for (const std::string_view si : other.si) {
        if (is_called(name_and_unit(column, si).name, each.text)) return true;
      }
      if (other.si.empty() && is_called(name_and_unit(column, "").name, each.text)) return true;
    }
  }
  return false;
}

std::optional<ColumnRoles::Match> ColumnRoles::match(const Column& column, const RoleForm& form,
                                                     bool any_dimension) const {
  if (!any_dimension && !may_be_of(form, stated_unit(column))) return {};
  const std::string stated = stated_unit(column);
  std::string si = dimension_of(form, stated);
  if (si.empty() && !form.si.empty()) si = form.si.front();
  const NameAndUnit heading = name_and_unit(column, form, si);
  for (std::size_t i = 0; i < form.words.size(); ++i) {
    const RoleWord& word = form.words[i];
    // "operating hours" names its unit, so the whole word is compared.
    const bool says_unit = !word.unit.empty() && column.unit.empty() &&
                           bracketed(column.name).empty() && is_called(column.name, word.text);
    if (!says_unit && !is_called(heading.name, word.text)) continue;
    if (is_of_longer_word(column, form, word.text)) return {};
    Match match;
    match.found = {&column, &form, si, heading.unit, false};
    if (!word.unit.empty() && (says_unit || heading.unit.empty())) {
      match.found.unit = word.unit;
      const std::string of_word = dimension_of(form, match.found.unit);
      if (!of_word.empty()) match.found.si = of_word;
    } else if (heading.unit.empty()) {
      match.found.unit = form.usual;
      match.found.unit_guessed = !form.si.empty() && !may_be_plain(si);
    }
    const bool states_unit = !column.unit.empty() || is_unit_of(bracketed(column.name), "");
    const bool has_dimension = !form.si.empty() && form.name != "count";
    if (has_dimension && (may_be_plain(match.found.si) || !states_unit))
      match.found.unit = with_multiple(column.name, match.found.unit, word.text);
    match.word = i;
    match.whole = is_exactly(heading.name, word.text);
    match.letter = heading.letter;
    return match;
  }
  return {};
}

std::optional<ColumnRoles::Match> ColumnRoles::match_by_unit(const Column& column,
                                                             const RoleForm& form) const {
  if (form.largest_unit == 0) return {};
  const std::string si(form.si.front());
  const NameAndUnit heading = name_and_unit(column, si);
  if (heading.unit.empty() || heading.unit == "1" || !is_unit_of(heading.unit, si)) return {};
  const double scale = read_unit(heading.unit, si).scale;
  if (scale < form.least_unit || scale > form.largest_unit) return {};
  for (const RoleForm& other : role_forms()) {
    if (match(column, other, false)) return {};
  }
  Match found;
  found.found = {&column, &form, si, heading.unit, false};
  if (may_be_plain(si)) found.found.unit = with_multiple(column.name, heading.unit, "");
  found.by_unit = true;
  return found;
}

std::vector<ColumnRoles::Match> ColumnRoles::matches(const RoleForm& form) const {
  std::vector<Match> found;
  const auto look = [&](bool any_dimension) {
    for (const Column& column : table_.columns) {
      if (!is_free(column) || !holds(column, form.cells)) continue;
      if (auto each = match(column, form, any_dimension)) found.push_back(*each);
    }
  };
  look(false);
  if (found.empty()) {
    for (const Column& column : table_.columns) {
      if (!is_free(column) || !holds(column, form.cells)) continue;
      if (auto each = match_by_unit(column, form)) found.push_back(*each);
    }
  }
  if (found.empty() && preset_named_) look(true);
  const auto rank = [](const Match& each) { return std::pair(each.word, !each.whole); };
  std::stable_sort(found.begin(), found.end(),
                   [&](const Match& a, const Match& b) { return rank(a) < rank(b); });
  return found;
}

ColumnRoles::Found ColumnRoles::take_column(const std::string& key, const Column& column,
                                            const RoleForm& role) {
  Match match;
  if (auto by_word = this->match(column, role, true)) {
    match = *by_word;
  } else {
    std::string si = role.si.empty() ? "" : std::string(role.si.front());
    const NameAndUnit heading = name_and_unit(column, role, si);
    match.found = {&column, &role, si, heading.unit, false};
    match.letter = heading.letter;
    if (heading.unit.empty()) {
      match.found.unit = role.usual;
      match.found.unit_guessed = !role.si.empty() && !may_be_plain(si);
    }
    // "khours" and "Mcycles" say their unit in the words of another role.
    for (const RoleForm& other : role_forms()) {
      if (!match.found.column->unit.empty() || !heading.unit.empty()) break;
      const auto named = this->match(column, other, false);
      if (!named || other.cells != Cells::numbers || named->found.unit_guessed) continue;
      if (std::find(role.si.begin(), role.si.end(), named->found.si) == role.si.end()) continue;
      match.found.unit = named->found.unit;
      match.found.si = named->found.si;
      match.found.unit_guessed = false;
      break;
    }
    if (may_be_plain(match.found.si))
      match.found.unit = with_multiple(column.name, match.found.unit, "");
  }
  return record(key, match);
}

std::optional<ColumnRoles::Found> ColumnRoles::find(Roles roles) const {
  for (const std::string_view role : roles) {
    const RoleForm& form = role_form(role);
    if (choices_.columns.contains(std::string(role))) {
      if (const Column* column = chosen(role)) {
        if (auto found = match(*column, form, true)) return found->found;
        return Found{column, &form, std::string(form.si.empty() ? "" : form.si.front())};
      }
      continue;
    }
    if (const auto found = matches(form); !found.empty()) return found.front().found;
  }
  return {};
}

std::optional<ColumnRoles::Found> ColumnRoles::take(const std::string& key, Roles roles) {
  for (const std::string_view role : roles) roles_.emplace(role);
  for (const std::string_view role : roles) {
    const RoleForm& form = role_form(role);
    if (const Column* column = chosen(role)) {
      if (form.cells == Cells::numbers && !holds(*column, Cells::numbers))
        throw InputError(fmt::format("--column {}: column '{}' of {} does not hold numbers", role,
                                     column->name, file_));
      return take_column(key, *column, form);
    }
  }
  for (const std::string_view role : roles) {
    if (choices_.columns.contains(std::string(role))) continue;
    const auto found = matches(role_form(role));
    if (found.empty()) continue;
    const auto alike = [&](const Match& each) {
      return each.word == found.front().word && each.whole == found.front().whole;
    };
    if (std::count_if(found.begin(), found.end(), alike) > 1) {
      TableQuestion question{fmt::format("Which column of {} is {}?", file_,
                                         key.empty() ? role : std::string_view(key)),
                             {}};
      for (const Match& each : found) {
        if (!alike(each)) continue;
        question.readings.push_back(
            {fmt::format("'{}'", each.found.column->name),
             {"--column", fmt::format("{}={}", role, each.found.column->name)}});
      }
      questions.push_back(std::move(question));
    }
    return record(key, found.front());
  }
  return {};
}

void ColumnRoles::pass_over(std::string_view role) {
  roles_.emplace(role);
  const auto found = matches(role_form(role));
  if (found.size() != 1) return;  // several columns of one name are parallel readings
  used_.push_back(found.front().found.column);
  taken.push_back(
      fmt::format("column '{}' names rows and is not used", found.front().found.column->name));
}

ColumnRoles::Found ColumnRoles::record(const std::string& key, const Match& match) {
  Found found = match.found;
  refuse_other_dimension(file_, *found.column, *found.role);
  const std::string name_of_role(key.empty() ? found.role->name : std::string_view(key));
  used_.push_back(found.column);
  const std::string& name = found.column->name;
  const std::string brackets = match.found.unit_guessed || found.unit == "1" ? bracketed(name) : "";
  if (!brackets.empty() && !found.si.empty() && found.column->unit.empty() &&
      !may_be_plain(found.si)) {
    try {
      read_unit(brackets, found.si);
    } catch (const InputError& error) {
      taken.push_back(fmt::format("{}: column '{}'", name_of_role, name));
      unstated.push_back(fmt::format("column '{}': {}", name, error.what()));
      found.unit_guessed = false;
      found.unit = "1";
      return found;
    }
  }
  if (const std::string inside = bracketed(name);
      found.si.empty() && found.unit == "1" && name.ends_with(']') && inside != "1") {
    found.no_unit = true;
    guesses.push_back(fmt::format(
        "column '{}': {} is not a known unit; the column is read as plain numbers", name, inside));
  }
  taken.push_back(fmt::format("{}: column '{}'{}{}", name_of_role, name,
                              found.unit == "1" ? "" : " in " + found.unit,
                              match.by_unit ? ", by its unit" : ""));
  if (found.unit_guessed)
    guesses.push_back(
        fmt::format("column '{}' has no unit in its heading; {} is a guess", name, found.unit));
  if (may_be_plain(found.si) && would_be_millions(name, found.unit, *found.role, match.word))
    guesses.push_back(fmt::format(
        "column '{}': m is not read as a million; if it means one, write unit = \"1e6 cycles\" in "
        "the study",
        name));
  if (match.letter)
    guesses.push_back(fmt::format("column '{}': {} is read as {}", name,
                                  found.unit == "degC" ? "C" : "F", found.unit));
  return found;
}

std::vector<const Column*> ColumnRoles::other_numbers() const {
  std::vector<const Column*> found;
  for (const Column& column : table_.columns) {
    if (is_free(column) && holds(column, Cells::numbers) && differs(table_, column))
      found.push_back(&column);
  }
  return found;
}

std::vector<const Column*> ColumnRoles::other_labels() const {
  std::vector<const Column*> found;
  for (const Column& column : table_.columns) {
    if (is_free(column) && !column.is_number && values_of(table_, column).empty() &&
        repeats(table_, column))
      found.push_back(&column);
  }
  return found;
}

std::string ColumnRoles::line(const std::string& name, const Found& found) {
  if (found.unit == "1" && !found.no_unit)
    return fmt::format("{} = {}\n", name, toml_text(found.column->name));
  return fmt::format("{} = {{ column = {}, unit = {} }}{}\n", name, toml_text(found.column->name),
                     toml_text(found.unit),
                     found.unit_guessed ? "    # the unit is a GUESS"
                     : found.no_unit    ? "    # GUESS: a plain number"
                                        : "");
}

std::string ColumnRoles::unstated_line(const std::string& name, const std::string& what,
                                       const std::string& like) {
  unstated.push_back(fmt::format("{}: {}, like {}", name, what, toml_text(like)));
  return fmt::format("{} = {}    # STATE IT: {}, like {}\n", name, toml_text(not_stated), what,
                     toml_text(like));
}

std::string ColumnRoles::data_section() const {
  std::string text = fmt::format("[data]\nfile = {}\n{}", toml_text(file_), choices_.settings);
  std::string unused;
  const auto add = [&](const std::string& heading) {
    unused += (unused.empty() ? "" : ", ") + toml_text(table_.column(heading).name);
  };
  for (const std::string& each : choices_.unused) add(each);
  for (const std::string& each : unused_statuses_) add(each);
  if (!unused.empty())
    text += fmt::format("unused = [{}]{}\n", unused, "    # does not state how a life ended");
  return text;
}

Scaffold ColumnRoles::study(std::string reading, ReadingFit fit, std::string text) const {
  Scaffold study{std::move(text), taken, guesses, unstated, questions, fit, std::move(reading)};
  for (const auto& [role, heading] : choices_.columns) {
    if (!roles_.contains(role)) study.fit = ReadingFit::none;
  }
  for (const Column& column : table_.columns) {
    if (std::find(used_.begin(), used_.end(), &column) == used_.end())
      study.guesses.push_back(fmt::format("column '{}' is not used", column.name));
  }
  return study;
}

}  // namespace wearwell
