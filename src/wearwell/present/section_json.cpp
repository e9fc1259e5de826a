#include "wearwell/present/section_json.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <string_view>

namespace wearwell::present {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kinds = {"significant", "given", "fixed", "life"};

Json number_json(double x) {
  if (std::isnan(x)) return "NaN";
  if (std::isinf(x)) return x > 0 ? "inf" : "-inf";
  return x;
}

double read_number(const JsonReader& json) {
  if (!json.json().is_string()) return json.number();
  const std::string word = json.one_of({"NaN", "inf", "-inf"});
  if (word == "NaN") return std::numeric_limits<double>::quiet_NaN();
  return word == "inf" ? std::numeric_limits<double>::infinity()
                       : -std::numeric_limits<double>::infinity();
}

struct CellJson {
  Json operator()(std::monostate) const { return nullptr; }
  Json operator()(const std::string& text) const { return text; }
  Json operator()(double x) const { return {{"number", number_json(x)}}; }
  Json operator()(const Range& range) const {
    return {{"low", number_json(range.low)}, {"high", number_json(range.high)}};
  }
  Json operator()(const Badge& badge) const {
    return {{"badge", badge.kind}, {"word", badge.word}};
  }
};

Cell read_cell(const JsonReader& json) {
  if (json.is_null()) return {};
  if (json.json().is_string()) return json.text();
  if (const auto number = json.find("number")) return read_number(*number);
  if (const auto low = json.find("low"))
    return Range{read_number(*low), read_number(json.at("high"))};
  return Badge{json.at("badge").one_of({"pass", "warn", "fail"}), json.at("word").text()};
}

Json list(const std::vector<Block>& blocks);

struct BlockJson {
  Json operator()(const Prose& prose) const {
    return {{"prose", prose.text}, {"lead", prose.lead}};
  }
  Json operator()(const Callout& callout) const {
    return {{"callout", callout.kind}, {"word", callout.word}, {"text", callout.text}};
  }
  Json operator()(const Tiles& tiles) const {
    Json items = Json::array();
    for (const html::Tile& tile : tiles.tiles) {
      items.push_back(
          {{"name", tile.name}, {"value", tile.value}, {"unit", tile.unit}, {"note", tile.note}});
    }
    return {{"tiles", std::move(items)}};
  }
  Json operator()(const Facts& facts) const {
    Json items = Json::array();
    for (const auto& [name, value] : facts.facts)
      items.push_back({{"name", name}, {"value", value}});
    return {{"facts", std::move(items)}};
  }
  Json operator()(const Verbatim& verbatim) const { return {{"verbatim", verbatim.text}}; }
  Json operator()(const Figures& figures) const {
    Json items = Json::array();
    for (const html::Figure& figure : figures.figures) {
      items.push_back({{"id", figure.id},
                       {"title", figure.title},
                       {"caption", figure.caption},
                       {"specification", figure.specification}});
      if (!figure.panel_of.empty()) items.back()["panel_of"] = figure.panel_of;
      if (figure.wide) items.back()["wide"] = true;
    }
    return {{"figures", std::move(items)}};
  }
  Json operator()(const Table& table) const {
    Json columns = Json::array(), rows = Json::array();
    for (const Column& column : table.columns) {
      columns.push_back({{"name", column.name},
                         {"unit", column.unit},
                         {"format", kinds[static_cast<std::size_t>(column.format.kind)]},
                         {"digits", column.format.digits},
                         {"range", column.is_range}});
    }
    for (const auto& row : table.rows) {
      Json cells = Json::array();
      for (const Cell& cell : row) cells.push_back(std::visit(CellJson{}, cell));
      rows.push_back(std::move(cells));
    }
    return {{"table", table.id},
            {"caption", table.caption},
            {"words", table.words},
            {"columns", std::move(columns)},
            {"rows", std::move(rows)}};
  }
  Json operator()(const Details& details) const {
    return {{"details", details.summary}, {"blocks", list(details.blocks)}};
  }
};

Json list(const std::vector<Block>& blocks) {
  Json items = Json::array();
  for (const Block& block : blocks) items.push_back(std::visit(BlockJson{}, block.content));
  return items;
}

Column read_column(const JsonReader& json) {
  Column column{json.at("name").text(), json.at("unit").text(), {}, json.at("range").flag()};
  const std::string kind = json.at("format").one_of({kinds[0], kinds[1], kinds[2], kinds[3]});
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (kind == kinds[i]) column.format.kind = static_cast<Format::Kind>(i);
  }
  column.format.digits = static_cast<int>(json.at("digits").integer(0, 17));
  return column;
}

