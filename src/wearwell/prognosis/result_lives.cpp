#include "wearwell/prognosis/result_lives.h"

#include <fmt/format.h>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/prognosis/fitted_b_life.h"
#include "wearwell/prognosis/study_lives.h"
#include "wearwell/study/inference_data.h"

namespace wearwell::prognosis {

std::unique_ptr<const Tracker> tracker_where_possible(const CarriedState& state, Models models) {
  for (const Model& model : models)
    if (model.key == state.model && model.track) return model.track(state);
  return nullptr;
}

std::unique_ptr<const Tracker> required_tracker(const CarriedState& state, Models models,
                                                const std::string& result) {
  if (auto tracker = tracker_where_possible(state, models)) return tracker;
  throw InputError(fmt::format("{}: single units of this study of model \"{}\" cannot be followed",
                               result, printable(state.model)));
}

ResultLives lives_of_result(const CarriedState& state, Models models, const std::string& title,
                            const std::string& point) {
  ResultLives result;
  if (point.empty()) result.tracker = tracker_where_possible(state, models);
  if (result.tracker) {
    result.lives = lives_of_tracker(*result.tracker, title, state.trusted);
    return result;
  }
  const std::unique_ptr<const Study> study = read_study(state.source, models);
  result.lives =
      lives_of_study(require_posterior_study(*study), state.posterior, title, state.trusted, point);
  const auto own = std::make_shared<const CarriedState>(state);
  result.lives.b_life = [=](double share, double level) {
    return fitted_b_life(*own, models, title, point, share, level);
  };
  return result;
}

void add_units_in_service(ResultLives& result, const Table& table) {
  if (result.tracker)
    throw InputError(
        "--in-service: the units of this study are followed by their readings; it is for studies "
        "that measure lives");
  add_units_in_service(result.lives, table);
}

}  // namespace wearwell::prognosis
