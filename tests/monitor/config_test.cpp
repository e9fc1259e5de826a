// A configuration means one thing, or is refused with its place.
#include <gmock/gmock.h>

#include "monitor/growth_tracker.h"
#include "support/scratch.h"
#include "wearwell/monitor/monitor_config.h"

namespace wearwell::monitor {
namespace {

using testing::HasSubstr;

class Configs : public ScratchTest {
 protected:
  static constexpr const char* good = R"(result = "result"
[reading]
unit = "machine"
time = "t"
time_format = "iso 8601"
[reading.columns]
wear = { field = "w", unit = "um" }
time = { field = "h", unit = "min" }
[source.line]
kind = "stdin"
[alarm]
horizon = "2 h"
watch = "10 %"
silence = "1 d"
)";
  MonitorConfig read(const std::string& text) const {
    std::filesystem::create_directories(folder() / "result");
    const TomlReader root = TomlReader::parse({folder() / "c.toml", text});
    EXPECT_EQ(read_result_path(root), folder() / "result");
    return read_monitor_config(root, tracker_);
  }
  /// What is said when `from` is replaced, behind the file's name.
  std::string refusal(const std::string& from, const std::string& to) const {
    std::string text = good;
    const std::size_t at = text.find(from);
    if (at == text.npos) throw std::logic_error(from);
    text.replace(at, from.size(), to);
    const std::string message = message_of<InputError>([&] { read(text); });
    const std::string file = (folder() / "c.toml").string();
    EXPECT_TRUE(message.starts_with(file + ":")) << message;
    return message.substr(std::min(file.size() + 1, message.size()));
  }
  GrowthTracker tracker_;
};

TEST_F(Configs, KeepReadingsForATime) {
  std::string text = good;
  text.replace(text.find("[alarm]"), 7, "[store]\nkeep = \"5 years\"\n[alarm]");
  const MonitorConfig config = read(text);
  ASSERT_TRUE(config.keep_s);
  EXPECT_NEAR(*config.keep_s / 86400, 5 * 365.25, 0.1);
  EXPECT_EQ(config.store, "fleet.sqlite");
}

TEST_F(Configs, Whole) {
  const MonitorConfig config = read(good);
  EXPECT_EQ(config.store, "fleet.sqlite");
  EXPECT_FALSE(config.keep_s);
  EXPECT_EQ(config.alarm.horizon, 7200);
  EXPECT_EQ(config.alarm.watch, 0.1);
  EXPECT_EQ(config.alarm.act, 0.2);
  EXPECT_EQ(config.alarm.silence, 86400);
  EXPECT_FALSE(config.http);
  EXPECT_FALSE(config.sequence);
  ASSERT_EQ(config.sources.size(), 1U);
  const ReadingMapping& mapping = config.sources[0].mapping;
  EXPECT_EQ(mapping.columns[0].unit.scale, 1e-6);
  EXPECT_EQ(mapping.columns[1].unit.scale, 60);
  const StoredReading reading = reading_of(
      fields_of_json(R"({"machine": "M1", "t": "2026-11-22T15:04:05Z", "w": 1500000, "h": 30})"),
      "", mapping, 5);
  EXPECT_EQ(reading.unit, "M1");
  EXPECT_EQ(reading.key, 1795359845000);
  EXPECT_EQ(reading.numbers, (std::vector<double>{1.5, 1800}));
}

TEST_F(Configs, RefuseReadingsThatNoUnitCanHave) {
  const MonitorConfig config = read(good);
  const auto refusal = [&](const std::string& wear, const std::string& time) {
    return message_of<InputError>([&] {
      reading_of(fields_of_json(R"({"machine": "M1", "t": "2026-11-22T15:04:05Z", "w": )" + wear +
                                R"(, "h": )" + time + "}"),
                 "", config.sources[0].mapping, 5);
    });
  };
  EXPECT_EQ(refusal("1", "-3"), "time is negative");
  EXPECT_THAT(
      refusal("1", "1e300"),
      testing::AllOf(HasSubstr("time = "),
                     HasSubstr(" is more than a million times the life of a new machine (")));
  EXPECT_THAT(refusal("1e300", "3"), HasSubstr("wear = "));
  EXPECT_THAT(refusal("1e300", "3"), HasSubstr(" is more than 10^12 times the threshold of "));
  // Far, but not out of the question: a change of unit is found later.
  EXPECT_NO_THROW(reading_of(
      fields_of_json(R"({"machine": "M1", "t": "2026-11-22T15:04:05Z", "w": 1e12, "h": 30})"), "",
      config.sources[0].mapping, 5));
}

TEST_F(Configs, ConnectionsOfTheServer) {
  const std::string http = std::string(good) + "[http]\nlisten = \"127.0.0.1:8080\"\n";
  EXPECT_EQ(read(http).http->limits.connections, 256U);
  EXPECT_EQ(read(http).http->limits.of_client, 64U);
  const MonitorConfig config = read(http + "connections = 1000\nconnections_of_client = 900\n");
  EXPECT_EQ(config.http->limits.connections, 1000U);
  EXPECT_EQ(config.http->limits.of_client, 900U);
  EXPECT_THAT(message_of<InputError>([&] { read(http + "connections_of_client = 0\n"); }),
              HasSubstr("http.connections_of_client"));
}

// The unit of a study need not be one of the SI; a column in it is converted all the same.
TEST_F(Configs, UnitsOfTheStudy) {
  std::string text = good;
  text.replace(text.find("\"min\""), 5, "\"h\"");
  EXPECT_EQ(read(text).sources[0].mapping.columns[1].unit.scale, 3600);
  EXPECT_EQ(read(text).alarm.horizon, 7200);
}

TEST_F(Configs, OfABroker) {
  std::string text = good;
  text.replace(text.find("unit = \"machine\"\n"), 17, "");
  text.replace(
      text.find("kind = \"stdin\""), 14,
      "kind = \"mqtt\"\nbroker = \"mqtts://[::1]:99\"\ntopic = \"a/{unit}\"\nclient = \"me\"");
  const SourceSettings source = read(text).sources[0];
  EXPECT_EQ(source.broker.host, "::1");
  EXPECT_EQ(source.broker.port, 99);
  EXPECT_TRUE(source.broker.tls);
  EXPECT_EQ(source.broker.client, "me");
  EXPECT_TRUE(source.mapping.unit.empty());
}

TEST_F(Configs, Refused) {
  EXPECT_THAT(refusal("unit = \"machine\"", "units = \"machine\""),
              HasSubstr("reading.unit: is missing"));
  EXPECT_THAT(refusal("time = \"t\"\ntime_format = \"iso 8601\"", ""), HasSubstr("so is time"));
  EXPECT_THAT(refusal("time_format = \"iso 8601\"", ""),
              HasSubstr("reading.time_format: is missing"));
  EXPECT_THAT(refusal(", unit = \"um\"", ""), HasSubstr("has no unit; write"));
  EXPECT_THAT(refusal("\"um\"", "\"s\""), HasSubstr("wrong dimension"));
  EXPECT_THAT(refusal("wear = {", "wera = {"), HasSubstr("did you mean 'wear'"));
  EXPECT_THAT(refusal("wear = { field = \"w\", unit = \"um\" }", ""),
              HasSubstr("the study has wear [m] as well"));
  EXPECT_THAT(refusal("{ field = \"w\", unit = \"um\" }", "{ value = \"1 um\" }"),
              HasSubstr("cannot be constant"));
  EXPECT_THAT(refusal("\"stdin\"", "\"stdio\""), HasSubstr("nearest: 'stdin'"));
  EXPECT_THAT(refusal("kind = \"stdin\"", "kind = \"stdin\"\n[source.two]\nkind = \"stdin\""),
              HasSubstr("second source of this kind"));
  EXPECT_THAT(refusal("kind = \"stdin\"", "kind = \"folder\"\nfolder = \"nowhere\""),
              HasSubstr("no such file or folder"));
  EXPECT_THAT(refusal("kind = \"stdin\"", "kind = \"http\""), HasSubstr("needs a server, [http]"));
  EXPECT_THAT(refusal("kind = \"stdin\"", "kind = \"mqtt\"\nbroker = \"tcp://x\"\ntopic = \"a\""),
              HasSubstr("mqtt://HOST:PORT"));
  EXPECT_THAT(
      refusal("kind = \"stdin\"", "kind = \"mqtt\"\nbroker = \"mqtt://x\"\ntopic = \"a/{unit}\""),
      HasSubstr("the topic names the unit already"));
  EXPECT_THAT(refusal("horizon = \"2 h\"", ""), HasSubstr("alarm.horizon: is missing"));
  EXPECT_THAT(refusal("horizon = \"2 h\"", "horizon = \"2 km\""), HasSubstr("wrong dimension"));
  EXPECT_THAT(refusal("\"10 %\"", "\"30 %\""), HasSubstr("must be below act"));
  EXPECT_THAT(refusal("[alarm]", "[http]\nlisten = \"0.0.0.0:80\"\n[alarm]"),
              HasSubstr("set a token"));
  EXPECT_THAT(refusal("[alarm]", "[http]\nlisten = \"127.0.0.1:0x\"\n[alarm]"),
              HasSubstr("is not HOST:PORT"));
  EXPECT_THAT(refusal("[alarm]", "[store]\nurl = \"mysql://x\"\n[alarm]"),
              HasSubstr("neither a file nor postgresql"));
  EXPECT_THAT(refusal("[alarm]", "[store]\nurl = \"none/x.sqlite\"\n[alarm]"),
              HasSubstr("store.url: no such folder"));
  EXPECT_THAT(refusal("[alarm]", "[store]\nkeep = \"5 min\"\n[alarm]"),
              HasSubstr("store.keep: must lie between 1 d and 1000 years"));
  EXPECT_THAT(refusal("[alarm]", "[store]\nkeep = \"5 um\"\n[alarm]"), HasSubstr("store.keep"));
  EXPECT_THAT(refusal("[alarm]", "[store]\nkeep = 5\n[alarm]"), HasSubstr("store.keep"));
  for (const char* host : {"127.alarms.example:80", "126.0.0.1:80", "[::2]:80"})
    EXPECT_THAT(refusal("[alarm]", std::string("[http]\nlisten = \"") + host + "\"\n[alarm]"),
                HasSubstr("set a token"));
  EXPECT_THAT(refusal("silence", "silent"), HasSubstr("did you mean 'silence'"));
}

TEST_F(Configs, OfSparkplug) {
  std::string text = good;
  const auto replace = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("unit = \"machine\"", "unit = \"{edge}/{device}\"");
  replace("time = \"t\"", "time = \"{timestamp}\"");
  replace("\"iso 8601\"", "\"unix ms\"");
  replace("unit = \"um\"", "unit = \"{engUnit}\"");
  const std::string other = text;
  replace("kind = \"stdin\"",
          "kind = \"sparkplug\"\nbroker = \"mqtt://h\"\ngroup = \"Hall 2\"\nhost = \"me\"");
  const MonitorConfig config = read(text);
  ASSERT_EQ(config.sources.size(), 1U);
  const SourceSettings& source = config.sources[0];
  EXPECT_EQ(source.kind, SourceKind::sparkplug);
  EXPECT_EQ(source.topic.filter(), "spBv1.0/Hall 2/+/+/#");
  EXPECT_EQ(source.host, "me");
  EXPECT_FALSE(source.births_are_readings);
  EXPECT_TRUE(source.mapping.columns[0].unit_of_message);
  EXPECT_EQ(source.mapping.columns[0].unit.scale, 1);
  const auto refusal_of = [&](const std::string& whole, const std::string& from,
                              const std::string& to) {
    std::string changed = whole;
    changed.replace(changed.find(from), from.size(), to);
    return message_of<InputError>([&] { read(changed); });
  };
  EXPECT_THAT(message_of<InputError>([&] { read(other); }),
              HasSubstr("wear: only metrics of Sparkplug B have an engUnit"));
  EXPECT_THAT(refusal_of(other, "{engUnit}", "um"),
              HasSubstr("'{edge}/{device}' is for Sparkplug B only"));
  EXPECT_THAT(refusal_of(text, "{edge}/{device}", "{edge}/{devise}"),
              HasSubstr("has braces other than {group}, {edge}, {device}"));
  EXPECT_THAT(refusal_of(text, "{edge}/{device}", "{group}"),
              HasSubstr("does not identify the machine"));
  EXPECT_THAT(refusal_of(text, "unix ms", "unix s"),
              HasSubstr("must be \"unix ms\" for {timestamp}"));
  EXPECT_THAT(refusal_of(text, "Hall 2", "a/b"), HasSubstr("'a/b' is not a level of a topic"));
}

TEST_F(Configs, AllProblemsAreReportedTogether) {
  std::string text = good;
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, text.npos) << from;
    text.replace(at, from.size(), to);
  };
  replace("horizon = \"2 h\"\n", "");
  replace("kind = \"stdin\"", "kind = \"mqtt\"");
  replace("result = \"result\"", "result = \"result\"\ntitel = \"x\"");
  text +=
      "[source.second]\nkind = \"folder\"\nfolder = \"none\"\n[http]\ntoken = "
      "\"short\"\n[webhook]\n"
      "url = \"ftp://x\"\n[limits]\nunits = 0\n[store]\nurl = \"redis://x\"\n[publish]\nbroker = "
      "\"mqtt://h\"\nprefiks = \"a\"\n[source.third]\n"
      "kind = \"http\"\nfolders = \"a\"\n";
  const std::string message = message_of<InputError>([&] { read(text); });
  for (const char* each : {"horizon", "broker", "no such file or folder", "16 random ones",
                           "https://HOST/PATH", "units", "neither a file nor postgresql",
                           "did you mean 'title'", "did you mean 'prefix'", "third.folders"})
    EXPECT_THAT(message, HasSubstr(each));
  // Each with its place.
  std::size_t places = 0;
  for (std::size_t at = 0; (at = message.find("c.toml:", at)) != message.npos; ++at) ++places;
  EXPECT_GE(places, 7U) << message;
}

