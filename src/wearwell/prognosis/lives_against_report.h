#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/present/section.h"
#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/lives_against.h"
#include "wearwell/study/model.h"

namespace wearwell::prognosis {

/// The comparison as a user asks for it; texts are those of options of `wearwell life`.
struct LivesAgainstRequest {
  std::string unit;        ///< which life of both (named_life.h); empty: the headline
  std::string horizon;     ///< use at which survival is compared, "1000 h"; empty: none
  std::string confidence;  ///< of "at least", "95 %"; empty: 90 %
};

/// A result by the name that texts have for it: its folder, or "fit".
struct NamedState {
  CarriedState state;
  std::string name;
};

/// Lives of two results against each other, ready to show.
struct LivesAgainstReport {
  std::string name, of, against;              ///< of: "supplier-a-results, valve"
  std::vector<std::string> not_trusted = {};  ///< those of the two lives whose fit is not trusted
  LivesAgainst found = {};
  std::string horizon = {};  ///< as in the request
  double use = 0;            ///< the horizon in the unit of the first life
  Unit unit = {};            ///< of the first life
};

/// Throws InputError if a study has no life of a new unit, or their units have other dimensions.
LivesAgainstReport lives_against_report(const LivesAgainstRequest& request, const NamedState& life,
                                        const NamedState& other, Models models);

std::string lives_against_text(const LivesAgainstReport& report);
std::vector<present::Section> lives_against_sections(const LivesAgainstReport& report);
/// Infinite numbers become null in the text of the JSON.
nlohmann::ordered_json lives_against_json(const LivesAgainstReport& report);

}  // namespace wearwell::prognosis
