#include "wearwell/prognosis/unit_state.h"

#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/sha1.h"

namespace wearwell::prognosis {

ByteWriter unit_state(std::string_view mark, const std::string& fingerprint) {
  ByteWriter to;
  to.text(mark);
  to.text(fingerprint);
  return to;
}

std::string signed_unit_state(ByteWriter state) {
  const std::string bytes = state.take();
  return sha1_of(bytes) + bytes;
}

ByteReader read_unit_state(std::string_view bytes, std::string_view mark,
                           const std::string& fingerprint) {
  constexpr std::size_t digest = 40;
  const std::string name = "the state of a unit";
  if (bytes.size() < digest || sha1_of(bytes.substr(digest)) != bytes.substr(0, digest))
    throw InputError(name + " is damaged, or of another version");
  ByteReader from(bytes.substr(digest), name);
  if (from.text() != mark) from.fail("of another version");
  if (from.text() != fingerprint)
    throw InputError(
        "the state of a unit is of another population: the study has been fitted again since");
  return from;
}

}  // namespace wearwell::prognosis