// Several problems of one table, each with a line that is right.
TEST_F(Configs, ProblemsOfOneTableAreAllReported) {
  const std::string text =
      "result = \"result\"\n[reading]\ntime = \"t\"\n[reading.columns]\nwear = \"w\"\n"
      "[source.line]\nkind = \"mqtt\"\nbroker = \"tcp://x\"\n[alarm]\nwatch = \"200 %\"\nact = "
      "\"300 %\"\nsilence = \"2 km\"\n[http]\nlisten = \"127.0.0.1:x\"\nconnections = 0\n"
      "certificate = \"none.pem\"\n[http.tokens.a]\nroles = [\"admin\"]\n[webhook]\nafter = "
      "\"8 d\"\n[store]\nurl = \"redis://x\"\nkeep = \"5 min\"\n";
  const std::string message = message_of<InputError>([&] { read(text); });
  for (const char* each :
       {"broker = \"mqtts://", "topic = \"plant/{unit}/wear\"", "unit = \"machine\"",
        "time_format = \"iso 8601\"", "time = { field = \"time\", unit = \"h\" }",
        "has no unit; write", "horizon = \"500 h\"", "watch = 0.05", "act = 0.2",
        "silence = \"2 d\"", "listen = \"127.0.0.1:8080\"", "connections = 256", "none.pem",
        "token_file = \"NAME.token\"", "'admin' is not a role", "url = \"https://",
        "after = \"1 min\"", "url = \"fleet.sqlite\"", "keep = \"5 years\""})
    EXPECT_THAT(message, HasSubstr(each));
  // Of tables that are missing altogether.
  const std::string none = message_of<InputError>([&] { read("result = \"result\"\n"); });
  for (const char* each : {"[source.line]", "[alarm]", "horizon = "})
    EXPECT_THAT(none, HasSubstr(each));
  const std::string line =
      "result = \"result\"\n[source.line]\nkind = \"stdin\"\n[alarm]\nhorizon = \"1 h\"\n";
  EXPECT_THAT(message_of<InputError>([&] { read(line); }),
              testing::AllOf(HasSubstr("[reading]"), HasSubstr("wear = { field = \"wear\"")));
}

