#include "wearwell/models/fatigue/history_state.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/json_reader.h"

namespace wearwell::fatigue {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format_name = "wearwell rainflow state";
constexpr int version = 1;
constexpr long long most = 1LL << 62;
constexpr long long most_cell = 1LL << 30;

Json to_json(const CycleClasses& classes) {
  Json cells = Json::array();
  for (const CycleClasses::Cell& c : classes.cells())
    cells.push_back(
        {c.range, c.mean, c.count, c.first_range, c.first_mean, c.more_range, c.more_mean});
  return {{"width", classes.width()}, {"cells", std::move(cells)}};
}

CycleClasses read_classes(const JsonReader& json, double wanted) {
  std::vector<CycleClasses::Cell> cells;
  const double width = json.at("width").number(0);
  for (const JsonReader& each : json.at("cells").items()) {
    const auto c = each.items();
    if (c.size() != 7) each.fail("should be a list of 7");
    cells.push_back({static_cast<std::int32_t>(c[0].integer(0, most_cell)),
                     static_cast<std::int32_t>(c[1].integer(-most_cell, most_cell)),
                     c[2].positive(), c[3].positive(), c[4].number(), c[5].number(),
                     c[6].number()});
  }
  if (width == 0 && !cells.empty()) json.at("width").fail("must be positive");
  return {wanted, width, std::move(cells)};
}

std::vector<long long> read_counts(const JsonReader& json) {
  std::vector<long long> counts;
  for (const JsonReader& each : json.items()) counts.push_back(each.integer(-most, most));
  return counts;
}

LevelCrossings read_levels(const JsonReader& json, double wanted) {
  LevelCrossings::State state{wanted, json.at("width").number(0),
                              json.at("first").integer(-most, most), read_counts(json.at("up")),
                              read_counts(json.at("down"))};
  if (state.up.size() != state.down.size()) json.fail("has lists of different lengths");
  if (state.width == 0 && !state.up.empty()) json.at("width").fail("must be positive");
  return LevelCrossings(std::move(state));
}

}  // namespace

const char* counting_name(Counting counting) {
  return counting == Counting::three_point ? "three-point" : "four-point";
}

const char* residual_name(Residual residual) {
  return residual == Residual::half ? "half" : "repeat";
}

std::string state_text(const SavedHistory& saved) {
  const LoadHistory::State& s = saved.state;
  const LevelCrossings::State& levels = s.levels.state();
  Json json = {
      {"format", format_name},
      {"version", version},
      {"column", saved.column},
      {"unit", saved.unit},
      {"method", counting_name(s.rule.counting)},
      {"residual", residual_name(s.rule.residual)},
      {"class_width", s.rule.class_width},
      {"samples", s.samples},
      {"reversals", s.reversals},
      {"lowest", s.lowest},
      {"highest", s.highest},
      {"turn", {{"begun", s.turn.begun}, {"direction", s.turn.direction}, {"last", s.turn.last}}},
      {"open", s.open},
      {"classes", to_json(s.classes)},
      {"levels",
       {{"width", levels.width},
        {"first", levels.first},
        {"up", levels.up},
        {"down", levels.down}}}};
  if (s.point) json["point"] = *s.point;
  return printable_json(json.dump(-1, ' ', false, Json::error_handler_t::replace)) + "\n";
}

SavedHistory read_history_state(const std::filesystem::path& file) {
  const auto text = read_json(file);
  const JsonReader json(text, file);
  const auto name = text.is_object() ? json.find("format") : std::nullopt;
  if (!name || name->json() != Json(format_name))
    throw InputError(fmt::format("{} is not a state of wearwell fatigue rainflow", file.string()));
  if (json.at("version").integer(0) != version)
    throw InputError(
        fmt::format("{} has the format of another version of wearwell", file.string()));
  CountingRule rule;
  rule.counting = json.at("method").one_of({"three-point", "four-point"}) == "three-point"
                      ? Counting::three_point
                      : Counting::four_point;
  rule.residual =
      json.at("residual").one_of({"half", "repeat"}) == "half" ? Residual::half : Residual::repeat;
  rule.class_width = json.at("class_width").number(0);
  const JsonReader turn = json.at("turn");
  std::optional<double> point;
  if (const auto found = json.find("point")) point = found->number();
  LoadHistory::State state{
      rule,
      json.at("samples").integer(0, most),
      json.at("reversals").integer(0, most),
      json.at("lowest").number(),
      json.at("highest").number(),
      {turn.at("begun").flag(), static_cast<int>(turn.at("direction").integer(-1, 1)),
       turn.at("last").number()},
      point,
      json.at("open").numbers(),
      read_classes(json.at("classes"), rule.class_width),
      read_levels(json.at("levels"), rule.class_width)};
  return {json.at("column").text(), json.at("unit").text(), std::move(state)};
}

}  // namespace wearwell::fatigue
