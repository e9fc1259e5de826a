#include "wearwell/present/section.h"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

#include "wearwell/present/number.h"

namespace wearwell::present {
namespace {

std::string html_of(const std::vector<Block>& blocks, bool folded);

std::string html_of(const Prose& prose) {
  return fmt::format("<p{}>{}</p>\n", prose.lead ? " class=\"verdict\"" : "",
                     html::escape(powers_text(prose.text, Script::page)));
}

std::string html_of(const Callout& callout) {
  return html::callout(callout.kind, callout.word, powers_text(callout.text, Script::page));
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

bool is_text(const Table& table, std::size_t column) {
  return std::any_of(table.rows.begin(), table.rows.end(), [&](const auto& row) {
    return std::holds_alternative<std::string>(row[column]);
  });
}

bool has_content(const Table& table, std::size_t column) {
  if (column == 0 || table.rows.empty()) return true;
  return std::any_of(table.rows.begin(), table.rows.end(), [&](const auto& row) {
    const std::string words = description(row[column], table.columns[column]);
    return !words.empty() && words != "–" && words != "– to –";
  });
}

// A column of units is appended in brackets to the column before it.
bool is_unit_of_name(const Table& table, std::size_t column) {
  return column > 0 && table.columns[column].name == "Unit" && is_text(table, column) &&
         is_text(table, column - 1);
}

std::string html_of(const Table& table, bool folded) {
  html::Table shown{table.caption, {}, {}, table.words};
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (!has_content(table, c) || is_unit_of_name(table, c)) continue;
    columns.push_back(c);
    const Column& column = table.columns[c];
    const std::string unit = html::unit(column.unit);
    shown.heading.push_back(unit.empty() ? column.name : fmt::format("{} [{}]", column.name, unit));
    shown.text.push_back(!table.words && is_text(table, c));
  }
  for (const auto& row : table.rows) {
    if (shown.rows.size() == most_rows_shown) break;
    shown.rows.emplace_back();
    for (const std::size_t c : columns) {
      std::string words = html::raised(description(row[c], table.columns[c]));
      if (c + 1 < row.size() && is_unit_of_name(table, c + 1)) {
        const std::string unit = html::unit(description(row[c + 1], table.columns[c + 1]));
        if (!unit.empty()) words += fmt::format(" [{}]", unit);
      }
      shown.rows.back().push_back(std::move(words));
      if (const auto* badge = std::get_if<Badge>(&row[c])) shown.badges.push_back(badge->kind);
    }
  }
  std::string out = html::table(shown);
  if (table.rows.size() > most_rows_shown)
    out += fmt::format("<p>The first {} of {}; all are in tables/{}.csv.</p>\n",
                       html::given(most_rows_shown),
                       html::given(static_cast<double>(table.rows.size())), html::escape(table.id));
  if (folded || table.words || table.rows.size() <= most_rows_open) return out;
  return html::details(fmt::format("{} ({} rows)", table.caption,
                                   html::given(static_cast<double>(table.rows.size()))),
                       out);
}

std::string html_of(const Details& details) {
  return html::details(details.summary, html_of(details.blocks, true));
}

std::string html_of(const std::vector<Block>& blocks, bool folded) {
  std::string out;
  for (const Block& block : blocks) {
    out += std::visit(
        [&]<class Content>(const Content& content) {
          if constexpr (std::is_same_v<Content, Table>) {
            return html_of(content, folded);
          } else {
            return html_of(content);
          }
        },
        block.content);
  }
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
  return html_of(section.blocks, false);
}

}  // namespace wearwell::present