// Unknown keys of all tables, also beside problems of the same table; none of those behind a problem is called unknown.
TEST_F(Configs, UnknownKeysOfAllTablesAreReportedAtOnce) {
  const std::string text =
      "result = \"result\"\ntitel = \"x\"\n[reading]\nunit = \"machine\"\nsequence = 5\nevnt = "
      "\"e\"\n[reading.columns]\nwear = { feld = \"w\", unit = \"um\" }\ntme = { field = \"h\", "
      "unit "
      "= \"min\" }\n[source.a]\nkind = \"folder\"\nfolder = \"none\"\nformt = "
      "\"influx\"\n[source.b]\n"
      "kind = \"stdinn\"\nbroker = \"mqtt://h\"\nbrker = 1\n[alarm]\nhorizon = \"500 kg\"\nwtch = "
      "0.1\n";
  const std::string message = message_of<InputError>([&] { read(text); });
  for (const char* each :
       {"titel: unknown key; did you mean 'title'", "reading.sequence: must be a text",
        "reading.evnt: unknown key; did you mean 'event'", "reading.columns.wear.field: is missing",
        "reading.columns.wear.feld: unknown key; did you mean 'field'",
        "reading.columns.tme: unknown key; did you mean 'time'", "the study has time [h] as well",
        "source.a.folder: no such file or folder",
        "source.a.formt: unknown key; did you mean 'format'",
        "source.b.kind: 'stdinn' is not allowed",
        "source.b.brker: unknown key; did you mean 'broker'",
        "alarm.horizon: unit 'kg' has the wrong dimension",
        "alarm.wtch: unknown key; did you mean 'watch'"})
    EXPECT_THAT(message, HasSubstr(each));
  std::size_t unknown = 0;
  for (std::size_t at = 0; (at = message.find("unknown key", at)) != message.npos; ++at) ++unknown;
  EXPECT_EQ(unknown, 7U) << message;
  // In the order of the file.
  const std::string file = (folder() / "c.toml").string() + ":";
  std::size_t before = 0, places = 0;
  for (std::size_t at = 0; (at = message.find(file, at)) != message.npos; at += file.size()) {
    const std::size_t line = std::stoul(message.substr(at + file.size()));
    EXPECT_LE(before, line) << message;
    before = line;
    ++places;
  }
  EXPECT_EQ(places, 13U) << message;
}

