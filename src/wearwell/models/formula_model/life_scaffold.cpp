#include "wearwell/models/formula_model/life_scaffold.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/input/prior.h"
#include "wearwell/input/status_words.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/life_columns.h"
#include "wearwell/models/formula_model/scaffold_parts.h"
#include "wearwell/models/formula_model/step_columns.h"
#include "wearwell/study/column_values.h"
#include "wearwell/study/heading_words.h"
#include "wearwell/study/life_size.h"

// Longer than others: what a table of lives can say, one short function for each.
namespace wearwell::formula_model {
namespace {

using Found = ColumnRoles::Found;

constexpr std::string_view stresses[] = {"force", "pressure", "voltage", "alternating_stress"};

struct Lives {
  bool open_ends = false;        ///< some are written ">5000"
  std::string columns;           ///< lines of [data.columns]
  std::string unit;              ///< of a life
  double largest = 1;            ///< in it
  double middle = 1;             ///< the median of the written values
  bool stated = false;           ///< text or a status marks these as lives
  bool modes = false;            ///< with a column of failure modes
  std::string runout;            ///< a line of [failure_modes]
  bool ends_are_status = false;  ///< a column of status repeats the ends of the intervals
  std::string steps;             ///< the name of the specimens of a step-stress test
};

bool is_interval(const ColumnRoles& roles) {
  const auto lower = roles.find({"lower"}), upper = roles.find({"upper"});
  if (!lower || !upper || lower->column == upper->column) return false;
  const auto a = numbers_of(roles.table(), *lower->column);
  const auto b = numbers_of(roles.table(), *upper->column);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (b[i] < a[i]) return false;
  }
  return true;
}

// The unit that a word of a heading names: "Hours Lower" is in hours. Without one, "1".
std::string unit_by_word(const std::string& heading) {
  constexpr std::pair<const char*, const char*> words[] = {
      {"hours", "h"},      {"days", "day"},   {"weeks", "week"},
      {"months", "month"}, {"years", "year"}, {"minutes", "min"},
      {"km", "km"},        {"miles", "mile"}, {"cycles", "cycles"}};
  for (const auto& [word, unit] : words)
    if (is_called(heading, word)) return with_multiple(heading, unit, word);
  return "1";
}

// A column of status that says what the ends of each interval say already.
const Column* status_of_ends(const ColumnRoles& roles, const Column& lower, const Column& upper) {
  const auto status = roles.find({"status"});
  if (!status || status->column->is_number) return nullptr;
  const auto a = numbers_of(roles.table(), lower), b = numbers_of(roles.table(), upper);
  for (std::size_t row = 0; row < a.size(); ++row) {
    const auto seen = censoring_by_word(status->column->text[row]);
    const bool below = std::isnan(a[row]) || a[row] == 0, above = std::isnan(b[row]);
    const bool agrees = seen == Censoring::right      ? above
                        : seen == Censoring::left     ? below && !above
                        : seen == Censoring::interval ? !above
                        : seen == Censoring::none     ? !above
                                                      : false;
    if (!agrees) return nullptr;
  }
  return status->column;
}

double largest_of(const Table& table, const Column& column) {
  const auto values = values_of(table, column);
  const auto found = std::max_element(values.begin(), values.end());
  return found == values.end() || !(*found > 0) ? 1 : *found;
}

double middle_of(const Table& table, const Column& column) {
  auto values = values_of(table, column);
  if (values.empty()) return 1;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle > 0 ? *middle : 1;
}

// A path with repeated readings is not a list of lives.
bool is_path(const ColumnRoles& roles) {
  return roles.has({"depth", "volume", "mass", "crack", "measured"}) ||
         (has_units(roles) && !roles.has({"life"}));
}

void note_repeated_units(ColumnRoles& roles) {
  const auto unit = roles.find({"unit"});
  if (!unit || kinds_of(roles.table(), *unit->column).size() == roles.table().rows) return;
  roles.guesses.emplace_back(
      "several rows are of one unit: each is taken for the life of a part of its own. If rows are "
      "ages at which one unit failed and was repaired, the model is \"repairable\" "
      "(docs/reference/repairable.md)");
}

std::string take_modes(ColumnRoles& roles, Lives& lives) {
  if (!lives.steps.empty() || !has_modes(roles)) return "";
  lives.modes = true;
  lives.stated = true;
  return ColumnRoles::line("mode", *roles.take("mode", {"mode"}));
}

std::optional<Lives> take_lives(ColumnRoles& roles, const std::string& steps = "") {
  Lives lives;
  lives.steps = steps;
  const std::string count = take_count(roles);
  if (is_interval(roles)) {
    const Found lower = *roles.take("lower", {"lower"}), upper = *roles.take("upper", {"upper"});
    if (const Column* status = status_of_ends(roles, *lower.column, *upper.column)) {
      roles.taken.push_back(
          fmt::format("column '{}' says what the ends of the intervals say: it is not "
                      "needed",
                      status->name));
      lives.ends_are_status = true;
    }
    Found a = lower, b = upper;
    for (Found* end : {&a, &b})
      if (end->unit == "1") end->unit = unit_by_word(end->column->name);
    if (a.unit == "1") a.unit = b.unit;
    if (b.unit == "1") b.unit = a.unit;
    lives.columns = ColumnRoles::line("lower", a) + ColumnRoles::line("upper", b);
    lives.unit = a.unit;
    lives.largest = std::max(largest_of(roles.table(), *lower.column),
                             largest_of(roles.table(), *upper.column));
    lives.middle = middle_of(roles.table(), *lower.column);
    lives.stated = true;
    roles.guesses.push_back(
        "an empty upper end is read as a run-out, an empty lower end as a failure before the upper "
        "end");
    if (a.unit == "1")
      roles.guesses.push_back(fmt::format(
          "column '{}' has no unit: a life is a plain number, such as cycles", lower.column->name));
  } else {
    const bool named = roles.has({"life"});
    if (!named && !has_axis(roles)) return {};
    const auto life = named ? roles.take("life", {"life"}) : take_axis(roles, "life");
    if (!life) return {};
    lives.columns = column_line("life", *life);
    lives.unit = counting_unit(*life);
    lives.largest = largest_of(roles.table(), *life->column);
    lives.middle = middle_of(roles.table(), *life->column);
    lives.open_ends = has_open_ends(*life->column);
    lives.stated = named || lives.open_ends;
    if (lives.open_ends)
      roles.taken.push_back(
          fmt::format("status: '>' in column '{}' is a run-out", life->column->name));
    if (lives.unit == "1")
      roles.guesses.push_back(fmt::format(
          "column '{}' has no unit: a life is a plain number, such as cycles", life->column->name));
  }
  const auto mode = roles.find({"mode"});
  lives.columns += take_modes(roles, lives);
  if (const auto status = lives.ends_are_status ? std::nullopt : roles.take_status(true)) {
    lives.columns += *status;
    lives.stated = true;
  } else if (lives.modes) {
    if (!lives.open_ends && lives.columns.starts_with("life"))
      lives.runout = runouts_of_modes(roles, *mode->column);
  } else if (!lives.open_ends && lives.columns.starts_with("life")) {
    roles.guesses.emplace_back(
        "no column tells which parts were stopped unbroken: all count as failures");
  }
  lives.columns += count;
  if (const auto entry = roles.take("entry", {"entry"})) {
    Found since = *entry;
    if (since.unit == "1") since.unit = lives.unit;
    lives.columns += ColumnRoles::line("entry", since);
  }
  return lives;
}

constexpr const char* family =
    "[likelihood.life]\n"
    "family = \"weibull\"                       # the usual first choice; or lognormal, "
    "loglogistic, gamma "
    "(docs/reference/formula-models.md)\n"
    "scale  = \"characteristic\"                # 63.2 % have failed by then\n"
    "shape  = \"slope\"\n"
    "# share_defective = \"p\"                  # only a share can fail; two populations: "
    "docs/how-to/subpopulations.md\n";

std::string likelihood(const Lives& lives, const std::string& scale) {
  if (!lives.steps.empty())
    return fmt::format(
        "[likelihood.life]\n"
        "family = \"weibull\"                       # or lognormal, loglogistic, gamma "
        "(docs/reference/life.md)\n"
        "scale  = \"{}\"                # 63.2 % have failed by then, under one stress\n"
        "shape  = \"slope\"\n"
        "steps  = \"{}\"    # a row is a step of this specimen, with the age at its end "
        "(cumulative exposure)\n",
        scale, lives.steps);
  if (!lives.modes) return family;
  return "[failure_modes]\n"
         "column = \"mode\"                         # competing risks: a part fails by the mode "
         "whose life "
         "ends first\n" +
         lives.runout +
         "\n[likelihood.life]                       # of every mode; one of another family has a "
         "table "
         "[failure_modes.NAME]\n"
         "family = \"weibull\"                       # or lognormal, loglogistic, gamma "
         "(docs/reference/life.md)\n"
         "scale  = " +
         toml_text(scale) +
         "          # 63.2 % would have failed by then, by this mode alone\n"
         "shape  = \"slope[mode]\"\n";
}

LifeSize size_of(ColumnRoles& roles, const Lives& lives, double least,
                 const std::vector<std::string>& stresses = {}) {
  LifeHeadings headings = life_headings(lives.columns, roles.table());
  if (!lives.runout.empty())
    headings.runouts = TomlReader::parse({"", lives.runout}).texts("runout");
  const LifeSize size = life_size_under(roles.table(), headings, least, stresses);
  if (size.failed == 0)
    roles.guesses.emplace_back(
        "no part failed: the data say how short lives are not, and the proposed prior alone how "
        "long they are. Replace it, or design with lower bounds only");
  return size;
}

std::string life_priors(const Lives& lives, const char* scale, const LifeSize& size) {
  return fmt::format(
      "# Prior knowledge: PROPOSED as weak priors from the size of the data. Replace them with "
      "what you know of such\n"
      "# parts.\n"
      "[prior]\n"
      "{} = {{ distribution = \"lognormal\", median = {}, log_sd = {:.3g} }}    # {}\n"
      "slope = {{ distribution = \"lognormal\", median = 1.5, log_sd = 0.7 }}    # below 1: early "
      "failures, "
      "1: random failures, above: wear-out\n",
      scale, toml_text(quantity_text(rounded_up(size.median), lives.unit)), size.log_sd,
      words_of(size));
}

std::string head(const ColumnRoles& roles, const std::string& title) {
  return fmt::format(
      "title = {}\n"
      "model = \"formula\"\n\n{}[data.columns]\n",
      toml_text(title + ", from " + roles.file()), roles.data_section());
}

const char* const answers =
    "b_lives        = [1, 10, 50]             # lives at which 1, 10 and 50 % have failed\n"
    "credible_level = 0.9                     # of their lower bounds\n";

}  // namespace

