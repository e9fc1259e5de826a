#pragma once

#include <string>
#include <vector>

#include "wearwell/present/section.h"

namespace wearwell {

/// A page that opens without a network: style, plotting libraries and their licences inside. All of
/// it is text.
struct Page {
  std::string version;  ///< of the program
  std::string title;
  std::string subtitle;
  std::vector<present::Section> sections;
};

std::string html_page(const Page& page);

}  // namespace wearwell
