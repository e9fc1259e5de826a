#include "wearwell/present/section.h"

#include <fmt/format.h>

#include "wearwell/present/number.h"

namespace wearwell::present {
namespace {

std::string html_of(const std::vector<Block>& blocks);

std::string html_of(const Prose& prose) {
  return fmt::format("<p{}>{}</p>\n", prose.lead ? " class=\"verdict\"" : "",
                     html::escape(powers_in_words(prose.text, Script::page)));
}

std::string html_of(const Callout& callout) {
  return html::callout(callout.kind, callout.word, powers_in_words(callout.text, Script::page));
}

std::string html_of(const Tiles& tiles) {
  return html::tiles(tiles.tiles);
}

std::string html_of(const Facts& facts) {
  std::string out = "<dl class=\"facts\">\n";
  for (const auto& [name, value] : facts.facts) {
    out +=
        fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", html::escape(name), html::escape(value));
  }
  return out + "</dl>\n";
}

std::string html_of(const Verbatim& verbatim) {
  return fmt::format("<pre tabindex=\"0\">{}</pre>\n", html::escape(verbatim.text));
}

std::string html_of(const Figures& figures) {
  return html::figures(figures.figures);
}

std::string html_of(const Table& table) {
  html::Table shown{table.caption, {}, {}, table.words};
  for (const Column& column : table.columns) {
    const std::string unit = html::unit(column.unit);
    shown.heading.push_back(unit.empty() ? column.name : fmt::format("{} [{}]", column.name, unit));
  }
  for (const auto& row : table.rows) {
    if (shown.rows.size() == most_rows_shown) break;
    shown.rows.emplace_back();
    for (std::size_t c = 0; c < row.size(); ++c) {
      shown.rows.back().push_back(html::raised(in_words(row[c], table.columns[c])));
      if (const auto* badge = std::get_if<Badge>(&row[c])) shown.badges.push_back(badge->kind);
    }
  }
  std::string out = html::table(shown);
  if (table.rows.size() > most_rows_shown)
    out += fmt::format("<p>The first {} of {}; all are in tables/{}.csv.</p>\n",
                       html::given(most_rows_shown),
                       html::given(static_cast<double>(table.rows.size())), html::escape(table.id));
  return out;
}

std::string html_of(const Details& details) {
  return html::details(details.summary, html_of(details.blocks));
}

std::string html_of(const std::vector<Block>& blocks) {
  std::string out;
  for (const Block& block : blocks)
    out += std::visit([](const auto& content) { return html_of(content); }, block.content);
  return out;
}

void collect(const std::vector<Block>& blocks, std::vector<const Table*>& found) {
  for (const Block& block : blocks) {
    if (const auto* table = std::get_if<Table>(&block.content)) found.push_back(table);
    if (const auto* details = std::get_if<Details>(&block.content)) collect(details->blocks, found);
  }
}

}  // namespace

std::vector<const Table*> tables(const std::vector<Section>& sections) {
  std::vector<const Table*> found;
  for (const Section& section : sections) collect(section.blocks, found);
  return found;
}

std::string html_of(const Section& section) {
  return html_of(section.blocks);
}

}  // namespace wearwell::present