std::optional<Scaffold> first_life_study(ColumnRoles& roles) {
  if (is_path(roles)) return {};
  const std::size_t differing = roles.other_numbers().size();
  const auto lives = take_lives(roles);
  if (!lives) return {};
  note_repeated_units(roles);
  roles.pass_over("unit");
  const std::size_t more = roles.other_numbers().size();
  if (!lives->stated && (more > 0 || differing == 0)) return {};
  std::vector<std::string> conditions;
  for (const Column* each : roles.other_numbers()) conditions.push_back("'" + each->name + "'");
  for (const Column* each : roles.other_labels()) conditions.push_back("'" + each->name + "'");
  if (!conditions.empty())
    roles.guesses.push_back(
        fmt::format("all lives are assumed to come from one population; {} is ignored",
                    fmt::join(conditions, ", ")));
  const std::string survival =
      toml_text(quantity_text(rounded_up(lives->largest) / 10, lives->unit));
  return roles.study(
      lives->modes ? "lives of parts: a Weibull distribution for each failure mode"
                   : "lives of parts: one Weibull distribution",
      lives->stated ? ReadingFit::general : ReadingFit::possible,
      head(roles, "Lives") + lives->columns + "\n" + likelihood(*lives, "characteristic[mode]") +
          "\n" + life_priors(*lives, "characteristic", size_of(roles, *lives, lives->largest)) +
          "\n[predict]\n" + answers +
          fmt::format("{}survival_to = {}                  # share that survives this life{}\n",
                      lives->modes ? "" : "# ", survival,
                      lives->modes ? ", and that has failed by each mode" : "") +
          (conditions.empty()
               ? ""
               : "\n# Lives that differ by group: characteristic = \"m[group]\" "
                 "with the label `group` in "
                 "[data.columns], or [random_effects.group]\n# (docs/reference/life.md).\n"));
}

