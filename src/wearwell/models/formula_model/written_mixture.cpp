#include "wearwell/models/formula_model/written_mixture.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

#include "wearwell/base/trimmed.h"
#include "wearwell/models/formula_model/formula_reader.h"

namespace wearwell::formula_model {
namespace {

constexpr const char* defective_key = "share_defective";
constexpr const char* dead_key = "share_dead_on_arrival";

bool same_prior(const Parameter& a, const Parameter& b) {
  if (a.distribution != b.distribution || a.prior.lower != b.prior.lower ||
      a.prior.upper != b.prior.upper || a.prior.proper != b.prior.proper)
    return false;
  if (!a.prior.proper) return true;
  for (const double p : {0.1, 0.5, 0.9})
    if (quantile(a.prior, p) != quantile(b.prior, p)) return false;
  return true;
}

const Parameter* named(const std::vector<Parameter>& parameters, const std::string& name) {
  const auto at = std::find_if(parameters.begin(), parameters.end(),
                               [&](const Parameter& each) { return each.name == name; });
  return at == parameters.end() ? nullptr : &*at;
}

// An expression without the name of its level: "eta['early'] * a__1" becomes "eta[] * a__".
std::string without_level(const std::string& text, const std::string& level, std::size_t k) {
  static const std::regex special(R"([.^$|()\[\]{}*+?\\])");
  const std::string escaped = std::regex_replace(level, special, R"(\$&)");
  const std::string plain =
      std::regex_replace(text, std::regex("\\[['\"]" + escaped + "['\"]\\]"), "[]");
  return std::regex_replace(plain, std::regex(fmt::format("__{}\\b", k + 1)), "__");
}

// Whether every parameter with a value for each subpopulation has the same prior for all.
bool have_same_priors(const Subpopulations& subpopulations,
                      const std::vector<Parameter>& parameters) {
  for (const Parameter& each : parameters) {
    const std::string suffix = "[" + subpopulations.names.front() + "]";
    if (!each.name.ends_with(suffix)) continue;
    const std::string base = each.name.substr(0, each.name.size() - suffix.size());
    for (const std::string& name : subpopulations.names) {
      const Parameter* other = named(parameters, fmt::format("{}[{}]", base, name));
      if (other && !same_prior(each, *other)) return false;
    }
  }
  return true;
}

}  // namespace

LifeMixture WrittenLikelihood::life() const {
  LifeMixture mixture;
  for (const WrittenLikelihood& each : parts_of(*this))
    mixture.families.push_back(each.form ? each.form->family : ResponseFamily::weibull);
  mixture.rest = rest;
  mixture.limited = defective.has_value();
  mixture.dead = dead.has_value();
  return mixture;
}

WrittenLikelihood empty_likelihood(const std::string& column) {
  WrittenLikelihood written;
  written.column = column;
  written.place = "likelihood." + column;
  return written;
}

std::span<const WrittenLikelihood> parts_of(const WrittenLikelihood& written) {
  return written.parts.empty() ? std::span(&written, 1) : std::span(written.parts);
}

void read_shares_of_life(const TomlReader& table, WrittenLikelihood& written) {
  if (table.has(defective_key)) written.defective = expression(table, defective_key);
  if (table.has(dead_key)) written.dead = expression(table, dead_key);
  const LifeMixture life = written.life();
  const std::string place = fmt::format("[{}] ", written.place);
  if (written.defective)
    written.shares.push_back({place + defective_key, *written.defective, life.share_defective()});
  if (written.dead) written.shares.push_back({place + dead_key, *written.dead, life.share_dead()});
}

void refuse_with_shares(const TomlReader& root, const std::vector<WrittenLikelihood>& written) {
  for (const WrittenLikelihood& each : written) {
    if (!each.defective && !each.dead) continue;
    const TomlReader table = root.required_table("likelihood").required_table(each.column);
    const char* const key = each.defective ? defective_key : dead_key;
    if (each.process || (each.form && (each.form->counted || !each.form->positive)))
      table.fail(key,
                 fmt::format("is for lives: families of positive values, not {}", each.form->name));
    if (root.has("failure_modes"))
      table.fail(key,
                 "is not possible with [failure_modes]: a mode that only a share can have is "
                 "not supported");
    if (root.has("random_effects")) table.fail(key, "is not possible with [random_effects]");
    if (written.size() > 1) table.fail(key, "needs one measured column, the life");
    const auto predict = root.table("predict");
    for (const char* other : {"along", "at", "limit", "units", "lives_of"}) {
      if (predict && predict->has(other))
        predict->fail(other,
                      fmt::format("is for readings along an axis, not for lives with {}", key));
    }
    if (predict && each.defective && predict->boolean("mean_life").value_or(false))
      predict->fail("mean_life",
                    "does not exist with share_defective: parts that never fail have an infinite "
                    "mean life; read B-lives, or survival_to");
  }
}

void refuse_with_subpopulations(const TomlReader& root,
                                const std::vector<WrittenLikelihood>& written,
                                const std::vector<std::string>& texts) {
  if (written.size() > 1)
    root.fail("subpopulations", "needs one measured column, the life; [likelihood] has several");
  for (const char* other : {"failure_modes", "random_effects"}) {
    if (root.has(other))
      root.fail(other,
                "is not possible with [subpopulations]: either is known of a part, or it is not");
  }
  if (const auto predict = root.table("predict")) {
    for (const char* key : {"along", "at", "limit", "units", "lives_of"}) {
      if (predict->has(key))
        predict->fail(key, "is for readings along an axis, not for lives with [subpopulations]");
    }
  }
  const std::regex compared(std::string("\\b") + Subpopulations::label + R"(\s*(==|!=))");
  for (const std::string& text : texts) {
    if (std::regex_search(text, compared))
      root.fail(
          "subpopulations",
          fmt::format("'{}' compares the subpopulation; give it a table [subpopulations.NAME] "
                      "with its own expressions",
                      text));
  }
}

WrittenLikelihood mixture_of(const TomlReader& root, const Subpopulations& subpopulations,
                             const WrittenLikelihood& common,
                             const std::vector<WrittenLikelihood>& with_tables,
                             const LinesByLevel& lines) {
  const TomlReader section = root.required_table("subpopulations");
  WrittenLikelihood mixture = common;
  for (std::size_t k = 0; k < subpopulations.names.size(); ++k) {
    const std::string& name = subpopulations.names[k];
    const auto own = std::find_if(with_tables.begin(), with_tables.end(),
                                  [&](const auto& each) { return each.mode == name; });
    if (own == with_tables.end() && !common.form)
      section.fail("",
                   fmt::format("'{0}' has no distribution: give it a table [subpopulations.{0}], "
                               "or [likelihood.{1}] a family for all without one",
                               name, common.column));
    WrittenLikelihood part = own == with_tables.end() ? common : *own;
    if (part.process || part.form->counted || !part.form->positive)
      section.fail("", fmt::format("needs families of positive lives, but {} is {}", part.place,
                                   part.form->name));
    part.mode = name;
    for (auto& [family_parameter, text] : part.family_parameters) text = lines.text(text, k);
    mixture.parts.push_back(std::move(part));
  }
  if (common.form && with_tables.size() == subpopulations.names.size())
    root.required_table("likelihood")
        .fail(common.column,
              "has a family that is not used, because each subpopulation has a table of its own; "
              "leave it empty");
  mixture.form = mixture.parts.front().form;
  mixture.family_parameters.clear();
  mixture.rest = subpopulations.rest();
  const LifeMixture life = mixture.life();
  for (WrittenShare& each : mixture.shares)
    each.at = each.place.ends_with(dead_key) ? life.share_dead() : life.share_defective();
  for (std::size_t k = 0; k < subpopulations.names.size(); ++k) {
    if (subpopulations.share[k])
      mixture.shares.push_back({"[subpopulations.share] " + subpopulations.names[k],
                                lines.text(*subpopulations.share[k], k), life.share(k)});
  }
  return mixture;
}

void add_wanted(const WrittenLikelihood& written, const formula::Powers& powers,
                Measured& measured) {
  const std::span<const WrittenLikelihood> parts = parts_of(written);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    for (const auto& [family_parameter, text] : parts[k].family_parameters) {
      const ParameterForm& form = parts[k].form->family_parameters[family_parameter];
      const bool dimensional =
          form.kind == ParameterKind::location || form.kind == ParameterKind::scale;
      const std::string of = written.parts.empty() || !parts[k].place.starts_with("likelihood.")
                                 ? ""
                                 : fmt::format(" of {}", parts[k].mode);
      measured.wanted.push_back({fmt::format("[{}] {}{}", parts[k].place, form.name, of), text,
                                 dimensional ? powers : formula::Powers(),
                                 dimensional ? fmt::format("the column '{}'", written.column)
                                             : fmt::format("a {}", form.name)});
      measured.family_parameter.push_back(k * most_response_parameters + family_parameter);
    }
  }
  for (const WrittenShare& each : written.shares) {
    measured.wanted.push_back({each.place, each.text, formula::Powers(), "a share"});
    measured.family_parameter.push_back(each.at);
  }
}

