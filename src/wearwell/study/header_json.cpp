#include "wearwell/study/header_json.h"

#include <fmt/format.h>

#include "wearwell/study/trust_blocks.h"

namespace wearwell {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

Json to_json(const std::vector<Check>& checks) {
  Json json = Json::array();
  for (const Check& check : checks) {
    Json each = {
        {"name", check.name}, {"verdict", verdict_kind(check.verdict)}, {"detail", check.detail}};
    if (!check.advice.empty()) each["advice"] = check.advice;
    json.push_back(std::move(each));
  }
  return json;
}

Json to_json(const Header& header) {
  Json data = {{"files", header.data.files},
               {"rows", header.data.rows},
               {"fingerprint", header.data.fingerprint}};
  if (!header.data.remarks.empty()) data["remarks"] = header.data.remarks;
  return {{"wearwell", header.version},
          {"schema", header.schema},
          {"title", header.title},
          {"model", header.model},
          {"equation", header.equation},
          {"data", std::move(data)},
          {"seed", header.seed},
          {"trusted", header.trusted},
          {"checks", to_json(header.checks)}};
}

std::vector<Check> read_checks(const JsonReader& json) {
  std::vector<Check> checks;
  for (const JsonReader& each : json.items()) {
    const std::string verdict = each.at("verdict").one_of({"pass", "warn", "fail"});
    const auto advice = each.find("advice");
    checks.push_back({each.at("name").text(),
                      verdict == "pass"   ? Verdict::pass
                      : verdict == "warn" ? Verdict::warn
                                          : Verdict::fail,
                      each.at("detail").text(), advice ? advice->text() : ""});
  }
  return checks;
}

Header read_header(const JsonReader& json) {
  const auto schema = json.find("schema");
  const long long version = schema ? schema->integer(1) : 0;
  if (version != summary_schema) {
    const auto writer = json.find("wearwell");
    const auto old_writer = json.find("version");  // written by the clutch model before schemas
                                                   // existed
    json.fail(fmt::format(
        "was written by wearwell {} with schema {}, and this one reads schema {}: fit the study "
        "again",
        writer       ? writer->text()
        : old_writer ? old_writer->text()
                     : "of an unknown version",
        version, summary_schema));
  }
  Header header;
  header.version = json.at("wearwell").text();
  header.title = json.at("title").text();
  header.model = json.at("model").text();
  header.equation = json.at("equation").text();
  const JsonReader data = json.at("data");
  for (const JsonReader& file : data.at("files").items()) header.data.files.push_back(file.text());
  header.data.rows = static_cast<std::size_t>(data.at("rows").integer(1));
  header.data.fingerprint = data.at("fingerprint").text();
  if (const auto remarks = data.find("remarks")) {
    for (const JsonReader& each : remarks->items()) header.data.remarks.push_back(each.text());
  }
  header.seed = json.at("seed").natural();
  header.trusted = json.at("trusted").flag();
  header.checks = read_checks(json.at("checks"));
  return header;
}

}  // namespace wearwell