Table read_table(const JsonReader& json) {
  Table table{json.at("table").text(), json.at("caption").text(), {}, {}, json.at("words").flag()};
  for (const JsonReader& each : json.at("columns").items())
    table.columns.push_back(read_column(each));
  for (const JsonReader& row : json.at("rows").items()) {
    table.rows.emplace_back();
    for (const JsonReader& cell : row.items()) table.rows.back().push_back(read_cell(cell));
    if (table.rows.back().size() != table.columns.size())
      row.fail(fmt::format("has {} cells, but the table has {} columns", table.rows.back().size(),
                           table.columns.size()));
  }
  return table;
}

std::vector<Block> read_blocks(const JsonReader& json, int depth = 0);

Block read_block(const JsonReader& json, int depth) {
  if (const auto prose = json.find("prose")) return {Prose{prose->text(), json.at("lead").flag()}};
  if (const auto kind = json.find("callout")) {
    return {Callout{kind->one_of({"pass", "warn", "fail"}), json.at("word").text(),
                    json.at("text").text()}};
  }
  if (const auto items = json.find("tiles")) {
    Tiles tiles;
    for (const JsonReader& tile : items->items()) {
      tiles.tiles.push_back({tile.at("name").text(), tile.at("value").text(),
                             tile.at("unit").text(), tile.at("note").text()});
    }
    return {std::move(tiles)};
  }
  if (const auto items = json.find("facts")) {
    Facts facts;
    for (const JsonReader& fact : items->items())
      facts.facts.emplace_back(fact.at("name").text(), fact.at("value").text());
    return {std::move(facts)};
  }
  if (const auto text = json.find("verbatim")) return {Verbatim{text->text()}};
  if (const auto items = json.find("figures")) {
    Figures figures;
    for (const JsonReader& figure : items->items()) {
      const JsonReader specification = figure.at("specification");
      if (!specification.json().is_object()) specification.fail("should be an object");
      figures.figures.push_back({figure.at("id").text(), figure.at("title").text(),
                                 figure.at("caption").text(), specification.json()});
      if (const auto group = figure.find("panel_of"))
        figures.figures.back().panel_of = group->text();
      if (const auto wide = figure.find("wide")) figures.figures.back().wide = wide->flag();
    }
    return {std::move(figures)};
  }
  if (json.find("table")) return {read_table(json)};
  const JsonReader summary = json.at("details");
  constexpr int deepest = 4;
  if (depth == deepest) summary.fail("is nested too deeply");
  return {Details{summary.text(), read_blocks(json.at("blocks"), depth + 1)}};
}

std::vector<Block> read_blocks(const JsonReader& json, int depth) {
  std::vector<Block> blocks;
  for (const JsonReader& each : json.items()) blocks.push_back(read_block(each, depth));
  return blocks;
}

}  // namespace

Json to_json(const std::vector<Section>& sections) {
  Json items = Json::array();
  for (const Section& section : sections) {
    items.push_back({{"id", section.id},
                     {"name", section.name},
                     {"title", section.title},
                     {"blocks", list(section.blocks)}});
  }
  return {{"sections", std::move(items)}};
}

std::vector<Section> sections_from_json(const JsonReader& json) {
  std::vector<Section> sections;
  for (const JsonReader& each : json.at("sections").items()) {
    sections.push_back({each.at("id").text(), each.at("name").text(),
                        read_blocks(each.at("blocks")), each.at("title").text()});
  }
  return sections;
}

}  // namespace wearwell::present
