#include "wearwell/models/recurrence/growth_test.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "wearwell/base/nearest.h"
#include "wearwell/input/prior.h"
#include "wearwell/models/recurrence/recurrence_report.h"

namespace wearwell::recurrence {
namespace {

// Quantiles that stand for the distribution of an effectiveness factor.
constexpr int effectiveness_quantiles = 1000;

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

bool is_distribution(const TomlReader& table, const std::string& mode) {
  for (const TomlReader::Present& each : table.present())
    if (each.is_table && each.path.ends_with("." + mode)) return true;
  return false;
}

void read_effectiveness(const TomlReader& table, FailureMode& mode) {
  if (is_distribution(table, mode.name)) {
    const Parameter factor = read_prior(table, {mode.name, "1", 0, 1, 0.7});
    mode.stated = factor.distribution;
    for (int i = 0; i < effectiveness_quantiles; ++i)
      mode.effectiveness.push_back(quantile(factor.prior, (i + 0.5) / effectiveness_quantiles));
    return;
  }
  const double factor = table.required_quantity(mode.name, "1").si();
  if (!(factor >= 0 && factor <= 1))
    table.fail(mode.name,
               fmt::format("is {:.6g}; the effectiveness of a fix is between 0 (no effect) and 1 "
                           "(the failure mode is gone)",
                           factor));
  mode.stated = fmt::format("{:.6g}", factor);
  mode.effectiveness = {factor};
}

// The modes of the data with their failures, in the order of the ages at which they occur first.
std::vector<FailureMode> modes_of(const RecurrenceData& data) {
  std::map<std::string, FailureMode> by_name;
  for (const UnitHistory& unit : data.units) {
    for (std::size_t i = 0; i < unit.failures.size(); ++i) {
      FailureMode& mode = by_name[unit.modes[i]];
      mode.name = unit.modes[i];
      mode.ages.push_back(unit.failures[i]);
    }
  }
  std::vector<FailureMode> modes;
  for (auto& [name, mode] : by_name) {
    std::sort(mode.ages.begin(), mode.ages.end());
    modes.push_back(std::move(mode));
  }
  std::stable_sort(modes.begin(), modes.end(), [](const FailureMode& a, const FailureMode& b) {
    return a.ages.front() < b.ages.front();
  });
  return modes;
}

// The class of each mode, by the key that names it.
class Classes {
 public:
  Classes(const TomlReader& section, std::vector<FailureMode>& modes)
      : section_(section), modes_(modes) {}

  // Throws if `name` is no mode of the data, or if another key has it.
  FailureMode& assign(const TomlReader& at, const std::string& key, const std::string& name,
                      FixClass fix) {
    const auto mode = std::find_if(modes_.begin(), modes_.end(),
                                   [&](const FailureMode& each) { return each.name == name; });
    if (mode == modes_.end()) refuse_unknown(at, key, name);
    const char* words[] = {"none", "during", "effectiveness"};
    const char* word = words[static_cast<int>(fix)];
    const auto [other, is_new] = key_of_.try_emplace(name, word);
    if (!is_new)
      at.fail(key, fmt::format("names mode '{}', which is {} fixes.{}: a mode is either not fixed "
                               "(none), fixed during the test (during) or fixed after it "
                               "(effectiveness)",
                               name, other->second == word ? "already in" : "in", other->second));
    mode->fix = fix;
    return *mode;
  }

  void require_all(const RecurrenceData& data) const {
    for (const FailureMode& mode : modes_) {
      if (key_of_.contains(mode.name)) continue;
      section_.fail("",
                    fmt::format("does not name mode '{}' ({} failure{}, the first at {}); write "
                                "it into none (it is not fixed), into during (it was fixed "
                                "during the test), or with its factor into [fixes.effectiveness] "
                                "(it is fixed after the test)",
                                mode.name, mode.ages.size(), mode.ages.size() == 1 ? "" : "s",
                                age_text(data, mode.ages.front())));
    }
  }

 private:
  [[noreturn]] void refuse_unknown(const TomlReader& at, const std::string& key,
                                   const std::string& name) const {
    std::vector<std::string> names;
    for (const FailureMode& each : modes_) names.push_back(each.name);
    at.fail(key,
            fmt::format("names mode '{}', but no failure has this mode (nearest: '{}'); a mode "
                        "that was not seen is part of the new modes",
                        name, nearest_name(name, names)));
  }

