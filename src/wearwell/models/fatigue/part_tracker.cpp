#include "wearwell/models/fatigue/part_tracker.h"

#include <utility>

#include "wearwell/models/fatigue/part_population.h"
#include "wearwell/models/fatigue/part_unit.h"
#include "wearwell/models/fatigue/sn_parameters.h"
#include "wearwell/prognosis/unit_state.h"

namespace wearwell::fatigue {
namespace {

using prognosis::Reading;
using SharedParts = std::shared_ptr<const PartPopulation>;

class PartTracker final : public prognosis::Tracker {
 public:
  explicit PartTracker(SharedParts parts) : parts_(std::move(parts)) {}

  std::span<const prognosis::ReadingColumn> columns() const override {
    return parts_->reading.columns();
  }
  std::span<const std::string> labels() const override { return {}; }
  const prognosis::ReadingColumn& axis() const override {
    return parts_->reading.columns().front();
  }
  const std::string& limited() const override { return limited_; }
  const Quantity& limit() const override { return limit_; }
  bool rising() const override { return true; }
  const std::string& noun() const override { return noun_; }
  double probability_error() const override { return 0.004; }
  std::vector<double> populations() const override { return parts_->few.weights; }
  std::span<const std::string> seen() const override { return parts_->seen; }
  std::string refusal(const std::string& unit) const override { return parts_->refusal(unit); }
  std::string problem(const Reading& reading) const override {
    double cycles = 0;
    std::optional<Stress> stress;
    return parts_->reading.read(reading.numbers, cycles, stress);
  }

  std::unique_ptr<prognosis::TrackedUnit> begin(const std::string& unit) const override {
    return std::make_unique<PartUnit>(parts_, unit);
  }

  std::unique_ptr<prognosis::TrackedUnit> restore(const std::string& bytes) const override {
    prognosis::ByteReader from = prognosis::read_unit_state(bytes, part_mark, parts_->fingerprint);
    auto unit = std::make_unique<PartUnit>(parts_, from.text());
    unit->load(from);
    return unit;
  }

 private:
  SharedParts parts_;
  std::string limited_ = "used life", noun_ = "part";
  Quantity limit_{1, Unit{"1", 1, 0}};
};

}  // namespace

std::unique_ptr<const prognosis::Tracker> track_parts(const prognosis::CarriedState& state) {
  const TomlReader root = TomlReader::parse(state.source.study);
  auto parts = std::make_shared<const PartPopulation>(root, state);
  std::vector<std::string> names;
  for (const Parameter& each : sn_parameters(root, parts->law, parts->data))
    names.push_back(each.name);
  prognosis::require_parameters(state, names);
  return std::make_unique<const PartTracker>(std::move(parts));
}

}  // namespace wearwell::fatigue
