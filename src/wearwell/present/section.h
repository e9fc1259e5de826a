#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "wearwell/present/html.h"
#include "wearwell/present/table.h"

/// What a report is made of. All of it is text: nothing here is markup.
namespace wearwell::present {

/// A paragraph; `lead` for the one that says it all.
struct Prose {
  std::string text;
  bool lead = false;
};

/// A paragraph that stands out; `kind` is "pass", "warn" or "fail", `word` says the same.
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

/// Lines as they are: a file, a command.
struct Verbatim {
  std::string text;
};

/// Plots, side by side where there is room.
struct Figures {
  std::vector<html::Figure> figures;
};

struct Block;

/// What is shown on request.
struct Details {
  std::string summary;
  std::vector<Block> blocks;
};

struct Block {
  std::variant<Prose, Callout, Tiles, Facts, Verbatim, Figures, Table, Details> content;
};

struct Section {
  std::string id;
  std::string name;  ///< in the contents
  std::vector<Block> blocks = {};
  std::string title = {};  ///< above the section, when it says more than the name

  void add(auto&& content) { blocks.push_back({std::forward<decltype(content)>(content)}); }
};

/// All tables in the order of the sections, those in details too.
std::vector<const Table*> tables(const std::vector<Section>& sections);

/// A page folds tables of more rows, unless their cells are sentences.
inline constexpr std::size_t most_rows_open = 12;

/// The markup of its blocks. Tables have no column without content there; units stand with what they are of.
std::string html_of(const Section& section);

}  // namespace wearwell::present
