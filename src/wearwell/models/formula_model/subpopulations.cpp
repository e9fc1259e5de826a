#include "wearwell/models/formula_model/subpopulations.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/nearest.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/prob/life_mixture.h"

namespace wearwell::formula_model {
namespace {

constexpr std::string_view keys_of_subpopulations[] = {"names", "share"};

std::vector<std::string> read_names(const TomlReader& section) {
  std::vector<std::string> names = section.texts("names");
  if (names.size() < 2)
    section.fail("names",
                 "needs two names or more, in the order of their median lives: [\"early\", "
                 "\"wear-out\"]; parts of which only a share can fail have share_defective "
                 "in [likelihood] instead");
  if (names.size() > LifeMixture::most)
    section.fail("names", fmt::format("has {} names; at most {} subpopulations are possible",
                                      names.size(), LifeMixture::most));
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string& name = names[k];
    if (name.empty() || (name.find('\'') != name.npos && name.find('"') != name.npos))
      section.fail("names",
                   fmt::format("'{}' is empty, or has both kinds of quotation marks", name));
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(k), name) !=
        names.begin() + static_cast<std::ptrdiff_t>(k))
      section.fail("names", fmt::format("has '{}' twice", name));
    if (std::find(std::begin(keys_of_subpopulations), std::end(keys_of_subpopulations), name) !=
        std::end(keys_of_subpopulations))
      section.fail("names",
                   fmt::format("'{}' is a key of [subpopulations]; choose another name", name));
  }
  return names;
}

}  // namespace

std::size_t Subpopulations::rest() const {
  return static_cast<std::size_t>(std::find(share.begin(), share.end(), std::nullopt) -
                                  share.begin());
}

std::optional<Subpopulations> read_subpopulations(const TomlReader& root) {
  const auto section = root.table("subpopulations");
  if (!section) return {};
  Subpopulations found{read_names(*section), {}};
  const TomlReader shares = section->required_table("share");
  const std::vector<std::string> keys = shares.keys();
  for (const std::string& key : keys) {
    if (std::find(found.names.begin(), found.names.end(), key) == found.names.end())
      shares.fail(key, fmt::format("is no subpopulation; names has {}{}",
                                   fmt::join(found.names, ", "), did_you_mean(key, found.names)));
  }
  std::vector<std::string> without;
  for (const std::string& name : found.names) {
    const bool given = std::find(keys.begin(), keys.end(), name) != keys.end();
    if (!given) without.push_back(name);
    found.share.push_back(given ? std::optional(expression(shares, name)) : std::nullopt);
  }
  if (without.empty())
    section->fail(
        "share", fmt::format("has a share of every subpopulation; shares add up to 1, so leave one "
                             "out, such as '{}': it has the rest",
                             found.names.back()));
  if (without.size() > 1)
    section->fail("share", fmt::format("lacks {}; one subpopulation only can have the rest",
                                       fmt::join(without, " and ")));
  return found;
}

std::vector<std::string> subpopulations_with_tables(const TomlReader& section,
                                                    const Subpopulations& subpopulations) {
  std::vector<std::string> found;
  for (const std::string& key : section.keys()) {
    if (std::find(std::begin(keys_of_subpopulations), std::end(keys_of_subpopulations), key) !=
        std::end(keys_of_subpopulations))
      continue;
    if (std::find(subpopulations.names.begin(), subpopulations.names.end(), key) ==
        subpopulations.names.end())
      section.fail(key, fmt::format("is no subpopulation; names has {}{}",
                                    fmt::join(subpopulations.names, ", "),
                                    did_you_mean(key, subpopulations.names)));
    found.push_back(key);
  }
  return found;
}

}  // namespace wearwell::formula_model
