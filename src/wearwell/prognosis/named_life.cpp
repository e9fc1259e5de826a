#include "wearwell/prognosis/named_life.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"

namespace wearwell::prognosis {
namespace {

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// "A" of "type A", "7" of "machine 7".
std::string last_word(const std::string& of) {
  return of.substr(std::min(of.find(' ') + 1, of.size()));
}

bool names(const std::string& text, const NamedLife& life) {
  const std::string of = lower_case(without_new(life.request->of));
  const std::string at = lower_case(life.request->at);
  return text.empty() || text == of || text == last_word(of) || text == of + " " + at ||
         text == at || "at " + text == at;
}

}  // namespace

std::vector<NamedLife> named_lives(const PosteriorStudy& study) {
  std::vector<NamedLife> lives;
  for (const QuantityGroup& group : study.quantity_groups) {
    std::size_t index = 0;
    for (const QuantityRequest& each : group.requests)
      if (each.is_life) lives.push_back({&group, &each, index++});
  }
  return lives;
}

LifeDistribution distribution_at(const NamedLife& life, std::span<const double> x) {
  WeightedDraws one;
  one.values = Eigen::Map<const Points>(x.data(), 1, static_cast<Eigen::Index>(x.size()));
  one.weights = Eigen::VectorXd::Ones(1);
  return life.group->lives(one)[life.index].distribution;
}

std::string without_new(const std::string& of) {
  return of.starts_with("new ") ? of.substr(4) : of;
}

NamedLife life_named(const std::vector<NamedLife>& lives, const std::string& text,
                     const std::string& option) {
  std::vector<std::string> known;
  std::vector<NamedLife> fitting, fresh;
  const std::string wanted = lower_case(without_new(text));
  for (const NamedLife& each : lives) {
    known.push_back(without_new(each.request->of));
    if (!names(wanted, each)) continue;
    fitting.push_back(each);
    if (each.request->name == "life" && each.request->of.starts_with("new ")) fresh.push_back(each);
  }
  if (fitting.size() == 1) return fitting.front();
  if (fresh.size() == 1) return fresh.front();
  const auto first = std::find_if(fresh.begin(), fresh.end(),
                                  [](const NamedLife& each) { return each.request->headline; });
  if (text.empty() && first != fresh.end()) return *first;
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  if (fitting.empty())
    throw InputError(fmt::format("{}: the study has no life of '{}'; it has those of {}{}", option,
                                 printable(text), fmt::join(known, ", "),
                                 did_you_mean(text, known)));
  throw InputError(
      fmt::format("{}: which life is meant, that of {}?", option, fmt::join(known, ", ")));
}

}  // namespace wearwell::prognosis
