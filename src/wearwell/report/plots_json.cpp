#include "wearwell/report/plots_json.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

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
    io("badges", each.badges);
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
  JsonReader json;

  template <class T>
  void operator()(const char* name, T& value) const {
    read(json.at(name), value);
  }

  static void read(const JsonReader& json, double& value) { value = json.number_or(std::nan("")); }
  static void read(const JsonReader& json, bool& value) { value = json.flag(); }
  static void read(const JsonReader& json, std::string& value) { value = json.text(); }
  // A plot: what a page makes of it, it makes of its layers.
  static void read(const JsonReader& json, Json& value) {
    json.at("layer").items();
    value = json.json();
  }
  static void read(const JsonReader& json, std::vector<double>& values) {
    values = json.numbers_or(std::nan(""));
  }
  template <class T>
  static void read(const JsonReader& json, std::map<std::string, T>& values) {
    for (const auto& [name, value] : json.members()) read(value, values[name]);
  }
  template <class T>
  static void read(const JsonReader& json, std::vector<T>& values) {
    for (const JsonReader& each : json.items()) read(each, values.emplace_back());
  }
  template <class T>
  static void read(const JsonReader& json, std::optional<T>& value) {
    if (!json.is_null()) read(json, value.emplace());
  }
  template <class T>
  static void read(const JsonReader& json, T& value) {
    const Reader reader{json};
    fields(reader, value);
  }
};

// Says which columns of a plot have the wrong length.
class Lengths {
 public:
  explicit Lengths(const std::filesystem::path& file) : file_(file.string()) {}

  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw InputError(fmt::format("{} is not what wearwell writes: {} {}", file_, key, what));
  }
  void require(const std::string& key, std::size_t length, std::size_t wanted) const {
    if (length != wanted)
      fail(key, fmt::format("should hold {} values, and holds {}", wanted, length));
  }
  void least(const std::string& key, std::size_t length, std::size_t wanted) const {
    if (length < wanted)
      fail(key, fmt::format("should hold {} or more, and holds {}", wanted, length));
  }
  void curve(const std::string& key, const Curve& curve) const {
    least(key + ".x", curve.x.size(), 1);
    require(key + ".y", curve.y.size(), curve.x.size());
  }
  void history(const std::string& key, const History& h) const {
    for (const auto* column : {&h.mean, &h.ci05, &h.ci95, &h.pi05, &h.pi95}) {
      require(key, column->size(), h.at.size());
    }
  }

 private:
  std::string file_;
};

}  // namespace

Json to_json(const Plots& plots) {
  return Writer::of(plots);
}

Plots plots_from_json(const JsonReader& json) {
  Plots plots;
  Reader::read(json, plots);
  return plots;
}

void require_consistent(const Plots& plots, const StudyResult& result,
                        const std::filesystem::path& file) {
  const Lengths lengths(file);
  lengths.require("parameters", plots.parameters.size(), result.parameters.size());
  for (std::size_t i = 0; i < plots.parameters.size(); ++i) {
    const ParameterPlots& p = plots.parameters[i];
    const std::string key = fmt::format("parameters[{}].", i);
    lengths.least(key + "histogram.edges", p.histogram.edges.size(), 2);
    lengths.require(key + "histogram.density", p.histogram.density.size(),
                    static_cast<std::size_t>(result.chains));
    for (const auto& chain : p.histogram.density) {
      lengths.require(key + "histogram.density[]", chain.size(), p.histogram.edges.size() - 1);
    }
    if (p.exact) lengths.curve(key + "exact", *p.exact);
    lengths.curve(key + "prior", p.prior);
  }
  if (plots.joint) {
    const DensityGrid& grid = *plots.joint;
    lengths.least("joint.x", grid.x.size(), 2);
    lengths.least("joint.y", grid.y.size(), 2);
    lengths.require("joint.density", grid.density.size(), grid.x.size() * grid.y.size());
  }
  for (const Curve& curve : plots.stages) lengths.curve("stages[]", curve);
  if (!plots.stages.empty()) lengths.require("stages", plots.stages.size(), result.stages.size());
  lengths.history("history", plots.history);
  lengths.history("replicated", plots.replicated);
  lengths.require("measured", plots.measured.size(), plots.replicated.at.size());
  lengths.require("history_at", plots.history_at.size(), plots.measured.size());
  if (plots.life) lengths.curve("life", *plots.life);
  lengths.least("files", plots.files.size(), 1);
  for (const auto& [section, exhibits] : plots.exhibits) {
    for (const html::Table& table : exhibits.tables) {
      for (const auto& row : table.rows) {
        lengths.require(fmt::format("exhibits.{}.tables[].rows[]", printable(shortened(section))),
                        row.size(), table.heading.size());
      }
    }
  }
}

}  // namespace wearwell