// A [reading] that no source uses would be read as if it counted.
TEST_F(Configs, AReadingThatNoSourceUsesIsRefused) {
  EXPECT_THAT(refusal("kind = \"stdin\"",
                      "kind = \"stdin\"\n[source.line.reading]\nunit = \"machine\"\nsequence = "
                      "\"n\"\n[source.line.reading.columns]\nwear = { field = \"w\", unit = \"um\" "
                      "}\ntime = { field = \"h\", unit = \"min\" }"),
              HasSubstr("reading: is not used"));
}

// What is missing can be copied from the message, and is then right.
TEST_F(Configs, ExamplesOfMissingTablesAreRight) {
  std::string text = "result = \"result\"\n";
  for (int round = 0; round < 2; ++round) {
    std::string message;
    try {
      read(text);
      EXPECT_EQ(round, 1);
    } catch (const InputError& error) {
      message = error.what();
      EXPECT_EQ(round, 0) << message;
    }
    for (std::size_t at = 0; (at = message.find("\n    ", at)) != message.npos; ++at)
      text += message.substr(at + 5, message.find('\n', at + 1) - at - 4) + "\n";
  }
}

TEST_F(Configs, AnEmptyFileIsRefusedWithItsNeeds) {
  write("c.toml", "# nothing\n\n");
  EXPECT_THAT(message_of<InputError>([&] { read_config_file(folder() / "c.toml"); }),
              testing::AllOf(HasSubstr("is empty"), HasSubstr("[reading.columns]"),
                             HasSubstr("[source.NAME]"), HasSubstr("[alarm]")));
}

