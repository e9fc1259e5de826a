#include "wearwell/study/family_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/trim.hpp>
#include <sstream>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/prob/log_location_scale.h"
#include "wearwell/study/scaffold.h"

namespace wearwell {
namespace {

constexpr std::string_view families[] = {
    "weibull",          "lognormal",         "loglogistic",           "frechet",          "gamma",
    "inverse-gaussian", "birnbaum-saunders", "exponentiated-weibull", "generalized-gamma"};

// Of a study with the family as a log-location-scale family.
constexpr std::string_view by_standard[] = {"standard", "sigma"};

constexpr std::string_view two_parameters[] = {"mean", "median", "scale", "shape", "log_sd"};

// exp of the mean of the logarithm of a life, and its standard deviation, as expressions.
struct LogMoments {
  std::string middle, sd;
};

// A likelihood as its lines in the text.
struct LikelihoodLines {
  std::string column, family;
  const LogLocationScale* named = nullptr;  // if the study has the family by that name
  std::vector<std::string> lines;           // of the whole study
  std::size_t begin = 0, end = 0;           // after its heading, to the next
};

std::string key_of(const std::string& line) {
  const std::size_t equals = line.find('=');
  return equals == line.npos ? std::string() : boost::algorithm::trim_copy(line.substr(0, equals));
}

[[noreturn]] void refuse_layout(const TomlReader& likelihood, const std::string& column) {
  likelihood.fail(column,
                  fmt::format("must be a table [likelihood.{}] with a line for each key, so "
                              "that its family can be exchanged",
                              column));
}

// The family of the parameters: of a list, the first.
std::string family_of(const TomlReader& table) {
  if (!table.has("family")) table.fail("family", "is missing");
  if (!table.is_text("family")) {
    const std::vector<std::string> listed = table.texts("family");
    if (listed.empty()) table.fail("family", "is an empty list");
    return listed.front();
  }
  std::string family = table.required_text("family");
  if (family == "best" || family == "all" || family == "auto")
    table.fail("family", fmt::format("\"{}\" does not say which family the parameters belong to; "
                                     "write that family, --families names those to rank",
                                     family));
  return family;
}

const LogLocationScale* named_by_standard(const TomlReader& table) {
  const std::string standard = table.required_text("standard");
  for (const LogLocationScale& each : log_location_scale_families)
    if (each.standard == standard) return &each;
  table.fail("standard", fmt::format("'{}' is none of the distributions of a {} family", standard,
                                     LogLocationScale::name));
}

// Distributions beside the one that is exchanged would stay and blur the ranking.
void refuse_own_families(const TomlReader& root) {
  for (const char* const section : {"failure_modes", "subpopulations"}) {
    const auto table = root.table(section);
    if (!table) continue;
    std::vector<std::string> own;
    for (const std::string& key : table->keys()) {
      if (key == "share" || key == "column" || key == "names" || key == "runout" ||
          key == "unknown")
        continue;
      own.push_back(fmt::format("[{}.{}]", section, key));
    }
    if (!own.empty())
      root.fail(
          section,
          fmt::format("has families beside that of [likelihood]: {}. --families "
                      "exchanges one family; write parameters of each, as in "
                      "scale[{}], or fit one study for each combination and compare "
                      "the results",
                      fmt::join(own, ", "),
                      std::string_view(section) == "failure_modes" ? "mode" : "subpopulation"));
  }
}

// A value that goes on in the next line cannot be exchanged by lines.
void refuse_long_value(const Source& study, const TomlReader& table, const std::string& line,
                       const std::string& key) {
  bool whole = true;
  try {
    TomlReader::parse({study.study.path, line});
  } catch (const InputError&) {
    whole = false;
  }
  if (!whole)
    table.fail(key,
               "goes over several lines; write it in one line, so that its family can be "
               "exchanged");
}

// Presets have families of their own, without parameters in the study.
void refuse_presets(const TomlReader& root) {
  if (root.has("model") && root.is_text("model") && root.required_text("model") != "formula")
    root.fail("model",
              "--families ranks distributions of lives under model \"formula\"; fit other models "
              "with each family and compare the results");
}

LikelihoodLines likelihood_lines(const Source& study) {
  const TomlReader root = TomlReader::parse(study.study);
  refuse_presets(root);
  refuse_own_families(root);
  const TomlReader likelihood = root.required_table("likelihood");
  if (likelihood.keys().size() != 1)
    root.fail("likelihood", "needs one measured column to rank families of it");
  LikelihoodLines found{likelihood.keys().front(), {}, nullptr, {}, 0, 0};
  const TomlReader table = likelihood.required_table(found.column);
  found.family = family_of(table);
  if (found.family == LogLocationScale::name) {
    found.named = named_by_standard(table);
    found.family = found.named->family;
  }
  if (std::find(std::begin(families), std::end(families), found.family) == std::end(families))
    table.fail("family", fmt::format("is not one of the families that can be ranked: {}",
                                     fmt::join(families, ", ")));
  std::istringstream text(study.study.text);
  for (std::string line; std::getline(text, line);) found.lines.push_back(line);
  const std::string heading = fmt::format("[likelihood.{}]", found.column);
  for (std::size_t i = 0; i < found.lines.size(); ++i) {
    if (!boost::algorithm::trim_copy(found.lines[i]).starts_with(heading)) continue;
    found.begin = i + 1;
    found.end = i + 1;
    while (found.end < found.lines.size() &&
           !boost::algorithm::trim_copy(found.lines[found.end]).starts_with("["))
      ++found.end;
  }
  std::size_t keys = 0;
  for (std::size_t i = found.begin; i < found.end; ++i) {
    const std::string key = key_of(found.lines[i]);
    if (key.empty() || !table.has(key)) continue;
    refuse_long_value(study, table, found.lines[i], key);
    ++keys;
  }
  if (found.begin == 0 || keys != table.keys().size()) refuse_layout(likelihood, found.column);
  return found;
}

// A parameter of the family, in brackets.
std::string parameter(const TomlReader& table, const char* name) {
  if (!table.has(name)) table.fail(name, "is missing");
  return table.is_text(name) ? fmt::format("({})", table.required_text(name))
                             : fmt::format("({})", table.required_quantity(name, "1").si());
}

// Mean of an inverse Gaussian life over exp(mean of log life), of mean/shape = r: exp(exp(x) E1(x)) with x = 2/r, by
// 1 + (x + a)/(x (x + b)), which has the limits of small and large x.
std::string mean_to_middle(const std::string& r) {
  return fmt::format("(1 + {0}*(1 + 0.3201*{0})/(2 + 1.1402*{0}))", r);
}

// Mean and standard deviation of log life, of a scale and the sigma of its logarithm.
LogMoments moments_of_sigma(const LogLocationScale& named, const std::string& scale,
                            const std::string& sigma) {
  if (named.standard == "normal") return {scale, sigma};
  if (named.standard == "logistic") return {scale, fmt::format("1.8137993642*{}", sigma)};
  const char sign = named.standard == "smallest extreme value" ? '-' : '+';
  return {fmt::format("{} * exp({}0.5772156649*{})", scale, sign == '-' ? "-" : "", sigma),
          fmt::format("1.2825498302*{}", sigma)};
}

LogMoments moments_of(const TomlReader& table, const LikelihoodLines& found) {
  const std::string& family = found.family;
  const auto of = [&](const char* name) { return parameter(table, name); };
  if (found.named) return moments_of_sigma(*found.named, of("scale"), of("sigma"));
  if (family == "frechet")
    return {fmt::format("{} * exp(0.5772156649/{})", of("scale"), of("shape")),
            fmt::format("1.2825498302/{}", of("shape"))};
  if (family == "weibull")
    return {fmt::format("{} * exp(-0.5772156649/{})", of("scale"), of("shape")),
            fmt::format("1.2825498302/{}", of("shape"))};
  if (family == "lognormal" && table.has("median")) return {of("median"), of("log_sd")};
  if (family == "loglogistic") return {of("scale"), fmt::format("1.8137993642/{}", of("shape"))};
  if (family == "gamma")
    return {fmt::format("{} * exp(digamma{})", of("scale"), of("shape")),
            fmt::format("sqrt((1 + sqrt(1 + 4*{0}^2))/(2*{0}^2))", of("shape"))};
  if (family == "inverse-gaussian") {
    const std::string ratio = fmt::format("({}/{})", of("mean"), of("shape"));
    return {fmt::format("{}/{}", of("mean"), mean_to_middle(ratio)),
            fmt::format("sqrt(log1p{})", ratio)};
  }
  table.fail("family",
             fmt::format(
                 "cannot be the first of a ranking with these parameters; start from weibull, "
                 "lognormal (median and log_sd), loglogistic, frechet, gamma or inverse-gaussian"));
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
  if (family == "frechet")
    return {{"scale", fmt::format("{} * exp(-0.4500532075*{})", m, s)},
            {"shape", fmt::format("1.2825498302/{}", s)}};
  if (family == "lognormal") return {{"median", m}, {"log_sd", s}};
  if (family == "loglogistic") return {{"scale", m}, {"shape", fmt::format("1.8137993642/{}", s)}};
  if (family == "gamma") {
    // trigamma(k) = s^2: 1/k^2 for small k, 1/k + 1/(2 k^2) for large k.
    const std::string k = fmt::format("(sqrt(1 + {0}^2)/{0}^2)", s);
    return {{"shape", k}, {"scale", fmt::format("{} * exp(-digamma({}))", m, k)}};
  }
  if (family == "inverse-gaussian") {
    const std::string ratio = fmt::format("expm1({}^2)", s);
    const std::string mean = fmt::format("{} * {}", m, mean_to_middle(ratio));
    return {{"mean", mean}, {"shape", fmt::format("{}/{}", mean, ratio)}};
  }
  // sd of 2 asinh(shape z/2), z standard normal, is s.
  if (family == "birnbaum-saunders")
    return {{"scale", m},
            {"shape",
             fmt::format("(exp({0}/2) - exp(-{0}/2))*(1 + 0.258*{0}^2)/(1 + 0.1747*{0}^2)", s)}};
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

std::string written_family(const Source& study) {
  return likelihood_lines(study).family;
}

std::string family_priors(std::string_view written, std::span<const std::string> names) {
  std::vector<std::string> exact, near, wider;
  for (const std::string& each : names) {
    if (each == written) continue;
    if (each == "generalized-gamma" || each == "exponentiated-weibull") {
      wider.push_back(each == "generalized-gamma"
                          ? "generalized-gamma with family_lambda ~ normal(0.5, 1), 0 is lognormal"
                          : "exponentiated-weibull with family_exponent ~ lognormal(1, 0.7), 1 is "
                            "weibull");
    } else {
      const bool closed =
          each == "weibull" || each == "lognormal" || each == "loglogistic" || each == "frechet";
      const bool from = written != "gamma" && written != "inverse-gaussian";
      (closed && from ? exact : near).push_back(each);
    }
  }
  std::string text =
      fmt::format("Parameters are those of {} lives, the family of the study", written);
  if (!exact.empty())
    text += fmt::format("; {} lives have the same mean and sd of log life", fmt::join(exact, ", "));
  if (!near.empty())
    text +=
        fmt::format("; {} lives roughly the same mean and sd of log life", fmt::join(near, ", "));
  if (!wider.empty())
    text += fmt::format("; a further parameter makes the prior of lives wider: {}",
                        fmt::join(wider, "; "));
  return text + ".";
}

Source study_with_family(const Source& study, std::string_view family) {
  if (std::find(std::begin(families), std::end(families), family) == std::end(families))
    throw InputError(fmt::format("--families: '{}' cannot be ranked; possible are {}", family,
                                 fmt::join(families, ", ")));
  LikelihoodLines found = likelihood_lines(study);
  const TomlReader root = TomlReader::parse(study.study);
  const TomlReader table = root.required_table("likelihood").required_table(found.column);
  const bool same = found.family == family;
  const LogMoments log = same ? LogMoments{} : moments_of(table, found);
  const auto parameters =
      same ? std::vector<std::pair<std::string, std::string>>() : parameters_of(family, log);
  // A new parameter takes the line of an old one, so that messages name the lines of the study.
  std::size_t written = 0;
  const auto next = [&] {
    const auto& [name, value] = parameters[written++];
    return fmt::format("{} = {}\n", name, toml_text(value));
  };
  std::string text;
  for (std::size_t i = 0; i < found.lines.size(); ++i) {
    const std::string key = i >= found.begin && i < found.end ? key_of(found.lines[i]) : "";
    const auto among = [&](const auto& keys) {
      return std::find(std::begin(keys), std::end(keys), key) != std::end(keys);
    };
    const bool replaced = !same && (among(two_parameters) || (found.named && among(by_standard)));
    if (key == "family" && !(same && found.named)) {
      text += fmt::format("family = {}\n", toml_text(std::string(family)));
    } else if (replaced && written < parameters.size()) {
      text += next();
      while (written == 2 && written < parameters.size()) text += next();
    } else if (!replaced) {
      text += found.lines[i] + "\n";
    }
  }
  Source other = study;
  other.study.text = text + (same ? "" : third_prior(family));
  return other;
}

}  // namespace wearwell