  const TomlReader& section_;
  std::vector<FailureMode>& modes_;
  std::map<std::string, std::string> key_of_;
};

// Throws unless all units were observed from age 0 to one end, which a time limit set.
void require_one_end(const TomlReader& section, const RecurrenceData& data) {
  const UnitHistory& first = data.units.front();
  for (const UnitHistory& unit : data.units) {
    if (unit.start > 0)
      section.fail("", fmt::format("needs units that were observed from age 0, but the observation "
                                   "of unit '{}' began at {}",
                                   unit.name, age_text(data, unit.start)));
    if (unit.ends_at_failure)
      section.fail("", fmt::format("needs a test that a time limit ended, but unit '{}' has no row "
                                   "of its end of observation; add one with the age at which the "
                                   "test stopped",
                                   unit.name));
    if (unit.end != first.end)
      section.fail("", fmt::format("needs units with one common end of the test, but that of unit "
                                   "'{}' is {} and that of unit '{}' is {}",
                                   first.name, age_text(data, first.end), unit.name,
                                   age_text(data, unit.end)));
  }
}

void require_process(const TomlReader& section, const TomlReader& root, const Process& process) {
  if (!root.required_table("data").required_table("columns").has("mode"))
    section.fail("", "needs data.columns.mode, the column with the failure mode of each failure");
  if (!process.minimal_repair())
    section.fail("",
                 "needs process = \"power_law\" or \"phases\": a projection counts failures of a "
                 "Poisson process, which a renewal process is not");
}

}  // namespace

double FailureMode::mean_effectiveness() const {
  return effectiveness.empty() ? 0 : mean_of(effectiveness);
}

std::vector<const FailureMode*> GrowthTest::of(FixClass fix) const {
  std::vector<const FailureMode*> found;
  for (const FailureMode& each : modes)
    if (each.fix == fix) found.push_back(&each);
  return found;
}

std::size_t GrowthTest::failures(FixClass fix) const {
  std::size_t sum = 0;
  for (const FailureMode* each : of(fix)) sum += each->ages.size();
  return sum;
}

double GrowthTest::mean_effectiveness() const {
  std::vector<double> factors;
  for (const FailureMode* each : of(FixClass::delayed))
    factors.push_back(each->mean_effectiveness());
  return mean_of(factors);
}

std::optional<GrowthTest> read_growth_test(const TomlReader& root, const RecurrenceData& data,
                                           const Process& process) {
  const auto section = root.table("fixes");
  if (!section) {
    const TomlReader columns = root.required_table("data").required_table("columns");
    if (columns.has("mode"))
      columns.fail("mode",
                   "has failure modes, but the study has no [fixes], which states the fix of each: "
                   "none = [...], during = [...] and [fixes.effectiveness]; without a projection "
                   "of delayed fixes leave the column out");
    return {};
  }
  require_process(*section, root, process);
  require_one_end(*section, data);
  if (data.failures() == 0)
    section->fail("", "needs failures: no failure was observed, so nothing can be projected");
  GrowthTest test{data.units.size(), data.units.front().end, modes_of(data)};
  Classes classes(*section, test.modes);
  for (const std::string& name : section->texts("none"))
    classes.assign(*section, "none", name, FixClass::none);
  for (const std::string& name : section->texts("during"))
    classes.assign(*section, "during", name, FixClass::during);
  const TomlReader factors = section->required_table("effectiveness");
  for (const std::string& name : factors.keys())
    read_effectiveness(factors, classes.assign(factors, name, name, FixClass::delayed));
  if (test.of(FixClass::delayed).empty())
    section->fail("effectiveness",
                  "names no mode; a projection needs a mode that is fixed after "
                  "the test, with the effectiveness of its fix");
  classes.require_all(data);
  const std::vector<const FailureMode*> during = test.of(FixClass::during);
  if (!during.empty() && std::all_of(during.begin(), during.end(), [&](const FailureMode* each) {
        return each->ages.front() == test.end;
      }))
    section->fail("during", fmt::format("has only failures at {}, the end of the test; their "
                                        "intensity after the fixes cannot be estimated",
                                        age_text(data, test.end)));
  return test;
}

}  // namespace wearwell::recurrence
