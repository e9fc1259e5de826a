#include "wearwell/models/formula_model/warranty_model.h"

#include "wearwell/models/formula_model/model.h"
#include "wearwell/models/formula_model/returns_scaffold.h"

namespace wearwell {
namespace resource {

std::string_view warranty_study();
std::string_view warranty_data();
std::string_view warranty_planned();

}  // namespace resource

namespace formula_model {

Model warranty() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::warranty_study},
                                            {"returns.csv", resource::warranty_data},
                                            {"planned_sales.csv", resource::warranty_planned}};
  Model own = model();
  own.preset = "warranty";
  own.example = example;
  own.scaffold = first_returns_study;
  return own;
}

}  // namespace formula_model
}  // namespace wearwell
