#include "wearwell/models/clutch/clutch_model_file.h"

#include <fmt/format.h>

#include <limits>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/fingerprint.h"
#include "wearwell/input/json_reader.h"

namespace wearwell::clutch {
namespace {

using Json = nlohmann::ordered_json;
using Eigen::Index;

constexpr int model_version = 1, state_version = 2;
constexpr const char* model_format = "wearwell clutch wear model";
constexpr const char* state_format = "wearwell clutch wear state";

Json to_json(const OperatingPoint& at) {
  Json json;
  for (const Input& input : inputs) json[input.name] = at.*input.value;
  return json;
}

OperatingPoint read_point(const JsonReader& json) {
  OperatingPoint at;
  for (const Input& input : inputs) at.*input.value = json.at(input.name).number();
  return at;
}

Json to_json(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

Eigen::MatrixXd read_matrix(const JsonReader& json, Index size) {
  const auto rows = json.items();
  if (std::ssize(rows) != size) json.fail("is invalid: a covariance has the wrong size");
  Eigen::MatrixXd matrix(size, size);
  for (Index i = 0; i < size; ++i) {
    const std::vector<double> row = rows[static_cast<std::size_t>(i)].numbers();
    if (std::ssize(row) != size) json.fail("is invalid: a covariance has the wrong size");
    matrix.row(i) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), size);
  }
  return matrix;
}

Json to_json(const RunIn& run_in) {
  return {{"slow", run_in.slow},
          {"fast", run_in.fast},
          {"slow_energy", run_in.slow_energy},
          {"fast_energy", run_in.fast_energy}};
}

RunIn read_run_in(const JsonReader& json) {
  const RunIn run_in{json.at("slow").number(), json.at("fast").number(),
                     json.at("slow_energy").number(), json.at("fast_energy").number()};
  if (!(run_in.slow >= 0 && run_in.fast >= 0 && run_in.slow_energy > 0 && run_in.fast_energy > 0))
    json.fail("must not be negative, and its energies must be positive");
  return run_in;
}

struct Powers {
  int ds, temperature, torque;
};

Powers read_powers(const JsonReader& json) {
  const auto power = [&](const char* name) {
    return static_cast<int>(json.at(name).integer(0, 3));
  };
  const Powers powers{power("ds"), power("Td"), power("Mz")};
  if (powers.ds + powers.temperature + powers.torque > 3) json.fail("has a degree above 3");
  return powers;
}

Json to_json(const WearPolynomial& w) {
  Json monomials = Json::array();
  for (const auto& m : w.monomials)
    monomials.push_back(
        {{"ds", m.ds}, {"Td", m.temperature}, {"Mz", m.torque}, {"coefficient", m.coefficient}});
  return {{"r", w.r}, {"q", w.q}, {"monomials", std::move(monomials)}};
}

WearPolynomial read_polynomial(const JsonReader& json) {
  WearPolynomial w{json.at("r").number(), json.at("q").number(), {}};
  for (const JsonReader& m : json.at("monomials").items()) {
    const Powers p = read_powers(m);
    w.monomials.push_back({p.ds, p.temperature, p.torque, m.at("coefficient").number()});
  }
  return w;
}

ModelTerm read_term(const JsonReader& json) {
  const Powers p = read_powers(json);
  ModelTerm term{json.at("name").text(),
                 p.ds,
                 p.temperature,
                 p.torque,
                 json.at("minimum").number(),
                 json.at("range").number(),
                 json.at("coefficient").number()};
  if (!(term.range > 0)) json.fail("is invalid: the range of a term must be positive");
  return term;
}

ScatterLaw read_scatter(const JsonReader& json) {
  const ScatterLaw law{
      [&] {
        try {
          return read_scatter_kind(json.at("kind").text());
        } catch (const InputError& error) {
          json.at("kind").fail(fmt::format("is invalid: {}", printable(error.what())));
        }
      }(),
      json.at("p").numbers()};
  if (std::ssize(law.p) != size_of(law.kind)) json.fail("has the wrong number of parameters");
  return law;
}

void check_format(const JsonReader& json, const std::filesystem::path& file, const char* format,
                  int version) {
  const auto name = json.json().is_object() ? json.find("format") : std::nullopt;
  if (!name || name->json() != Json(format))
    throw InputError(fmt::format("{}: it is not a {}", file.string(), format));
  const long long written = json.at("version").integer(0);
  if (written != version)
    throw InputError(fmt::format("{}: it has version {}, this program reads version {}",
                                 file.string(), written, version));
}

PlateWear read_plate(const JsonReader& json, std::size_t replicates) {
  PlateWear p;
  p.plate = static_cast<int>(
      json.at("plate").integer(std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
  if (const auto name = json.find("name")) p.name = name->text();
  p.cycles = json.at("cycles").integer(0);
  p.last_number = json.at("last_cycle").integer(0);
  p.energy = json.at("energy").number(0);
  p.closings = json.at("closings").number(0);
  if (const auto far = json.find("energy_outliers")) {  // missing in older states
    p.outliers.count = far->at("count").integer(0, p.cycles);
    p.outliers.worst_cycle = far->at("cycle").integer(0, p.last_number);
    p.outliers.worst_energy = far->at("energy").number(0);
    p.outliers.worst_ratio = far->at("ratio").number(0);
  }
  p.volume = json.at("volume").number(0);
  p.variance = json.at("variance").number(0);
  const auto outside = json.at("outside").items();
  if (outside.size() != p.outside.size())
    json.at("outside").fail(fmt::format("should be a list of {}", p.outside.size()));
  for (std::size_t i = 0; i < outside.size(); ++i) p.outside[i] = outside[i].integer(0, p.cycles);
  p.outside_any = json.at("outside_any").integer(0, p.cycles);
  p.clamped = json.at("clamped").integer(0, p.cycles);
  if (const auto skipped = json.find("skipped")) p.skipped = skipped->integer(0);
  const std::vector<double> volumes = json.at("replicates").numbers();
  if (volumes.size() != replicates)
    json.at("replicates")
        .fail(fmt::format("does not match: it has {} replicates, but {} are needed: continue with "
                          "the same options as before, with or without --scatter-only",
                          volumes.size(), replicates));
  p.replicates = Eigen::Map<const Eigen::ArrayXd>(volumes.data(), std::ssize(volumes));
  return p;
}

// The file itself, or that in a folder of results.
std::filesystem::path model_in(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) return path;
  const std::filesystem::path file = path / "model.json";
  if (std::filesystem::exists(file, ignored)) return file;
  throw InputError(fmt::format(
      "{} is a folder, not a file, and has no model.json, which wearwell fit writes for a clutch",
      path.string()));
}

WearModel model_of(const Json& content, const std::filesystem::path& file) {
  const JsonReader json(content, file);
  check_format(json, file, model_format, model_version);
  WearModel model;
  model.title = json.at("title").text();
  const JsonReader map = json.at("map");
  model.r = map.at("r").number();
  model.q = map.at("q").number();
  for (const JsonReader& term : map.at("terms").items()) model.terms.push_back(read_term(term));
  model.covariance = read_matrix(map.at("covariance"), std::ssize(model.terms));
  model.run_in = read_run_in(json.at("run_in"));
  model.run_in_covariance = read_matrix(json.at("run_in_covariance"), 4);
  model.scatter = read_scatter(json.at("scatter"));
  model.scatter_floor = json.at("scatter").at("floor").number(0);
  model.plate_sd = json.at("plate_sd").number(0);
  const JsonReader validity = json.at("validity");
  model.lowest = read_point(validity.at("lowest"));
  model.highest = read_point(validity.at("highest"));
  for (const Input& input : inputs) {
    if (!(model.lowest.*input.value <= model.highest.*input.value))
      validity.fail(fmt::format("has a minimum {0} above its maximum {0}", input.name));
  }
  model.worn_out = json.at("worn_out").positive();
  for (const JsonReader& each : json.at("replicates").items())
    model.replicates.push_back({read_polynomial(each.at("w")), read_run_in(each.at("run_in"))});
  return model;
}

}  // namespace

nlohmann::ordered_json to_json(const WearModel& model) {
  Json terms = Json::array();
  for (const ModelTerm& term : model.terms) {
    terms.push_back({{"name", term.name},
                     {"ds", term.ds},
                     {"Td", term.temperature},
                     {"Mz", term.torque},
                     {"minimum", term.minimum},
                     {"range", term.range},
                     {"coefficient", term.coefficient}});
  }
  Json replicates = Json::array();
  for (const Replicate& replicate : model.replicates)
    replicates.push_back({{"w", to_json(replicate.w)}, {"run_in", to_json(replicate.run_in)}});
  return {
      {"format", model_format},
      {"version", model_version},
      {"title", model.title},
      {"units",
       "SI; temperatures in degrees Celsius; wear rates and scatter in m^3/J; ds = slip_speed^r "
       "closing_time^q; x' = (x - minimum)/range"},
      {"map",
       {{"r", model.r},
        {"q", model.q},
        {"terms", std::move(terms)},
        {"covariance", to_json(model.covariance)}}},
      {"run_in", to_json(model.run_in)},
      {"run_in_covariance", to_json(Eigen::MatrixXd(model.run_in_covariance))},
      {"scatter",
       {{"kind", name_of(model.scatter.kind)},
        {"p", model.scatter.p},
        {"floor", model.scatter_floor}}},
      {"plate_sd", model.plate_sd},
      {"validity", {{"lowest", to_json(model.lowest)}, {"highest", to_json(model.highest)}}},
      {"worn_out", model.worn_out},
      {"replicates", std::move(replicates)}};
}

WearModel read_model(const std::filesystem::path& path) {
  const std::filesystem::path file = model_in(path);
  return model_of(read_json(file), file);
}

WearModel read_model_text(const std::string& text, const std::filesystem::path& name) {
  const Json content = Json::parse(text, nullptr, false);
  if (content.is_discarded()) throw InputError(fmt::format("{}: is not JSON", name.string()));
  return model_of(content, name);
}

IdentifiedModel read_identified_model(const std::filesystem::path& path) {
  const ReadFile read(model_in(path));
  WearModel model = read_model(path);
  std::string id = read.sha1();
  if (id.empty())
    throw InputError(
        fmt::format("a state needs a model in a file, and {} is not one", path.string()));
  return {std::move(model), std::move(id)};
}

std::string state_text(const std::vector<PlateWear>& plates, const std::string& model) {
  Json list = Json::array();
  for (const PlateWear& p : plates) {
    list.push_back({{"plate", p.plate},
                    {"cycles", p.cycles},
                    {"last_cycle", p.last_number},
                    {"energy", p.energy},
                    {"closings", p.closings},
                    {"energy_outliers",
                     {{"count", p.outliers.count},
                      {"cycle", p.outliers.worst_cycle},
                      {"energy", p.outliers.worst_energy},
                      {"ratio", p.outliers.worst_ratio}}},
                    {"volume", p.volume},
                    {"variance", p.variance},
                    {"outside", p.outside},
                    {"outside_any", p.outside_any},
                    {"clamped", p.clamped},
                    {"skipped", p.skipped},
                    {"replicates", std::vector<double>(p.replicates.begin(), p.replicates.end())}});
    if (!p.name.empty()) list.back()["name"] = p.name;
  }
  const Json json = {{"format", state_format},
                     {"version", state_version},
                     {"model", model},
                     {"plates", std::move(list)}};
  return printable_json(json.dump(1)) + "\n";
}

std::vector<PlateWear> read_state(const std::filesystem::path& file, const std::string& model,
                                  std::size_t replicates) {
  const Json content = read_json(file);
  const JsonReader json(content, file);
  check_format(json, file, state_format, state_version);
  if (json.at("model").text() != model)
    throw InputError(fmt::format("{}: the state belongs to another model", file.string()));
  std::vector<PlateWear> plates;
  std::set<int> seen;
  for (const JsonReader& each : json.at("plates").items()) {
    plates.push_back(read_plate(each, replicates));
    if (!seen.insert(plates.back().plate).second)
      each.fail(fmt::format("is plate {} a second time", plates.back().plate));
  }
  return plates;
}

}  // namespace wearwell::clutch
