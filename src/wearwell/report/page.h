#pragma once

#include <string>
#include <vector>

namespace wearwell {

/// A page that opens without a network: style, plotting libraries and their licences inside.
struct Page {
  struct Section {
    std::string id;
    std::string name;        ///< in the contents
    std::string html;        ///< markup
    std::string title = {};  ///< above the section, when it says more than the name
  };
  std::string version;  ///< of the program
  std::string title;    ///< text, as are the others
  std::string subtitle;
  std::vector<Section> sections;
};

std::string html_page(const Page& page);

}  // namespace wearwell
