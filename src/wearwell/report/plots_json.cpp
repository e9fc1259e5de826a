#include "wearwell/report/plots_json.h"

#include <cmath>

namespace wearwell {
namespace {

using Json = nlohmann::ordered_json;

// The fields of every struct are listed once, for both directions.
template <class Io, class T>
void fields(Io& io, T& each) {
  using Struct = std::remove_const_t<T>;
  if constexpr (std::is_same_v<Struct, Curve>) {
    io("x", each.x);
    io("y", each.y);
  } else if constexpr (std::is_same_v<Struct, Histogram>) {
    io("edges", each.edges);
    io("density", each.density);
  } else if constexpr (std::is_same_v<Struct, ParameterPlots>) {
    io("meaning", each.meaning);
    io("prior_in_words", each.prior_in_words);
    io("histogram", each.histogram);
    io("exact", each.exact);
    io("prior", each.prior);
  } else if constexpr (std::is_same_v<Struct, DensityGrid>) {
    io("x", each.x);
    io("y", each.y);
    io("density", each.density);
  } else if constexpr (std::is_same_v<Struct, History>) {
    io("at", each.at);
    io("mean", each.mean);
    io("ci05", each.ci05);
    io("ci95", each.ci95);
    io("pi05", each.pi05);
    io("pi95", each.pi95);
  } else if constexpr (std::is_same_v<Struct, DataFile>) {
    io("name", each.name);
    io("sha1", each.sha1);
  } else if constexpr (std::is_same_v<Struct, html::Figure>) {
    io("id", each.id);
    io("title", each.title);
    io("caption", each.caption);
    io("specification", each.specification);
  } else if constexpr (std::is_same_v<Struct, html::Table>) {
    io("caption", each.caption);
    io("heading", each.heading);
    io("rows", each.rows);
    io("words", each.words);
  } else if constexpr (std::is_same_v<Struct, Exhibits>) {
    io("figures", each.figures);
    io("tables", each.tables);
  } else {
    static_assert(std::is_same_v<Struct, Plots>);
    io("quantity", each.quantity);
    io("unit", each.unit);
    io("at_name", each.at_name);
    io("parameters", each.parameters);
    io("joint", each.joint);
    io("stages", each.stages);
    io("history", each.history);
    io("history_at", each.history_at);
    io("history_note", each.history_note);
    io("replicated", each.replicated);
    io("measured", each.measured);
    io("life", each.life);
    io("study_text", each.study_text);
    io("files", each.files);
    io("seconds", each.seconds);
    io("exhibits", each.exhibits);
  }
}

struct Writer {
  Json json = Json::object();

  template <class T>
  void operator()(const char* name, const T& value) {
    json[name] = of(value);
  }

  static Json of(double value) { return value; }
  static Json of(bool value) { return value; }
  static Json of(const std::string& value) { return value; }
  static Json of(const Json& value) { return value; }
  template <class T>
  static Json of(const std::map<std::string, T>& values) {
    Json object = Json::object();
    for (const auto& [name, value] : values) object[name] = of(value);
    return object;
  }
  template <class T>
  static Json of(const std::vector<T>& values) {
    Json array = Json::array();
    for (const T& value : values) array.push_back(of(value));
    return array;
  }
  template <class T>
  static Json of(const std::optional<T>& value) {
    return value ? of(*value) : Json();
  }
  template <class T>
  static Json of(const T& value) {
    Writer writer;
    fields(writer, value);
    return std::move(writer.json);
  }
};

struct Reader {
  const Json& json;

  template <class T>
  void operator()(const char* name, T& value) const {
    read(json.at(name), value);
  }

  static void read(const Json& json, double& value) {
    value = json.is_null() ? std::nan("") : json.get<double>();
  }
  static void read(const Json& json, bool& value) { value = json.get<bool>(); }
  static void read(const Json& json, std::string& value) { value = json.get<std::string>(); }
  static void read(const Json& json, Json& value) { value = json; }
  template <class T>
  static void read(const Json& json, std::map<std::string, T>& values) {
    for (const auto& [name, value] : json.items()) read(value, values[name]);
  }
  template <class T>
  static void read(const Json& json, std::vector<T>& values) {
    values.resize(json.get_ref<const Json::array_t&>().size());
    for (std::size_t i = 0; i < values.size(); ++i) read(json[i], values[i]);
  }
  template <class T>
  static void read(const Json& json, std::optional<T>& value) {
    if (!json.is_null()) read(json, value.emplace());
  }
  template <class T>
  static void read(const Json& json, T& value) {
    const Reader reader{json};
    fields(reader, value);
  }
};

}  // namespace

Json to_json(const Plots& plots) {
  return Writer::of(plots);
}

Plots plots_from_json(const Json& json) {
  Plots plots;
  Reader::read(json, plots);
  return plots;
}

}  // namespace wearwell
