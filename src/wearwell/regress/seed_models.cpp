#include "wearwell/regress/seed_models.h"

#include <algorithm>
#include <bit>

#include "wearwell/math/constants.h"
#include "wearwell/regress/submodel.h"

namespace wearwell {
namespace {

struct Candidate {
  TermSet set = 0;
  double score = infinity;
};

class Seeder {
 public:
  Seeder(const SearchProblem& problem, ModelPool& pool, TermSet forced)
      : problem_(problem), pool_(pool), forced_(forced), all_(every_term(problem.terms)) {}

  void forward() {
    Submodel model;
    if (!build(model, forced_, all_)) return;
    note(model);
    while (model.count() > 0) {
      int best = 0;
      double least = infinity;
      for (int t = 0; t < model.count(); ++t) {
        const double error = model.error_with(t);
        if (error < least) {
          least = error;
          best = t;
        }
      }
      model.join(model, best);
      if (!model.estimable()) return;
      note(model);
    }
  }

  void exchange() {
    for (double before = infinity; best_.score < before * (1 - 1e-9);) {
      before = best_.score;
      const TermSet from = best_.set;
      improve_without(from, 0);
      for (const int term : terms_of(from & ~forced_)) improve_without(from, bit(term));
    }
  }

 private:
  /// The model of `terms` with the others of `candidates` as candidates.
  bool build(Submodel& model, TermSet terms, TermSet candidates) const {
    model.start(problem_, candidates);
    for (const int term : terms_of(terms)) {
      int position = 0;
      while (position < model.count() && model.term(position) != term) ++position;
      if (position == model.count()) return false;
      model.join(model, position);
    }
    return model.estimable();
  }

  /// `from` without one term (or none), alone and with any other in its place.
  void improve_without(TermSet from, TermSet out) {
    if (!build(model_, from & ~out, all_ & ~out)) return;
    note(model_);
    for (int t = 0; t < model_.count(); ++t)
      note(model_.model() | bit(model_.term(t)), model_.error_with(t));
  }

  void note(const Submodel& model) {
    if (model.model() != 0) note(model.model(), model.error());
  }

  void note(TermSet set, double error) {
    const int size = std::popcount(set);
    if (!problem_.moments.empty()) {  // approximate PRESS, as if all leverages were equal
      if (size >= problem_.rows) return;
      const double each = static_cast<double>(size) / problem_.rows;
      error /= (1 - each) * (1 - each);
    }
    pool_.offer(set, size, error);
    const double score = problem_.score.of(std::max(error, problem_.least_error), size);
    if (score < best_.score) best_ = {set, score};
  }

  const SearchProblem& problem_;
  ModelPool& pool_;
  const TermSet forced_, all_;
  Candidate best_;
  Submodel model_;
};

}  // namespace

void seed_models(const SearchProblem& problem, ModelPool& pool, TermSet forced) {
  Seeder seeder(problem, pool, forced);
  seeder.forward();
  seeder.exchange();
}

}  // namespace wearwell
