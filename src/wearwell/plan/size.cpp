#include "wearwell/plan/size.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/option_value.h"
#include "wearwell/plan/size_report.h"

namespace wearwell::plan {
namespace {

double size_share(const char* option, const std::string& text) {
  const double share = option_value(option, text, "1", Allowed::positive);
  if (!(share < 1))
    throw InputError(
        fmt::format("{}: {} must lie between 0 and 1 (or 0 % and 100 %)", option, printable(text)));
  return share;
}

// "factor 2", or a difference in the unit of the goal.
void read_width(const std::string& text, SizeReport& report) {
  report.ratio = text.starts_with("factor");
  const Unit& unit = report.goal.unit;
  if (report.ratio) {
    report.width = option_value("--width", text.substr(6), "1", Allowed::positive);
    if (!(report.width > 1))
      throw InputError(
          fmt::format("--width: '{}': the ratio of the upper to the lower end must be above 1",
                      printable(text)));
    return;
  }
  try {
    // A difference: without the offset of a unit.
    const Quantity quantity = read_quantity(text, unit.text);
    report.width = quantity.value * quantity.unit.scale / unit.scale;
  } catch (const InputError& error) {
    throw InputError(fmt::format(
        "--width: '{}' must be like 'factor 2', or a difference with a unit like {}: {}",
        printable(text), unit.text, error.what()));
  }
  if (!(report.width > 0))
    throw InputError(fmt::format("--width: '{}' must be positive", printable(text)));
}

// Progress over all sizes, whose number is not known.
class Progress {
 public:
  explicit Progress(const Monitor& monitor) : monitor_(monitor) {}

  void done() {
    if (monitor_.stop.stop_requested()) throw Cancelled();
    if (!monitor_.progress) return;
    const std::lock_guard lock(mutex_);
    const std::chrono::duration<double> since = std::chrono::steady_clock::now() - start_;
    monitor_.progress({"simulated fits", ++count_, 0, since.count()});
  }

 private:
  const Monitor& monitor_;
  std::mutex mutex_;
  long long count_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

struct OneFit {
  std::optional<GoalInterval> interval;
  double truth = 0;  // unit of the goal
  bool without_failure = false;
};

// The interval after the first `size` specimens. A study may refuse run-outs alone, which then bound
// nothing.
void find_interval(const SizeReport& report, std::span<const std::size_t> specimens,
                   const SimulatedCampaign& campaign, std::size_t size, OneFit& fit) {
  const auto first = std::span(campaign.outcomes).first(size);
  const bool runouts =
      std::all_of(first.begin(), first.end(), [](const TestOutcome& each) { return each.runout; });
  try {
    fit.interval =
        goal_interval(*report.planning, report.goal, specimens, campaign, size, report.level);
  } catch (const InputError&) {
    if (!runouts) throw;
    fit.without_failure = true;
  }
}

SizeRow row_of(const SizeReport& report, const std::vector<SimulatedCampaign>& campaigns,
               const std::vector<OneFit>& fits, std::size_t size) {
  SizeRow row;
  row.size = size;
  row.runs = campaigns.size();
  std::vector<double> widths;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const auto& interval = fits[i].interval;
    double longest = 0;
    for (std::size_t s = 0; s < size; ++s) {
      const TestOutcome& outcome = campaigns[i].outcomes[s];
      row.runouts += outcome.runout;
      row.failures += !outcome.runout;
      row.time += outcome.value;
      longest = std::max(longest, outcome.value);
    }
    row.longest += longest;
    if (!interval) {
      ++(fits[i].without_failure ? row.without_failure : row.unresolved);
      widths.push_back(INFINITY);
      continue;
    }
    const double width = report.ratio
                             ? (interval->low > 0 ? interval->high / interval->low : INFINITY)
                             : interval->high - interval->low;
    widths.push_back(width);
    row.narrow += width <= report.width;
    row.covered += interval->low <= fits[i].truth && fits[i].truth <= interval->high;
  }
  std::sort(widths.begin(), widths.end());
  row.median_width = widths[widths.size() / 2];
  const auto runs = static_cast<double>(row.runs);
  for (double* each : {&row.runouts, &row.failures, &row.time, &row.longest}) *each /= runs;
  return row;
}

}  // namespace

Answer size(const SizeQuestion& question, const Source& source, const Table& tests,
            const ReadStudy& read, const Monitor& monitor) {
  SizeReport report;
  report.assurance = size_share("--assurance", question.assurance);
  report.level = size_share("--level", question.level);
  if (question.goal.empty())
    throw InputError("--goal: is missing: what the tests are to determine, like 'B10 at hanger'");
  if (question.width.empty())
    throw InputError("--width: is missing: how wide the goal's interval may be, like 'factor 2'");
  const PlanningStudy planning = planning_study(source, read, tests, question.measure);
  report.planning = &planning;
  report.goal = goal_of(planning.study(), question.goal);
  read_width(question.width, report);
  report.seed = question.seed;
  const std::vector<std::size_t> specimens = allocation(planning.shares, question.most);
  const std::vector<SimulatedCampaign> campaigns =
      simulated_campaigns(planning, specimens, question.simulations, question.seed);
  Progress progress(monitor);
  const auto at = [&](std::size_t size) {
    std::vector<OneFit> fits(campaigns.size());
    tbb::parallel_for(std::size_t{0}, campaigns.size(), [&](std::size_t i) {
      find_interval(report, specimens, campaigns[i], size, fits[i]);
      fits[i].truth = from_si(report.goal.unit, report.goal.value(campaigns[i].truth.data()));
      progress.done();
    });
    report.rows.push_back(row_of(report, campaigns, fits, size));
    return AssurancePoint{size, report.rows.back().narrow, campaigns.size()};
  };
  const std::size_t first =
      std::min(question.most, std::max<std::size_t>(4, planning.shares.size()));
  report.search = search_assurance(at, first, question.most, report.assurance);
  std::sort(report.rows.begin(), report.rows.end(),
            [](const SizeRow& a, const SizeRow& b) { return a.size < b.size; });
  return size_answer(report);
}

}  // namespace wearwell::plan
