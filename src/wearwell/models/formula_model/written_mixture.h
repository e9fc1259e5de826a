#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wearwell/bayes/parameter.h"
#include "wearwell/models/formula_model/formula_model.h"
#include "wearwell/models/formula_model/lines_by_level.h"

namespace wearwell::formula_model {

/// A share as written, with its place among the parameters of the mixture.
struct WrittenShare {
  std::string place;  ///< "[subpopulations.share] early"
  std::string text;
  std::size_t at = 0;
};

/// A likelihood as written, before anything is compiled.
struct WrittenLikelihood {
  std::string column;
  std::string mode;   ///< of a failure mode or a subpopulation, else empty
  std::string place;  ///< "likelihood.life": its table in the study
  const ResponseForm* form = nullptr;
  const ProcessForm* process = nullptr;
  std::optional<std::string> trials;
  /// Of the form, and the expression.
  std::vector<std::pair<std::size_t, std::string>> family_parameters;
  std::optional<std::string> sigma;  ///< of a log-location-scale family by that name: positive
  std::optional<std::string> defective, dead;  ///< share_defective, share_dead_on_arrival
  std::vector<WrittenLikelihood> parts;        ///< the subpopulations, if it is a mixture of some
  std::size_t rest = 0;                        ///< the one without a share
  std::vector<WrittenShare> shares;            ///< all of them

  LifeMixture life() const;
};

/// Without a distribution.
WrittenLikelihood empty_likelihood(const std::string& column);

/// The subpopulations, or the likelihood itself.
std::span<const WrittenLikelihood> parts_of(const WrittenLikelihood& written);

/// Reads the keys share_defective and share_dead_on_arrival; a likelihood without a family is completed by `mixture_of`.
void read_shares_of_life(const TomlReader& table, WrittenLikelihood& written);

/// The likelihood of the mixture: `common` for the subpopulations without a table of their own.
WrittenLikelihood mixture_of(const TomlReader& root, const Subpopulations& subpopulations,
                             const WrittenLikelihood& common,
                             const std::vector<WrittenLikelihood>& with_tables,
                             const LinesByLevel& lines);

/// Throw InputError at what is not possible with shares of lives, and with [subpopulations].
void refuse_with_shares(const TomlReader& root, const std::vector<WrittenLikelihood>& written);
void refuse_with_subpopulations(const TomlReader& root,
                                const std::vector<WrittenLikelihood>& written,
                                const std::vector<std::string>& texts);

/// Adds the expressions of all parameters of the distribution, with their places.
void add_wanted(const WrittenLikelihood& written, const formula::Powers& powers,
                Measured& measured);

/// Whether the distributions of the subpopulations would be the same after an exchange of names: their families, their
/// expressions (with `lines`, those of [formula] as written) and the priors of their parameters are alike. Shares need not be.
bool are_exchangeable(const WrittenLikelihood& written, const Subpopulations& subpopulations,
                      const std::vector<formula::Line>& lines,
                      const std::vector<Parameter>& parameters);

}  // namespace wearwell::formula_model
