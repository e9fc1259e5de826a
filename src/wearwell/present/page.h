#pragma once

#include <string>
#include <vector>

#include "wearwell/present/section.h"

namespace wearwell {

/// A self-contained page: style, plotting libraries and their licenses are embedded. All members
/// are text.
struct Page {
  std::string version;  ///< of the program
  std::string title;
  std::string subtitle;
  std::vector<present::Section> sections;
};

std::string html_page(const Page& page);

}  // namespace wearwell
