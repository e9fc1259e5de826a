#include "wearwell/study/clutch_model_file.h"

#include <fmt/format.h>

#include <fstream>

#include "wearwell/base/error.h"

namespace wearwell::clutch {
namespace {

using Json = nlohmann::ordered_json;
using Eigen::Index;

constexpr int model_version = 1, state_version = 1;
constexpr const char* model_format = "wearwell clutch wear model";
constexpr const char* state_format = "wearwell clutch wear state";

Json to_json(const OperatingPoint& at) {
  Json json;
  for (const Input& input : inputs) json[input.name] = at.*input.value;
  return json;
}

OperatingPoint read_point(const Json& json) {
  OperatingPoint at;
  for (const Input& input : inputs) at.*input.value = json.at(input.name).get<double>();
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

Eigen::MatrixXd read_matrix(const Json& json, Index size) {
  if (std::ssize(json) != size) throw InputError("a covariance has the wrong size");
  Eigen::MatrixXd matrix(size, size);
  for (Index i = 0; i < size; ++i) {
    const Json& row = json.at(static_cast<std::size_t>(i));
    if (std::ssize(row) != size) throw InputError("a covariance has the wrong size");
    for (Index j = 0; j < size; ++j)
      matrix(i, j) = row.at(static_cast<std::size_t>(j)).get<double>();
  }
  return matrix;
}

Json to_json(const RunIn& run_in) {
  return {{"slow", run_in.slow},
          {"fast", run_in.fast},
          {"slow_energy", run_in.slow_energy},
          {"fast_energy", run_in.fast_energy}};
}

RunIn read_run_in(const Json& json) {
  const RunIn run_in{json.at("slow").get<double>(), json.at("fast").get<double>(),
                     json.at("slow_energy").get<double>(), json.at("fast_energy").get<double>()};
  if (!(run_in.slow >= 0 && run_in.fast >= 0 && run_in.slow_energy > 0 && run_in.fast_energy > 0))
    throw InputError("the run-in must not be negative, and its energies must be positive");
  return run_in;
}

/// get<int> would cut off what does not fit.
int whole(const Json& json, const char* name) {
  const Json& value = json.at(name);
  if (!value.is_number_integer() || value.get<double>() != value.get<int>())
    throw InputError(fmt::format("{} must be a whole number up to 2147483647", name));
  return value.get<int>();
}

int power(const Json& json, const char* name) {
  const int n = whole(json, name);
  if (n < 0 || n > 3) throw InputError(fmt::format("the power of {} must be 0 to 3", name));
  return n;
}

void require_cubic(int ds, int temperature, int torque) {
  if (ds + temperature + torque > 3) throw InputError("a term has a degree above 3");
}

Json to_json(const WearPolynomial& w) {
  Json monomials = Json::array();
  for (const auto& m : w.monomials)
    monomials.push_back(
        {{"ds", m.ds}, {"Td", m.temperature}, {"Mz", m.torque}, {"coefficient", m.coefficient}});
  return {{"r", w.r}, {"q", w.q}, {"monomials", std::move(monomials)}};
}

WearPolynomial read_polynomial(const Json& json) {
  WearPolynomial w{json.at("r").get<double>(), json.at("q").get<double>(), {}};
  for (const Json& m : json.at("monomials")) {
    w.monomials.push_back(
        {power(m, "ds"), power(m, "Td"), power(m, "Mz"), m.at("coefficient").get<double>()});
    require_cubic(w.monomials.back().ds, w.monomials.back().temperature, w.monomials.back().torque);
  }
  return w;
}

Json parse(const std::filesystem::path& file, const char* format, int version) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) throw InputError("it is a folder, not a file");
  std::ifstream stream(file);
  if (!stream) throw InputError("cannot read it; is it there?");
  const Json json = Json::parse(stream);
  if (!json.is_object() || json.value("format", "") != format)
    throw InputError(fmt::format("it is no {}", format));
  if (json.at("version").get<int>() != version)
    throw InputError(fmt::format("it has version {}, this program reads version {}",
                                 json.at("version").get<int>(), version));
  return json;
}

/// Runs `read` and names the file in what it throws.
template <class F>
auto naming(const std::filesystem::path& file, const F& read) {
  try {
    return read();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
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

WearModel read_model(const std::filesystem::path& file) {
  return naming(file, [&] {
    const Json json = parse(file, model_format, model_version);
    WearModel model;
    model.title = json.at("title").get<std::string>();
    const Json& map = json.at("map");
    model.r = map.at("r").get<double>();
    model.q = map.at("q").get<double>();
    for (const Json& term : map.at("terms")) {
      model.terms.push_back({term.at("name").get<std::string>(), power(term, "ds"),
                             power(term, "Td"), power(term, "Mz"), term.at("minimum").get<double>(),
                             term.at("range").get<double>(), term.at("coefficient").get<double>()});
      const ModelTerm& t = model.terms.back();
      require_cubic(t.ds, t.temperature, t.torque);
      if (!(t.range > 0)) throw InputError("the range of a term must be positive");
    }
    model.covariance = read_matrix(map.at("covariance"), std::ssize(model.terms));
    model.run_in = read_run_in(json.at("run_in"));
    model.run_in_covariance = read_matrix(json.at("run_in_covariance"), 4);
    const Json& scatter = json.at("scatter");
    model.scatter = {read_scatter_kind(scatter.at("kind").get<std::string>()),
                     scatter.at("p").get<std::vector<double>>()};
    if (std::ssize(model.scatter.p) != size_of(model.scatter.kind))
      throw InputError("the scatter has the wrong number of parameters");
    model.scatter_floor = scatter.at("floor").get<double>();
    model.plate_sd = json.at("plate_sd").get<double>();
    model.lowest = read_point(json.at("validity").at("lowest"));
    model.highest = read_point(json.at("validity").at("highest"));
    model.worn_out = json.at("worn_out").get<double>();
    for (const Json& each : json.at("replicates"))
      model.replicates.push_back({read_polynomial(each.at("w")), read_run_in(each.at("run_in"))});
    return model;
  });
}

std::string state_text(const std::vector<PlateWear>& plates, const std::string& model) {
  Json list = Json::array();
  for (const PlateWear& p : plates) {
    list.push_back({{"plate", p.plate},
                    {"cycles", p.cycles},
                    {"last_cycle", p.last_number},
                    {"energy", p.energy},
                    {"volume", p.volume},
                    {"variance", p.variance},
                    {"outside", p.outside},
                    {"outside_any", p.outside_any},
                    {"clamped", p.clamped},
                    {"replicates", std::vector<double>(p.replicates.begin(), p.replicates.end())}});
  }
  const Json json = {{"format", state_format},
                     {"version", state_version},
                     {"model", model},
                     {"plates", std::move(list)}};
  return json.dump(1) + "\n";
}

std::vector<PlateWear> read_state(const std::filesystem::path& file, const std::string& model,
                                  std::size_t replicates) {
  return naming(file, [&] {
    const Json json = parse(file, state_format, state_version);
    if (json.at("model").get<std::string>() != model)
      throw InputError("the state belongs to another model");
    std::vector<PlateWear> plates;
    for (const Json& each : json.at("plates")) {
      PlateWear p;
      p.plate = whole(each, "plate");
      p.cycles = each.at("cycles").get<long long>();
      p.last_number = each.at("last_cycle").get<long long>();
      p.energy = each.at("energy").get<double>();
      p.volume = each.at("volume").get<double>();
      p.variance = each.at("variance").get<double>();
      p.outside = each.at("outside").get<std::array<long long, 4>>();
      p.outside_any = each.at("outside_any").get<long long>();
      p.clamped = each.at("clamped").get<long long>();
      const auto volumes = each.at("replicates").get<std::vector<double>>();
      if (volumes.size() != replicates)
        throw InputError(fmt::format(
            "it holds {} replicates and {} are wanted: go on as the state was made, with or "
            "without --scatter-only",
            volumes.size(), replicates));
      p.replicates = Eigen::Map<const Eigen::ArrayXd>(volumes.data(), std::ssize(volumes));
      plates.push_back(std::move(p));
    }
    return plates;
  });
}

}  // namespace wearwell::clutch
