// Events of a unit: its state is that of a unit whose readings were right, and of the present part, from the start.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "monitor/events_rig.h"
#include "wearwell/monitor/export_lives.h"
#include "wearwell/monitor/export_readings.h"
#include "wearwell/monitor/learned_readings.h"
#include "wearwell/monitor/stored_units.h"

namespace wearwell::monitor {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(Events, ANewPartBeginsAnew) {
  open();
  send_two_parts();
  EXPECT_NE(view("a").at, view("new").at);
  EXPECT_EQ(report("a", "replaced", R"("n": 11, "time": 500)").events, 1U);
  expect_same("a", "new");
  EXPECT_EQ(view("a").part, 2);
  EXPECT_EQ(view("new").part, 1);
  const UnitDetail detail = *fleet_->unit("a");
  ASSERT_EQ(detail.events.size(), 1U);
  EXPECT_EQ(detail.events[0].event.author, "A. Smith");
  EXPECT_EQ(detail.events[0].use, 500);
  EXPECT_EQ(detail.moments.front().key, 11);
}

// A part that goes into service: its readings count from there; those before belong to the earlier part.
TEST_F(Events, APartIsInstalled) {
  open();
  EXPECT_EQ(report("c", "installed", R"("n": 11, "time": 500)").events, 1U);
  EXPECT_EQ(view("c").alarm, Alarm::ok);
  for (int n = 1; n <= 20; ++n)
    deliver(message("c", n, n < 11 ? 99.0 * n : 60.0 * (n - 10), 50 * n));
  for (int n = 11; n <= 20; ++n) deliver(message("new", n, 60.0 * (n - 10), 50 * (n - 10)));
  expect_same("c", "new");
  EXPECT_EQ(view("c").part, 2);
  EXPECT_THAT(report("c", "installed", R"("n": 30)").problem, HasSubstr("time is missing"));
}

// The first part of a unit is part 1, whatever it begins with; a reading before it makes it part 2.
TEST_F(Events, TheFirstPartIsPart1) {
  open();
  report("c", "installed", R"("n": 11, "time": 500)");
  EXPECT_EQ(view("c").part, 1);
  for (int n = 11; n <= 15; ++n) deliver(message("c", n, 60.0 * (n - 10), 50 * n));
  report("c", "replaced", R"("n": 16, "time": 750)");
  deliver(message("c", 16, 40, 800));
  EXPECT_EQ(view("c").part, 2);
  const auto exported = [&] {
    ExportCounts counts;
    std::set<std::string> names;
    std::istringstream lines(readings_as_csv(*store_, tracker_, {}, counts));
    for (std::string line; std::getline(lines, line);) names.insert(line.substr(0, line.find(',')));
    return names;
  };
  EXPECT_THAT(exported(), ElementsAre("c", "c (part 2)", "machine"));
  std::uint64_t lives = 0;
  EXPECT_THAT(lives_as_csv(*store_, tracker_, lives),
              AllOf(HasSubstr("\nc,250,"), HasSubstr("\nc (part 2),50,")));
  fleet_->save();
  open();
  EXPECT_EQ(view("c").part, 2);
  // A withdrawn reading is of no part.
  deliver(message("c", 5, 200, 250));
  EXPECT_EQ(view("c").part, 3);
  EXPECT_THAT(exported(), ElementsAre("c", "c (part 2)", "c (part 3)", "machine"));
  report("c", "withdrawn", R"("n": 5)");
  EXPECT_EQ(view("c").part, 2);
  // One that has failed was there, without a reading.
  deliver(message("d", 1, 20, 20));
  report("d", "withdrawn", R"("n": 1)");
  report("d", "failed", R"("n": 3, "time": 100)");
  report("d", "installed", R"("n": 4, "time": 0)");
  EXPECT_EQ(view("d").part, 2);
  // Another part than that of the study, or the same?
  GrowthTracker study;
  study.set_study({{"e", 10}});
  UnitEvent installed;
  installed.unit = "e";
  installed.kind = EventKind::installed;
  installed.author = "A. Smith";
  installed.use = 0;
  EXPECT_THAT(event_problem(installed, study),
              AllOf(HasSubstr("'e' is a machine of the study"), HasSubstr("\"replaced\"")));
  installed.part = "e";
  EXPECT_EQ(event_problem(installed, study), "");
  installed.part = {};
  installed.unit = "f";
  EXPECT_EQ(event_problem(installed, study), "");
  // A later part of the study, or one more?
  study.set_study({{"f", 10}, {"f (part 2)", 20}, {"g (left)", 5}});
  for (const EventKind kind : {EventKind::installed, EventKind::replaced}) {
    installed.kind = kind;
    EXPECT_THAT(
        event_problem(installed, study),
        AllOf(HasSubstr("the study has the machine 'f (part 2)'"),
              HasSubstr("part_name = \"f (part 2)\""), HasSubstr("part_name = \"f (part 3)\"")));
  }
  installed.part = "f (part 3)";
  EXPECT_EQ(event_problem(installed, study), "");
}

// Most often the name is wrong. The same holds for every source; the store is asked, so that a unit is known
// from its first reading on, whether it is processed or not.
TEST_F(Events, OfAUnitThatIsNotKnownAreRefused) {
  open();
  for (const auto& [event, more] :
       {std::pair("replaced", R"("n": 11, "time": 500)"),
        std::pair("failed", R"("n": 11, "time": 500)"), std::pair("removed", R"("n": 11)"),
        std::pair("sensor", R"("n": 11, "wear": 3)"),
        std::pair("repaired", R"("n": 11, "restored": 3)"), std::pair("withdrawn", R"("n": 11)")}) {
    const Delivery refused = report("unknown", event, more);
    EXPECT_EQ(refused.events, 0U);
    EXPECT_EQ(refused.refused, 1U);
    EXPECT_TRUE(refused.unknown_unit);
    EXPECT_THAT(refused.problem, AllOf(HasSubstr(fmt::format("{}: 'unknown' is not a unit", event)),
                                       HasSubstr("\"installed\"")));
  }
  EXPECT_TRUE(store_->events_after(0).empty());
  EXPECT_FALSE(store_->has_unit("unknown"));
  EXPECT_FALSE(tally_->knows("unknown"));
  catch_up();
  EXPECT_FALSE(fleet_->unit("unknown"));
  // A reading makes it known: before it is processed, and in the same message.
  deliver(message("a", 1, 50, 50));
  EXPECT_FALSE(fleet_->view("a"));
  EXPECT_EQ(report("a", "replaced", R"("n": 2, "time": 60)").events, 1U);
  const Delivery both = deliver(R"({"machine": "b", "event": "removed", "n": 1, "by": "x"})" +
                                std::string("\n") + message("b", 1, 50, 50));
  EXPECT_EQ(both.readings + both.events, 2U);
  // So does "installed", and the study.
  const std::string fresh =
      R"({"machine": "c", "event": "installed", "n": 1, "time": 0, "by": "x"})";
  const Delivery begun =
      deliver(fresh + "\n" + R"({"machine": "c", "event": "removed", "n": 2, "by": "x"})");
  EXPECT_EQ(begun.events, 2U);
  source_.mapping.in_study = [](const std::string& unit) { return unit == "of the study"; };
  EXPECT_EQ(report("of the study", "replaced", R"("n": 1, "time": 5)").events, 1U);
  EXPECT_EQ(report("of a study", "replaced", R"("n": 1, "time": 5)").events, 0U);
}

// A machine may have the name that the second part of another would have.
TEST_F(Events, EachPartIsExportedUnderANameOfItsOwn) {
  open();
  for (int n = 1; n <= 3; ++n) deliver(message("R3", n, 50 * n, 50 * n));
  deliver(message("R3 (part 2)", 1, 10, 10));
  report("R3", "replaced", R"("n": 3, "time": 110)");
  ExportCounts counts;
  std::uint64_t lives = 0;
  const auto twice =
      AllOf(HasSubstr("two parts have the name 'R3 (part 2)'"), HasSubstr("unit 'R3 (part 2)'"),
            HasSubstr("the part of unit 'R3' that event 1 began"), HasSubstr("part_name"));
  EXPECT_THAT(message_of<InputError>([&] { readings_as_csv(*store_, tracker_, {}, counts); }),
              twice);
  EXPECT_THAT(message_of<InputError>([&] { lives_as_csv(*store_, tracker_, lives); }), twice);
  report("R3", "cancelled", R"("number": 1)");
  report("R3", "replaced", R"("n": 3, "time": 110, "part_name": "R3, spring 2026")");
  const std::string text = readings_as_csv(*store_, tracker_, {}, counts);
  EXPECT_THAT(text, AllOf(HasSubstr("\n\"R3, spring 2026\",3,"), HasSubstr("\nR3 (part 2),1,")));
  EXPECT_THAT(lives_as_csv(*store_, tracker_, lives), HasSubstr("\n\"R3, spring 2026\",40,"));
  EXPECT_EQ(counts.readings, 4U);
  EXPECT_THAT(report("R3", "failed", R"("n": 3, "time": 150, "part_name": "x")").problem,
              HasSubstr("part_name is for \"installed\" and \"replaced\" alone"));
  // What the study has under the name of a part that is new is another part.
  const auto events = events_of(events_of_units(*store_, tracker_), "R3");
  GrowthTracker study;
  study.set_study({{"R3 (part 3)", 100}, {"R3, spring 2026", 30}});
  EXPECT_EQ(begun_name("R3", *events, study), "R3, spring 2026");
  // Learned readings are found under the name, too.
  EXPECT_EQ(learned_from(*store_, study), "");
  study.set_study({{"R3, spring 2026", 40}});
  EXPECT_THAT(learned_from(*store_, study), HasSubstr("machine 'R3, spring 2026'"));
  report("a", "installed", R"("n": 1, "time": 0)");
  report("a", "replaced", R"("n": 5, "time": 0)");
  study.set_study({{"a (part 3)", 100}});
  EXPECT_EQ(begun_name("a", *events_of(events_of_units(*store_, tracker_), "a"), study),
            "a (part 3)'");
}

// A part that the study has learned goes on under a counter that shows more than its own use.
TEST_F(Events, APartOfTheStudyGoesOn) {
  tracker_.set_study({{"a", 100}, {"a (part 2)", 40}});
  source_.mapping.in_study = [](const std::string& unit) { return unit == "a"; };
  source_.mapping.event_problem = [this](const UnitEvent& event) {
    return event_problem(event, tracker_);
  };
  open();
  EXPECT_THAT(report("a", "replaced", R"("n": 1, "time": 500)").problem,
              HasSubstr("the study has the machine 'a (part 2)'"));
  EXPECT_EQ(report("a", "replaced", R"x("n": 1, "time": 500, "part_name": "a (part 2)")x").events,
            1U);
  EXPECT_EQ(view("a").at, 40);  // where the study left it
  deliver(message("a", 1, 60, 560));
  deliver(message("a (part 2)", 1, 60, 60));
  expect_same("a", "a (part 2)");
  EXPECT_EQ(view("a").at, 60);
  fleet_->save();
  const std::string state = bits();
  open();
  EXPECT_EQ(view("a").at, 60);
  EXPECT_TRUE(bits() == state);
  EXPECT_EQ(fleet_->unit("a")->events.at(0).event.part, "a (part 2)");
  // Its readings are exported under the name of the study, where those of another unit are not.
  ExportCounts counts;
  EXPECT_THAT(message_of<InputError>([&] { readings_as_csv(*store_, tracker_, {}, counts); }),
              HasSubstr("two parts have the name 'a (part 2)'"));
}

// When an event comes makes no difference: before the readings, among them, or after a restart that lost the latest states.
TEST_F(Events, CountTheSameWhenTheyCome) {
  open();
  send_two_parts();
  report("a", "replaced", R"("n": 11, "time": 500)");
  catch_up();
  const std::string late = bits();
  close();
  std::filesystem::remove(folder() / "fleet.sqlite");
  open();
  deliver(message("a", 1, 99.0, 50));
  report("a", "replaced", R"("n": 11, "time": 500)");
  catch_up();
  send_two_parts();
  catch_up();
  EXPECT_TRUE(bits() == late);
  close();
  std::filesystem::remove(folder() / "fleet.sqlite");
  open();
  send_two_parts();
  catch_up();
  fleet_->save();
  report("a", "replaced", R"("n": 11, "time": 500)");
  close();  // killed: the saved state is from before the event
  open();
  fleet_->refresh(true);
  EXPECT_TRUE(bits() == late);
}

// A reading of the earlier part that arrives late stays with that part.
TEST_F(Events, ALateReadingBelongsToItsPart) {
  open();
  for (int n = 1; n <= 5; ++n) deliver(message("a", n, 50.0 * n, 50 * n));
  report("a", "replaced", R"("n": 11, "time": 500)");
  for (int n = 11; n <= 15; ++n) {
    deliver(message("a", n, 60.0 * (n - 10), 50 * n));
    deliver(message("new", n, 60.0 * (n - 10), 50 * (n - 10)));
  }
  deliver(message("a", 6, 300, 300));
  expect_same("a", "new");
}

TEST_F(Events, ReadingsAreCorrectedAndWithdrawn) {
  open();
  deliver(message("a", 1, 7000, 10));  // millimetres
  deliver(message("a", 2, 20, 20));
  deliver(message("a", 3, 999, 20.5));
  deliver(message("a", 4, 30, 30));
  deliver(message("right", 1, 10, 10));
  deliver(message("right", 2, 20, 20));
  deliver(message("right", 4, 30, 30));
  EXPECT_EQ(report("a", "corrected", R"("n": 1, "wear": 70, "time": 10)").events, 1U);
  EXPECT_EQ(report("a", "corrected", R"("n": 1, "wear": 10, "time": 10)").events, 1U);
  EXPECT_EQ(report("a", "withdrawn", R"("n": 3)").events, 1U);
  EXPECT_EQ(report("a", "withdrawn", R"("n": 3)").repeated, 1U);
  expect_same("a", "right");
  // What was stored stays.
  EXPECT_EQ(store_->reading("a", 1)->numbers[0], 7000);
  ExportCounts counts;
  EXPECT_THAT(readings_as_csv(*store_, tracker_, {}, counts),
              testing::AllOf(testing::Not(HasSubstr("7000")), testing::Not(HasSubstr("999"))));
  EXPECT_EQ(counts.readings, 6U);
}

// Of units in doubt, all readings of the part are marked; those of an earlier part are not.
TEST_F(Events, ReadingsOfUnitsInDoubtAreMarkedInAnExport) {
  open();
  for (int n = 1; n <= 8; ++n) deliver(message("right", n, 50.0 * n, 50 * n));
  for (int n = 1; n <= 4; ++n) deliver(message("odd", n, 50.0 * n, 50 * n));
  report("odd", "replaced", R"("n": 5, "time": 200)");
  for (int n = 5; n <= 16; ++n)
    deliver(message("odd", n, 50.0 * (n - 4) + (n > 10 ? 400 : 0), 50 * n));
  ASSERT_NE(view("odd").doubt, "");
  ASSERT_EQ(view("right").doubt, "");
  const DoubtedParts doubted =
      doubted_parts(*store_, {std::make_shared<const GrowthTracker>(), "population", true, 0});
  EXPECT_THAT(doubted, ElementsAre("odd (part 2)"));
  ExportCounts counts;
  const std::string text = readings_as_csv(*store_, tracker_, doubted, counts);
  EXPECT_EQ(counts.readings, 24U);
  EXPECT_EQ(counts.doubted, 12U);
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  EXPECT_TRUE(line.ends_with(",doubt")) << line;
  while (std::getline(lines, line))
    EXPECT_TRUE(line.ends_with(line.starts_with("odd (part 2)") ? ",1" : ",0")) << line;
}

TEST_F(Events, AWrongEventIsCancelled) {
  open();
  send_two_parts();
  catch_up();
  const UnitView before = view("a");
  report("a", "replaced", R"("n": 11, "time": 500)");
  report("a", "withdrawn", R"("n": 12)");
  EXPECT_NE(view("a").at, before.at);
  EXPECT_EQ(report("a", "cancelled", R"("number": 1)").events, 1U);
  EXPECT_EQ(report("a", "cancelled", R"("number": 2)").events, 1U);
  const UnitView after = view("a");
  EXPECT_EQ(after.risk, before.risk);
  EXPECT_EQ(after.doubt, before.doubt);
  EXPECT_EQ(after.part, 1);
  EXPECT_TRUE(fleet_->unit("a")->events[0].cancelled);
}

TEST_F(Events, ASensorHasAnOffset) {
  open();
  for (int n = 1; n <= 8; ++n) {
    deliver(message("a", n, 50.0 * n + (n >= 5 ? 30 : 0), 50 * n));
    deliver(message("right", n, 50.0 * n, 50 * n));
  }
  report("a", "sensor", R"("n": 5, "wear": 30)");
  expect_same("a", "right");
}

TEST_F(Events, APartIsOutOfServiceUntilItIsReplaced) {
  open();
  for (int n = 1; n <= 10; ++n) deliver(message("a", n, 99.0 * n, 50 * n));
  EXPECT_EQ(view("a").alarm, Alarm::act);
  report("a", "failed", R"("n": 10, "time": 510)");
  EXPECT_EQ(view("a").alarm, Alarm::unknown);
  EXPECT_EQ(view("a").service, Service::failed);
  deliver(message("a", 11, 10, 520));
  EXPECT_EQ(view("a").quality.refused, 1U);
  EXPECT_THAT(view("a").quality.last_problem, HasSubstr("out of service (failed)"));
  EXPECT_THAT(changes_.back(), HasSubstr("act -> unknown"));
  report("a", "replaced", R"("n": 11, "time": 510)");
  EXPECT_EQ(view("a").service, Service::in_service);
  EXPECT_EQ(view("a").alarm, Alarm::ok);
  EXPECT_EQ(view("a").quality.readings, 1U);
  deliver(message("b", 1, 50, 50));
  report("b", "removed", R"("n": 1)");
  std::uint64_t count = 0;
  EXPECT_EQ(lives_as_csv(*store_, tracker_, count),
            "machine,time [h],status\n"
            "a,510,failed\n"
            "a (part 2),10,suspended\n"
            "b,50,suspended\n");
  EXPECT_EQ(count, 3U);
}

// Of two ends under one key the last holds, and a part cannot end before it is installed.
TEST_F(Events, EndsOfAPart) {
  open();
  for (int n = 1; n <= 3; ++n) deliver(message("a", n, 50.0 * n, 50 * n));
  report("a", "removed", R"("n": 3)");
  report("a", "failed", R"("n": 3, "time": 160)");
  EXPECT_EQ(view("a").service, Service::failed);
  std::uint64_t count = 0;
  EXPECT_THAT(lives_as_csv(*store_, tracker_, count), HasSubstr("a,160,failed"));
  report("a", "replaced", R"("n": 4, "time": 200)");
  report("a", "failed", R"("n": 5, "time": 40)");
  EXPECT_THAT(message_of<InputError>([&] { lives_as_csv(*store_, tracker_, count); }),
              HasSubstr("unit 'a' is reported as failed at time = 40"));
}

// An event that is stored already but does not hold is said to be so.
TEST_F(Events, ThatCameBeforeAndDoNotHold) {
  open();
  deliver(message("a", 1, 10, 10));
  report("a", "corrected", R"("n": 1, "wear": 20, "time": 10)");
  report("a", "corrected", R"("n": 1, "wear": 30, "time": 10)");
  EXPECT_EQ(report("a", "corrected", R"("n": 1, "wear": 30, "time": 10)").problem, "");
  const Delivery again = report("a", "corrected", R"("n": 1, "wear": 20, "time": 10)");
  EXPECT_EQ(again.repeated, 1U);
  EXPECT_THAT(again.problem, HasSubstr("event 1 again, which event 2 has replaced"));
  report("a", "failed", R"("n": 1, "time": 10)");
  report("a", "cancelled", R"("number": 3)");
  EXPECT_THAT(report("a", "failed", R"("n": 1, "time": 10)").problem,
              HasSubstr("event 3 again, which is cancelled"));
  EXPECT_EQ(report("a", "failed", R"("n": 1, "time": 10, "note": "indeed")").events, 1U);
  EXPECT_EQ(view("a").service, Service::failed);
}

// What is shown of the past follows, too; and the largest key is known where not every reading is kept.
TEST_F(Events, ChangeTheHistory) {
  open();
  for (int n = 1; n <= 14; ++n) deliver(message("a", n, 50.0 * n, 50 * n));
  catch_up();
  EXPECT_EQ(fleet_->unit("a")->moments[9].measured, 500);
  EXPECT_EQ(fleet_->unit("a")->moments.back().key, 14);
  report("a", "corrected", R"("n": 10, "wear": 480, "time": 500)");
  catch_up();
  EXPECT_EQ(fleet_->unit("a")->moments[9].measured, 480);
  ASSERT_EQ(fleet_->unit("a")->events[0].values.size(), 2U);
  EXPECT_EQ(fleet_->unit("a")->events[0].values[0].second, 480);
  report("a", "replaced", R"("n": 15, "time": 700)");
  EXPECT_EQ(view("a").last_key, 14);
  // A unit of which only an event is known survives a restart.
  report("b", "installed", R"("n": 1, "time": 0)");
  catch_up();
  close();
  open();
  catch_up();
  EXPECT_TRUE(fleet_->unit("b"));
}

TEST_F(Events, ThatNoUnitCanHaveAreRefused) {
  open();
  for (int n = 1; n <= 3; ++n) deliver(message("a", n, 100 * n, 100 * n));
  for (const char* event : {"installed", "replaced", "failed"})
    EXPECT_THAT(
        report(event == std::string("installed") ? "z" : "a", event, R"("n": 9, "time": 1e300)")
            .problem,
        HasSubstr("more than a million times the life of a new machine"))
        << event;
  EXPECT_THAT(report("a", "sensor", R"("n": 9, "wear": -1e300)").problem,
              HasSubstr("sensor: the offset is more than 10^12 times the threshold of 1"));
  EXPECT_THAT(report("a", "repaired", R"("n": 9, "restored": 10001)").problem,
              HasSubstr("repaired: restored is more than ten times the threshold of 1"));
  EXPECT_TRUE(store_->events_after(0).empty());
  // What only the readings show.
  report("a", "repaired", R"("n": 4, "restored": 700)");
  EXPECT_THAT(view("a").quality.state_problem, HasSubstr("repairs take back more than there was"));
  report("a", "cancelled", R"("number": 1)");
  EXPECT_EQ(view("a").quality.state_problem, "");
  report("a", "failed", R"("n": 4, "time": 120)");
  EXPECT_THAT(
      view("a").quality.state_problem,
      HasSubstr("failed at time = 120, but has a reading before at 300 on the same counter"));
  std::uint64_t lives = 0;
  EXPECT_THAT(message_of<InputError>([&] { lives_as_csv(*store_, tracker_, lives); }),
              AllOf(HasSubstr("unit 'a'"), HasSubstr("has a reading before at 300")));
  // A part before the first installation of which nothing is known has no life.
  report("a", "cancelled", R"("number": 3)");
  deliver(message("b", 1, 50, 450));
  report("b", "replaced", R"("n": 1, "time": 400)");
  EXPECT_EQ(lives_as_csv(*store_, tracker_, lives),
            "machine,time [h],status\na,300,suspended\nb (part 2),50,suspended\n");
}

TEST_F(Events, AreRefusedWithAReason) {
  open();
  deliver(message("a", 1, 10, 10));
  const auto why = [&](const std::string& event, const std::string& more) {
    const Delivery delivery = report("a", event, more);
    EXPECT_EQ(delivery.events, 0U);
    return delivery.problem;
  };
  EXPECT_THAT(why("repalced", R"("n": 2)"),
              HasSubstr("must be one of installed, replaced, repaired, removed, failed"));
  EXPECT_THAT(why("replaced", R"("n": 2)"), HasSubstr("time is missing"));
  EXPECT_THAT(why("failed", R"("n": 2)"), HasSubstr("time is missing"));
  EXPECT_THAT(why("replaced", R"("n": 2, "time": -1)"), HasSubstr("time is negative"));
  EXPECT_THAT(why("replaced", R"("time": 1)"), HasSubstr("n is missing"));
  EXPECT_THAT(why("withdrawn", R"("n": 2)"), HasSubstr("has no stored reading with key 2"));
  EXPECT_THAT(why("corrected", R"("n": 2, "wear": 1, "time": 1)"),
              HasSubstr("has no stored reading with key 2"));
  EXPECT_THAT(why("corrected", R"("n": 1, "time": 1)"), HasSubstr("wear is missing"));
  EXPECT_THAT(why("sensor", R"("n": 1)"), HasSubstr("wear is missing"));
  EXPECT_THAT(why("cancelled", R"("number": 1)"), HasSubstr("has no event with number 1"));
  EXPECT_THAT(deliver(R"({"machine": "a", "event": "withdrawn", "n": 1})").problem,
              HasSubstr("by is missing"));
  EXPECT_EQ(store_->events_after(0).size(), 0U);
  // A reading and its withdrawal may come in one message.
  const Delivery both = deliver(message("a", 2, 10, 20) + "\n" +
                                R"({"machine": "a", "event": "withdrawn", "n": 2, "by": "x"})");
  EXPECT_EQ(both.readings + both.events, 2U);
}

// A state in the form of another version is no damage, and is rebuilt to the same bits.
TEST_F(Events, StatesOfAnotherVersionAreRebuilt) {
  open();
  send_two_parts();
  catch_up();
  const std::string state = bits();
  std::vector<Checkpoint> saved = store_->states("population");
  for (Checkpoint& each : saved) {
    nlohmann::json json = nlohmann::json::from_cbor(each.bytes);
    json["version"] = 0;
    const std::vector<std::uint8_t> bytes = nlohmann::json::to_cbor(json);
    each.bytes.assign(bytes.begin(), bytes.end());
    EXPECT_THAT(message_of<InputError>(
                    [&] { restored_record(each, tracker_, std::make_shared<const UnitEvents>()); }),
                HasSubstr("'" + each.unit + "' was saved by another version"));
  }
  store_->save("population", saved, store_->all_up_to("population"));
  open();
  catch_up();
  EXPECT_TRUE(bits() == state);
}

// Decisions and running monitors see the same units.
TEST_F(Events, AreInWhatAStoreTells) {
  open();
  send_two_parts();
  catch_up();
  fleet_->save();
  report("a", "replaced", R"("n": 11, "time": 500)");
  report("new", "removed", R"("n": 20)");
  const auto units =
      stored_units(*store_, {std::make_shared<const GrowthTracker>(), "population", true, 0});
  EXPECT_EQ(units.at("a").events->part().number, 2);
  EXPECT_EQ(units.at("new").events->part().service, Service::removed);
  catch_up();
  fleet_->save();
  for (const Checkpoint& each : store_->states("population"))
    EXPECT_TRUE(bytes_of(units.at(each.unit)) == each.bytes) << each.unit;
}

}  // namespace
}  // namespace wearwell::monitor
