#pragma once

#include <memory>
#include <string>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/known_lives.h"
#include "wearwell/study/model.h"

namespace wearwell::prognosis {

/// The tracker of a state's model. Null if single units of the model, or of this study, cannot be
/// followed.
std::unique_ptr<const Tracker> tracker_where_possible(const CarriedState& state, Models models);

/// The same; throws InputError that names the result where there is none.
std::unique_ptr<const Tracker> required_tracker(const CarriedState& state, Models models,
                                                const std::string& result);

/// Lives of a result, with the tracker that they refer to.
struct ResultLives {
  std::unique_ptr<const Tracker> tracker;  ///< null if the study measures lives
  KnownLives lives;
};

/// Of the units that the model follows, and of new ones; of new ones alone if the study measures
/// lives or `point` names one of its lives (lives_of_study). Throws InputError.
ResultLives lives_of_result(const CarriedState& state, Models models, const std::string& title,
                            const std::string& point);

/// Adds units in service (study_lives.h) to lives of a study that measures lives. Throws InputError,
/// also if its units are followed by their readings.
void add_units_in_service(ResultLives& result, const Table& table);

}  // namespace wearwell::prognosis