bool are_exchangeable(const WrittenLikelihood& written, const Subpopulations& subpopulations,
                      const std::vector<formula::Line>& lines,
                      const std::vector<Parameter>& parameters) {
  if (!have_same_priors(subpopulations, parameters)) return false;
  // A level that an expression names breaks the symmetry.
  for (const formula::Line& line : lines) {
    for (std::size_t k = 0; k < subpopulations.names.size(); ++k)
      if (without_level(line.text, subpopulations.names[k], k) != line.text) return false;
  }
  const WrittenLikelihood& first = written.parts.front();
  for (std::size_t k = 1; k < written.parts.size(); ++k) {
    const WrittenLikelihood& other = written.parts[k];
    if (other.form != first.form ||
        other.family_parameters.size() != first.family_parameters.size())
      return false;
    for (std::size_t s = 0; s < first.family_parameters.size(); ++s) {
      const auto& [slot, text] = first.family_parameters[s];
      const auto& [other_slot, other_text] = other.family_parameters[s];
      if (slot != other_slot) return false;
      if (without_level(text, subpopulations.names.front(), 0) ==
          without_level(other_text, subpopulations.names[k], k))
        continue;
      const Parameter *a = named(parameters, std::string(trimmed(text))),
                      *b = named(parameters, std::string(trimmed(other_text)));
      if (!a || !b || !same_prior(*a, *b)) return false;
    }
  }
  return true;
}

}  // namespace wearwell::formula_model
