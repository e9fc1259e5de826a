#pragma once

#include <string>

#include "wearwell/embed/run.h"
#include "wearwell/prognosis/carried_state.h"

namespace wearwell::embed {

/// A fit in memory, or the folder of a result.
struct Fitted {
  const Run* run = nullptr;
  std::string path = {};  ///< if there is no run

  /// In messages: "fit", or the folder.
  std::string name() const { return run ? "fit" : path; }
};

/// The bytes of state.bin of a run; empty if it has none.
std::string saved_state(const Run& run);

/// What a fit saves for later questions. Throws InputError if it has none.
prognosis::CarriedState state_of(const Fitted& fitted);

/// The study of a saved state, with its tables in memory. Throws InputError if the bytes are damaged.
ReadStudy study_of_state(const std::string& bytes);

/// The same study with another text, with the same tables. Throws InputError.
ReadStudy with_text(const ReadStudy& study, const std::string& text);

}  // namespace wearwell::embed