// Everything that needs no result, beside a result that is missing or cannot be read.
TEST_F(Configs, ProblemsBesideAResultThatCannotBeRead) {
  const TomlReader root = TomlReader::parse(
      {folder() / "c.toml",
       "result = \"nowhere\"\n[store]\nurl = \"sub/dir/x.sqlite\"\n[reading]\nunit = "
       "\"machine\"\nunti = 1\n[reading.columns]\nwear = { field = \"w\", unit = \"kg\" }\n"
       "[source.a]\nkind = \"mqtt\"\n[source.b]\nkind = \"stdinn\"\n[alarm]\nwatch = \"50 %\"\nact "
       "= \"20 %\"\n"});
  const std::string message = message_of<InputError>([&] { read_result_path(root); });
  for (const char* each :
       {"result: no such file or folder", "store.url: no such folder", "so is time",
        "reading.unti: unknown key", "source.a.broker: is missing", "source.a.topic: is missing",
        "source.b.kind: 'stdinn'", "alarm.horizon: is missing", "must be below act"})
    EXPECT_THAT(message, HasSubstr(each));
  EXPECT_THAT(message, testing::Not(HasSubstr("reading.columns")));
  const std::string other =
      message_of<InputError>([&] { refuse_result(root, "nowhere has no state.bin"); });
  EXPECT_THAT(other, testing::AllOf(HasSubstr("must be below act"), HasSubstr("no state.bin")));
}

