#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/models/bearing/bearing_inputs.h"
#include "wearwell/models/bearing/scar.h"
#include "wearwell/models/bearing/solve.h"

namespace wearwell::bearing {

/// One of the five questions about a bearing: its wear rate, depth, allowable pressure, length or
/// life.
struct Question {
  const char* command;
  const char* title;
  Quantity wanted;
  const char* si;
  const char* unit;  ///< default unit of the answer
  const char* help;
  std::vector<Input> unused;
  const char* example;
};
const std::vector<Question>& questions();

/// The inputs of a question, as on the command line.
struct Asked {
  BearingInputs inputs = {};
  std::string unit = {}, limit = {};
  int draws = 100'000;  ///< for uncertain inputs
  std::uint64_t seed = 1;
};

struct Interval {
  double q05 = 0, q50 = 0, q95 = 0;  ///< SI
  double b10 = 0;                    ///< of a life: one draw in ten is shorter
  int redrawn = 0;                   ///< impossible draws, which were redrawn
  double beyond_limit = 0;           ///< share of the draws above the limit
};

struct Answer {
  Question question;
  Unit unit;
  UncertainBearing given;
  Solution solution;
  Bearing sensitivity;
  std::optional<Scar> scar;          ///< in journal radii
  std::optional<Interval> interval;  ///< set if an input is uncertain
  std::string margin;                ///< a sentence; empty without a limit
  int draws = 0;
  std::uint64_t seed = 0;

  double radius() const { return *given.mean().radius; }
  double in_unit(double si) const { return from_si(unit, si); }
  bool is_life() const {
    return question.wanted == Quantity::revolutions || question.wanted == Quantity::time;
  }
};
/// Throws InputError that begins with the wrong flag.
Answer answer(Question question, const Asked& asked);

/// Remarks on an answer, in sentences.
std::vector<std::string> warnings(const Answer& answer);
/// As with --json.
nlohmann::ordered_json to_json(const Answer& answer);

/// The same for callers that pass question and inputs by name: "life"; "radius" and "20 mm +- 1 %",
/// ... Throws InputError.
Answer answer(const std::string& question, const std::string& contact,
              const std::map<std::string, std::string>& inputs, Asked asked);

}  // namespace wearwell::bearing
