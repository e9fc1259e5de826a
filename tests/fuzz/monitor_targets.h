#pragma once

#include <string_view>

namespace wearwell::fuzz {

/// Messages that reach a monitor. Each is read or refused (InputError), and a reading or event in it
/// is whole.
void events(std::string_view bytes);  ///< JSON or CSV with readings and events
void influx(std::string_view bytes);  ///< the line protocol of InfluxDB
void opc_ua(std::string_view bytes);  ///< OPC UA PubSub in JSON

}  // namespace wearwell::fuzz
