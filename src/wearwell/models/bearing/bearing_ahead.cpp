#include "wearwell/models/bearing/bearing_ahead.h"

namespace wearwell {

BearingAhead read_bearing_ahead(const TomlReader& predict, const BearingData& data) {
  const auto mine = [&](const char* name, const char* si, const std::optional<Quantity>& common) {
    const auto own = positive_quantity(predict, name, si);
    return own ? own : common;
  };
  BearingAhead ahead;
  ahead.contact = contact_in(predict);
  if (!ahead.contact) ahead.contact = data.common.contact;
  ahead.radius = mine("radius", "m", data.common.radius);
  ahead.clearance = mine("clearance", "m", data.common.clearance);
  ahead.speed = mine("speed", "rev/s", data.common.speed);
  ahead.force = positive_quantity(predict, "force", "N");
  const auto length = positive_quantity(predict, "length", "m");
  ahead.pressure = mine("pressure", "Pa", data.common.pressure);
  if (!length) return ahead;
  if (!ahead.force)
    predict.fail("length", "needs predict.force: force and length together give the pressure");
  if (predict.has("pressure"))
    predict.fail("pressure", "is given, and so are force and length; state the load in one way");
  if (!ahead.radius) predict.fail("length", "needs predict.radius: the data have more than one");
  const Unit& unit = data.pressure_unit;
  ahead.pressure =
      Quantity{from_si(unit, ahead.force->si() / (2 * ahead.radius->si() * length->si())), unit};
  ahead.force.reset();  // its length is known
  return ahead;
}

}  // namespace wearwell
