#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "wearwell/monitor/message.h"

namespace wearwell::monitor {

/// Whether a field with this name is one that a form adds beside those of its messages: of `influx`
/// "{measurement}" and "{timestamp}"; of `opc_ua` "{publisher}", "{writer}", "{sequence}" and
/// "{timestamp}". Times are Unix times in ms.
bool is_place_of(Form form, std::string_view field);

/// Lines of the line protocol of InfluxDB, "pump,machine=M1 wear=31.5,hours=1200i 1700000000": tags
/// and fields by their names, and `{measurement}`, `{timestamp}`. `per_second`: the unit of times.
/// Calls `row` with the fields of each line, and `bad` with the error of an unreadable one.
void read_influx(std::string_view payload, std::int64_t per_second,
                 const std::function<void(const Fields&)>& row,
                 const std::function<void(const std::string& problem)>& bad);

/// One network message or data set message of OPC UA PubSub in JSON (OPC 10000-14, 7.2.5), a list of
/// these, or one on each line: the fields of each payload, and those of its header. Values may be
/// plain, DataValue or Variant; one whose status is bad, or is not a status code, counts as missing.
/// A delta frame is refused. `stream`: json_lines if each line is a message of its own, whatever the
/// others are.
void read_opc_ua(std::string_view payload, const std::function<void(const Fields&)>& row,
                 const std::function<void(const std::string& problem)>& bad,
                 Form stream = Form::any);

}  // namespace wearwell::monitor
