#pragma once

namespace wearwell {

/// What a terminal can show; nothing of it where output goes to a file.
struct TerminalStyle {
  bool colour = false;      ///< ANSI colours for verdicts
  bool histograms = false;  ///< small ones, of block characters
  bool rows = false;        ///< tables with a line for each row of the data, because asked for
};

/// The style of standard output: none when it is not a terminal; no colour with NO_COLOR
/// (no-color.org) or a dumb terminal; histograms where the locale is UTF-8.
TerminalStyle terminal_style();

}  // namespace wearwell
