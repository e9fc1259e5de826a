#include "wearwell/embed/fitted.h"

#include "wearwell/base/error.h"

namespace wearwell::embed {

std::string saved_state(const Run& run) {
  if (!run.state.empty()) return run.state;
  for (const auto& [name, content] : run.result->files)
    if (name == "state.bin") return content;
  return {};
}

prognosis::CarriedState state_of(const Fitted& fitted) {
  if (!fitted.run) return prognosis::read_state(fitted.path);
  const std::string bytes = saved_state(*fitted.run);
  if (bytes.empty())
    throw InputError(
        "the fit holds no state for later questions: its study has no posterior, or its data have "
        "changed since they were read");
  return prognosis::state_of_bytes(bytes, "fit");
}

ReadStudy study_of_state(const std::string& bytes) {
  return read(prognosis::state_of_bytes(bytes, "fit").source);
}

ReadStudy with_text(const ReadStudy& study, const std::string& text) {
  Source source = *study.source;
  source.study.text = text;
  return read(std::move(source));
}

}  // namespace wearwell::embed
