#include "wearwell/study/scaffold.h"

#include <nlohmann/json.hpp>

namespace wearwell {

std::string toml_text(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace wearwell
