#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "wearwell/present/html.h"
#include "wearwell/present/table.h"

/// The content of a report. All members are text, not markup.
namespace wearwell::present {

/// A paragraph; `lead` for the summary.
struct Prose {
  std::string text;
  bool lead = false;
};

/// A highlighted paragraph; `kind` is "pass", "warn" or "fail", `word` is its label.
struct Callout {
  std::string kind, word, text;
};

/// Key figures.
struct Tiles {
  std::vector<html::Tile> tiles;
};

/// Names and values.
struct Facts {
  std::vector<std::pair<std::string, std::string>> facts;
};

/// Preformatted lines: a file, a command.
struct Verbatim {
  std::string text;
};

/// Plots, side by side if there is room.
struct Figures {
  std::vector<html::Figure> figures;
};

struct Block;

/// A collapsible block.
struct Details {
  std::string summary;
  std::vector<Block> blocks;
};

struct Block {
  std::variant<Prose, Callout, Tiles, Facts, Verbatim, Figures, Table, Details> content;
};

struct Section {
  std::string id;
  std::string name;  ///< name in the table of contents
  std::vector<Block> blocks = {};
  std::string title = {};  ///< heading of the section, if longer than the name

  void add(auto&& content) { blocks.push_back({std::forward<decltype(content)>(content)}); }
};

/// All tables in the order of the sections, including those in details.
std::vector<const Table*> tables(const std::vector<Section>& sections);

/// Longer tables are collapsed on a page, unless their cells are sentences.
inline constexpr std::size_t most_rows_open = 12;

/// The markup of its blocks. Omits empty columns of tables; appends units to their quantities.
std::string html_of(const Section& section);

}  // namespace wearwell::present
