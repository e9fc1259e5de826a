#include "wearwell/study/family_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/study/scaffold.h"

namespace wearwell {
namespace {

constexpr std::string_view families[] = {
    "weibull",          "lognormal",         "loglogistic",           "gamma",
    "inverse-gaussian", "birnbaum-saunders", "exponentiated-weibull", "generalized-gamma"};

constexpr std::string_view two_parameters[] = {"mean", "median", "scale", "shape", "log_sd"};

// exp of the mean of the logarithm of a life, and its standard deviation, as expressions.
struct LogMoments {
  std::string middle, sd;
};

// A likelihood as its lines in the text.
struct LikelihoodLines {
  std::string column, family;
  std::vector<std::string> lines;  // of the whole study
  std::size_t begin = 0, end = 0;  // after its heading, to the next
};

std::string trimmed(std::string text) {
  text.erase(0, std::min(text.find_first_not_of(" \t"), text.size()));
  text.erase(text.find_last_not_of(" \t\r") + 1);
  return text;
}

std::string key_of(const std::string& line) {
  const std::size_t equals = line.find('=');
  return equals == line.npos ? std::string() : trimmed(line.substr(0, equals));
}

[[noreturn]] void refuse_layout(const TomlReader& likelihood, const std::string& column) {
  likelihood.fail(column,
                  fmt::format("must be a table [likelihood.{}] with a line for each key, so "
                              "that its family can be exchanged",
                              column));
}

// The family that the parameters belong to. A list, or "best", stands in studies that want a ranking.
std::string written_family(const TomlReader& table) {
  if (table.is_text("family")) {
    const std::string family = table.required_text("family");
    if (family != "best" && family != "all" && family != "auto") return family;
  }
  if (table.has("median")) return "lognormal";
  return table.has("mean") ? "inverse-gaussian" : "weibull";
}

LikelihoodLines likelihood_lines(const Source& study) {
  const TomlReader root = TomlReader::parse(study.study);
  const TomlReader likelihood = root.required_table("likelihood");
  if (likelihood.keys().size() != 1)
    root.fail("likelihood", "needs one measured column to rank families of it");
  LikelihoodLines found{likelihood.keys().front(), {}, {}, 0, 0};
  const TomlReader table = likelihood.required_table(found.column);
  found.family = written_family(table);
  if (std::find(std::begin(families), std::end(families), found.family) == std::end(families))
    table.fail("family", fmt::format("is not one of the families that can be ranked: {}",
                                     fmt::join(families, ", ")));
  std::istringstream text(study.study.text);
  for (std::string line; std::getline(text, line);) found.lines.push_back(line);
  const std::string heading = fmt::format("[likelihood.{}]", found.column);
  for (std::size_t i = 0; i < found.lines.size(); ++i) {
    if (!trimmed(found.lines[i]).starts_with(heading)) continue;
    found.begin = i + 1;
    found.end = i + 1;
    while (found.end < found.lines.size() && !trimmed(found.lines[found.end]).starts_with("["))
      ++found.end;
  }
  std::size_t keys = 0;
  for (std::size_t i = found.begin; i < found.end; ++i)
    keys += table.has(key_of(found.lines[i])) ? 1 : 0;
  if (found.begin == 0 || keys != table.keys().size()) refuse_layout(likelihood, found.column);
  return found;
}

// A parameter of the family, in brackets.
std::string parameter(const TomlReader& table, const char* name) {
  if (!table.has(name)) table.fail(name, "is missing");
  return table.is_text(name) ? fmt::format("({})", table.required_text(name))
                             : fmt::format("({})", table.required_quantity(name, "1").si());
}

LogMoments moments_of(const TomlReader& table, const std::string& family) {
  const auto of = [&](const char* name) { return parameter(table, name); };
  if (family == "weibull")
    return {fmt::format("{} * exp(-0.5772156649/{})", of("scale"), of("shape")),
            fmt::format("1.2825498302/{}", of("shape"))};
  if (family == "lognormal" && table.has("median")) return {of("median"), of("log_sd")};
  if (family == "loglogistic") return {of("scale"), fmt::format("1.8137993642/{}", of("shape"))};
  if (family == "gamma")
    return {fmt::format("{} * exp(digamma{})", of("scale"), of("shape")),
            fmt::format("sqrt(1/{0} + 0.5/{0}^2)", of("shape"))};
  if (family == "inverse-gaussian") {
    const std::string square = fmt::format("log(1 + {}/{})", of("mean"), of("shape"));
    return {fmt::format("{} * exp(-{}/2)", of("mean"), square), fmt::format("sqrt({})", square)};
  }
  table.fail(
      "family",
      fmt::format("cannot be the first of a ranking with these parameters; start from weibull, "
                  "lognormal (median and log_sd), loglogistic, gamma or inverse-gaussian"));
}

std::vector<std::pair<std::string, std::string>> parameters_of(std::string_view family,
                                                               const LogMoments& log) {
  const std::string m = fmt::format("({})", log.middle), s = fmt::format("({})", log.sd);
  if (family == "weibull" || family == "exponentiated-weibull") {
    std::vector<std::pair<std::string, std::string>> all = {
        {"scale", fmt::format("{} * exp(0.4500532075*{})", m, s)},
        {"shape", fmt::format("1.2825498302/{}", s)}};
    if (family != "weibull") all.emplace_back("exponent", "family_exponent");
    return all;
  }
  if (family == "lognormal") return {{"median", m}, {"log_sd", s}};
  if (family == "loglogistic") return {{"scale", m}, {"shape", fmt::format("1.8137993642/{}", s)}};
  if (family == "gamma") {
    const std::string k = fmt::format("((1 + sqrt(1 + 2*{0}^2))/(2*{0}^2))", s);
    return {{"shape", k}, {"scale", fmt::format("{} * exp(-digamma({}))", m, k)}};
  }
  if (family == "inverse-gaussian") {
    const std::string mean = fmt::format("{} * exp({}^2/2)", m, s);
    return {{"mean", mean}, {"shape", fmt::format("{}/(exp({}^2) - 1)", mean, s)}};
  }
  if (family == "birnbaum-saunders")
    return {{"scale", m}, {"shape", fmt::format("exp({0}/2) - exp(-{0}/2)", s)}};
  return {{"scale", m}, {"sigma", s}, {"lambda", "family_lambda"}};
}

std::string third_prior(std::string_view family) {
  if (family == "generalized-gamma")
    return "[prior.family_lambda]\ndistribution = \"normal\"\nmean = 0.5\nsd = 1\n";
  if (family == "exponentiated-weibull")
    return "[prior.family_exponent]\ndistribution = \"lognormal\"\nmedian = 1\nlog_sd = 0.7\n";
  return "";
}

}  // namespace

std::span<const std::string_view> exchangeable_families() {
  return families;
}

Source study_with_family(const Source& study, std::string_view family) {
  if (std::find(std::begin(families), std::end(families), family) == std::end(families))
    throw InputError(fmt::format("--families: '{}' cannot be ranked; possible are {}", family,
                                 fmt::join(families, ", ")));
  LikelihoodLines found = likelihood_lines(study);
  const TomlReader root = TomlReader::parse(study.study);
  const TomlReader table = root.required_table("likelihood").required_table(found.column);
  const bool same = found.family == family;
  const LogMoments log = same ? LogMoments{} : moments_of(table, found.family);
  std::string text;
  for (std::size_t i = 0; i < found.lines.size(); ++i) {
    const std::string key = i >= found.begin && i < found.end ? key_of(found.lines[i]) : "";
    const bool replaced = !same && std::find(std::begin(two_parameters), std::end(two_parameters),
                                             key) != std::end(two_parameters);
    if (key == "family") {
      text += fmt::format("family = {}\n", toml_text(std::string(family)));
      if (same) continue;
      for (const auto& [name, value] : parameters_of(family, log))
        text += fmt::format("{} = {}\n", name, toml_text(value));
    } else if (!replaced) {
      text += found.lines[i] + "\n";
    }
  }
  Source other = study;
  other.study.text = text + (same ? "" : third_prior(family));
  return other;
}

}  // namespace wearwell