// Also where the result is not known.
TEST_F(Configs, ProblemsBesideAMissingResultAreReported) {
  const TomlReader root = TomlReader::parse(
      {folder() / "c.toml", "titel = \"x\"\n[store]\nkeep = \"1 min\"\n[alarm]\n"});
  const std::string message = message_of<InputError>([&] { read_result_path(root); });
  for (const char* each :
       {"result: is missing", "result = \"study-results\"", "did you mean 'title'",
        "keep = \"5 years\"", "reading: is missing", "source: is missing"})
    EXPECT_THAT(message, HasSubstr(each));
}

// A token of the page may be in a file, as others.
TEST_F(Configs, HaveATokenInAFile) {
  write("page.token", "0123456789abcdef\n");
  const auto http = [&](const std::string& lines) {
    return read(good + ("[http]\n" + lines)).http;
  };
  EXPECT_EQ(http("token_file = \"page.token\"\n")->token, "0123456789abcdef");
  EXPECT_THAT(message_of<InputError>(
                  [&] { http("token_file = \"page.token\"\ntoken = \"0123456789abcdef\"\n"); }),
              HasSubstr("use one"));
  EXPECT_EQ(http("streams_of_client = 3\n")->limits.streams_of_client, 3U);
}

TEST_F(Configs, HaveAWebhook) {
  const auto webhook = [&](const std::string& lines) {
    return *read(good + ("[webhook]\n" + lines)).webhook;
  };
  const WebhookSettings whole =
      webhook("url = \"https://alarms.example:8443/in?site=2\"\nafter = \"5 min\"\n");
  EXPECT_EQ(whole.host, "alarms.example");
  EXPECT_EQ(whole.port, "8443");
  EXPECT_EQ(whole.target, "/in?site=2");
  EXPECT_TRUE(whole.tls);
  EXPECT_EQ(whole.lasting, std::chrono::minutes(5));
  const WebhookSettings plain = webhook("url = \"http://[::1]\"\n");
  EXPECT_EQ(plain.host, "::1");
  EXPECT_EQ(plain.port, "80");
  EXPECT_EQ(plain.target, "/");
  EXPECT_EQ(plain.lasting, std::chrono::minutes(1));
  write("token", "secret\n");
  EXPECT_EQ(webhook("url = \"http://127.0.0.1:1/\"\ntoken_file = \"token\"\n").token, "secret");
  const auto problem = [&](const std::string& lines) {
    return message_of<InputError>([&] { webhook(lines); });
  };
  EXPECT_THAT(problem("url = \"http://far.example/\"\ntoken_file = \"token\"\n"),
              HasSubstr("would be sent unencrypted"));
  EXPECT_THAT(problem("url = \"http://me:word@far.example/\"\n"), HasSubstr("use token_file"));
  EXPECT_THAT(problem("url = \"http://x/a b\"\n"), HasSubstr("percent-encoded"));
  EXPECT_THAT(problem("url = \"http://x:99999/\"\n"), HasSubstr("is not HOST:PORT"));
  EXPECT_THAT(problem("url = \"http://x/\"\nafter = \"8 d\"\n"), HasSubstr("between 0 s and 7 d"));
  EXPECT_THAT(problem("url = \"http://x/\"\nlater = 5\n"), HasSubstr("later"));
}

