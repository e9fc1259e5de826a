#include "attended.h"
#include "core.h"
#include "wearwell/embed/plan.h"

namespace wearwell::python {
namespace {

// (title, text, plan.json, [(name, CSV)], page, trusted) of `wearwell plan KIND`. `arguments` is a JSON object.
py::tuple plan(const std::string& kind, const std::string& arguments, const embed::Run* run,
               const embed::ReadStudy* study, const std::string& path,
               const std::vector<std::pair<std::string, std::shared_ptr<Table>>>& tables,
               int threads, const py::object& progress) {
  embed::PlanSubject subject{run, study, path, {}};
  for (const auto& [name, table] : tables) subject.tables.emplace_back(name, *table);
  embed::PlanAnswer answer;
  attended(progress, [&](Monitor monitor) {
    monitor.threads = threads;
    answer = embed::plan(kind, arguments, subject, std::move(monitor));
  });
  return py::make_tuple(answer.title, answer.text, answer.json, answer.tables, answer.page,
                        answer.trusted);
}

}  // namespace

void add_plans(py::module_& module) {
  module.def("plan", &plan);
}

}  // namespace wearwell::python
