#include "wearwell/prob/family_form.h"

#include <algorithm>

#include "wearwell/prob/families.h"

namespace wearwell {
namespace {

template <class F>
ResponseForm make_form(std::size_t i) {
  using Own = families::Base<F>;
  ResponseForm form{Own::name,
                    static_cast<ResponseFamily>(i),
                    {},
                    Own::positive,
                    Own::counted,
                    Own::prior_only,
                    Own::title,
                    Own::paper,
                    Own::c_density};
  form.family_parameters.assign(Own::family_parameters.begin(), Own::family_parameters.end());
  if (form.title.empty()) form.title = form.name;
  if constexpr (families::Thresholded<F>) {
    form.family_parameters.push_back({"threshold", ParameterKind::location, true});
    form.paper.straight = false;
    form.c_density = nullptr;
  }
  return form;
}

// Indexed by ResponseFamily.
const std::vector<ResponseForm>& all_forms() {
  static const auto all = [] {
    std::vector<ResponseForm> forms(2 * families::Families::size);
    families::for_each_family([&]<class F>(std::size_t i) { forms[i] = make_form<F>(i); });
    return forms;
  }();
  return all;
}

// In the order of the list; the version with a threshold follows the one without.
template <class Wanted>
std::vector<ResponseForm> forms_of(const Wanted& wanted) {
  std::vector<ResponseForm> found;
  for (std::size_t i = 0; i < families::Families::size; ++i) {
    for (const std::size_t at : {i, families::Families::size + i}) {
      const ResponseForm& form = all_forms()[at];
      if (!form.name.empty() && wanted(form)) found.push_back(form);
    }
  }
  return found;
}

}  // namespace

std::span<const ResponseForm> response_forms() {
  static const std::vector<ResponseForm> forms =
      forms_of([](const ResponseForm& form) { return !form.prior_only; });
  return forms;
}

std::span<const ResponseForm> prior_forms() {
  static const auto forms = [] {
    std::vector<ResponseForm> found =
        forms_of([](const ResponseForm& form) { return !form.counted; });
    std::stable_partition(found.begin(), found.end(),
                          [](const ResponseForm& form) { return form.prior_only; });
    return found;
  }();
  return forms;
}

const ResponseForm& form_of(ResponseFamily family) {
  return all_forms()[static_cast<std::size_t>(family)];
}

}  // namespace wearwell
