#include "attended.h"
#include "core.h"
#include "wearwell/embed/question.h"

namespace wearwell::python {
namespace {

// (title, text, JSON, [(name, CSV)], page, trusted) of a question. `arguments` is a JSON object.
py::tuple answered(const std::string& kind, const std::string& arguments, const embed::Run* run,
                   const embed::Run* other, const embed::ReadStudy* study, const std::string& path,
                   const std::vector<std::pair<std::string, std::shared_ptr<Table>>>& tables,
                   int threads, const py::object& progress) {
  embed::Subject subject{run, other, study, path, {}};
  for (const auto& [name, table] : tables) subject.tables.emplace_back(name, *table);
  embed::Answer answer;
  attended(progress, [&](Monitor monitor) {
    monitor.threads = threads;
    answer = embed::answer(kind, arguments, subject, std::move(monitor));
  });
  return py::make_tuple(answer.title, answer.text, answer.json, answer.tables, answer.page,
                        answer.trusted);
}

}  // namespace

void add_plans(py::module_& module) {
  module.def("answer", &answered);
}

}  // namespace wearwell::python
