#pragma once

namespace wearwell {

/// The capabilities of a terminal; none if output goes to a file.
struct TerminalStyle {
  bool colour = false;      ///< ANSI colors for verdicts
  bool histograms = false;  ///< small histograms of block characters
  bool rows = false;        ///< tables with a line for each row of the data, on request
};

/// The style of standard output: plain if it is not a terminal; no color with NO_COLOR
/// (no-color.org) or a dumb terminal; histograms if the locale is UTF-8.
TerminalStyle terminal_style();

}  // namespace wearwell