TEST_F(Configs, HaveTokensWithRoles) {
  const std::string own =
      "[http.tokens.gateway]\ntoken = \"0123456789abcdef\"\nroles = [\"write\"]\n";
  const HttpSettings http = *read(good + ("[http]\n" + own)).http;
  ASSERT_EQ(http.tokens.size(), 1U);
  EXPECT_EQ(http.tokens[0].name, "gateway");
  EXPECT_EQ(http.tokens[0].roles, role_write);
  EXPECT_TRUE(http.needs_token());
  const auto problem = [&](const std::string& lines) {
    return message_of<InputError>([&] { read(good + ("[http]\n" + lines)); });
  };
  EXPECT_THAT(problem("token = \"0123456789abcdef\"\n" + own),
              HasSubstr("is another one's token too"));
  EXPECT_THAT(problem("[http.tokens.a]\ntoken = \"0123456789abcdef\"\n"), HasSubstr("roles"));
  EXPECT_THAT(problem("[http.tokens.a]\ntoken = \"0123456789abcdef\"\nroles = \"admin\"\n"),
              HasSubstr("'admin' is not a role: read, write or operate"));
  EXPECT_THAT(problem("[http.tokens.a]\ntoken = \"short\"\nroles = \"read\"\n"),
              HasSubstr("has 5 characters"));
}

TEST_F(Configs, HaveFormsOfMessages) {
  const auto of = [&](const std::string& lines) {
    std::string text = good;
    const std::string from = "kind = \"stdin\"\n";
    text.replace(text.find(from), from.size(), from + lines);
    return text;
  };
  const MessageFormat influx =
      read(of("format = \"influx\"\nprecision = \"us\"\n")).sources[0].format;
  EXPECT_EQ(influx.form, Form::influx);
  EXPECT_EQ(influx.per_second, 1'000'000);
  EXPECT_EQ(read(of("format = \"opc ua\"\n")).sources[0].format.form, Form::opc_ua);
  EXPECT_THAT(message_of<InputError>([&] { read(of("format = \"influx\"\n")); }),
              HasSubstr("precision: is missing"));
  EXPECT_THAT(message_of<InputError>([&] { read(of("precision = \"s\"\n")); }),
              HasSubstr("is for format = \"influx\""));
  // Times of the lines themselves.
  std::string text = of("format = \"influx\"\nprecision = \"s\"\n");
  const std::string time = "time = \"t\"\ntime_format = \"iso 8601\"\n";
  text.replace(text.find(time), time.size(), "time = \"{timestamp}\"\ntime_format = \"unix ms\"\n");
  EXPECT_EQ(read(text).sources[0].mapping.time, "{timestamp}");
  const auto field = [&](const std::string& whole, const std::string& from, const std::string& to) {
    std::string changed = whole;
    changed.replace(changed.find(from), from.size(), to);
    return message_of<InputError>([&] { read(changed); });
  };
  EXPECT_THAT(field(text, "\"machine\"", "\"{writer}\""),
              HasSubstr("'{writer}' is not in messages of this form, which have {measurement}"));
  EXPECT_THAT(field(text, "\"w\"", "\"{value}\""), HasSubstr("'{value}' is not in messages"));
  EXPECT_THAT(field(good, "time = \"t\"\ntime_format = \"iso 8601\"", "sequence = \"{sequence}\""),
              HasSubstr("'{sequence}' is not in messages of this form"));
  EXPECT_THAT(field(good, "time = \"t\"\ntime_format = \"iso 8601\"", "sequence = \"{edge}\""),
              HasSubstr("'{edge}' is for Sparkplug B only"));
  const std::string form = "format = \"influx\"\nprecision = \"s\"\n";
  text.replace(text.find(form), form.size(), "");
  EXPECT_THAT(message_of<InputError>([&] { read(text); }), HasSubstr("{timestamp}"));
}

}  // namespace
}  // namespace wearwell::monitor