std::optional<Scaffold> first_accelerated_study(ColumnRoles& roles) {
  const Column* const specimen = specimens_of_steps(
      roles, {"temperature", "force", "pressure", "voltage", "alternating_stress"});
  if (!specimen && is_path(roles)) return {};
  const bool counted = [&] {
    const auto life = roles.find({"life", "cycles"});
    return life && life->si == "cycle";
  }();
  const auto warm = roles.find({"temperature"});
  const bool by_temperature = warm && differs(roles.table(), *warm->column);
  std::vector<std::string_view> powers;
  for (const std::string_view each : stresses) {
    const auto found = roles.find({each});
    if (found && found->si == "Pa" && each == "alternating_stress" && counted && !specimen)
      return {};  // S-N
    if (found && differs(roles.table(), *found->column)) powers.push_back(each);
  }
  if (!by_temperature && powers.empty()) return {};
  std::string columns, constants, given, priors;
  const std::string each = !specimen && has_modes(roles) ? "[mode]" : "";
  std::string formula = "life_ref" + each;
  std::vector<std::string> said;
  std::vector<std::string> stressing;
  if (by_temperature) {
    const Found found = *roles.take("temperature", {"temperature"});
    stressing.push_back(found.column->name);
    columns += ColumnRoles::line("temperature", found);
    const auto values = values_of(roles.table(), *found.column);
    const auto [mild, harsh] = std::minmax_element(values.begin(), values.end());
    constants += fmt::format(
        "boltzmann = \"8.617333262e-5 eV/K\"\n"
        "reference = {}    # conditions at which life_ref is the characteristic life\n",
        toml_text(quantity_text(*harsh, found.unit)));
    formula += " * exp(energy" + each + "/boltzmann * (1/temperature - 1/reference))";
    given += fmt::format("temperature = {}", toml_text(quantity_text(*mild, found.unit)));
    priors +=
        "energy = { distribution = \"normal\", mean = \"0.7 eV\", sd = \"0.3 eV\" }    # "
        "activation energy "
        "of the aging process\n";
    said.emplace_back("Arrhenius' law of temperature");
  }
  for (const std::string_view power : powers) {
    const Found found = *roles.take(std::string(power), {power});
    stressing.push_back(found.column->name);
    const std::string name(power == "alternating_stress" ? "stress" : power);
    columns += ColumnRoles::line(name, found);
    const auto values = values_of(roles.table(), *found.column);
    const auto [mild, harsh] = std::minmax_element(values.begin(), values.end());
    if (!(*mild > 0)) return {};
    const std::string quantity = toml_text(quantity_text(*mild, found.unit));
    constants +=
        fmt::format("{}_ref = {}    # conditions at which life_ref is the characteristic life\n",
                    name, toml_text(quantity_text(*harsh, found.unit)));
    formula += fmt::format(" * ({0}/{0}_ref)^-{0}_power{1}", name, each);
    given += fmt::format("{}{} = {}", given.empty() ? "" : ", ", name, quantity);
    priors += fmt::format(
        "{}_power = {{ distribution = \"normal\", mean = 5, sd = 5 }}    # exponent: a higher "
        "value "
        "shortens the life\n",
        name);
    said.push_back("a power of " + name);
  }
  const std::string steps = specimen ? name_of(*specimen, "specimen") : "";
  if (specimen) {
    columns += fmt::format("{} = {}\n", steps, toml_text(specimen->name));
    roles.take_column(steps, *specimen, role_form("unit"));
    roles.guesses.emplace_back(
        "the rows of one specimen are the steps of its test, each with the age at its end");
  } else {
    note_repeated_units(roles);
  }
  const auto lives = take_lives(roles, steps);
  if (!lives || !lives->stated) return {};
  roles.pass_over("unit");
  // A row of a step-stress test is a step, not a life.
  const LifeSize size = specimen ? LifeSize{.median = lives->middle, .failed = 1, .parts = 1}
                                 : size_of(roles, *lives, lives->middle, stressing);
  const std::string how = fmt::format("{}", fmt::join(said, " and "));
  roles.guesses.push_back(
      "predictions are for the mildest conditions tested; state the conditions of use in [predict] "
      "given");
  return roles.study(
      (specimen ? "step-stress test: " : "lives under several conditions: ") + how,
      ReadingFit::specific,
      head(roles, "Lives under conditions") + lives->columns + columns + "\n[constants]\n" +
          constants +
          "\n"
          "[formula]                                    # the simplest formula for such lives: " +
          how + "\ncharacteristic = \"" + formula + "\"\n\n" +
          likelihood(*lives, "characteristic") + "\n" + life_priors(*lives, "life_ref", size) +
          priors + "\n[predict]\n" +
          fmt::format(
              "given = {{ {} }}    # GUESS: the mildest conditions tested; state those of use\n",
              given) +
          answers);
}

}  // namespace wearwell::formula_model
