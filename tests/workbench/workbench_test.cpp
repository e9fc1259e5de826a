#include "wearwell/workbench/routes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "monitor/http_client.h"
#include "support/run_command.h"
#include "support/scratch.h"
#include "wearwell/http/listener.h"
#include "wearwell/models/registry.h"
#include "wearwell/workbench/table_view.h"

// Longer than others: one fixture, a running server, for every route.
namespace wearwell::workbench {
namespace {

using monitor::HttpClient;
using monitor::HttpReply;
using nlohmann::json;
using testing::HasSubstr;

const std::string token = "0123456789abcdef0123456789abcdef";

std::string lives() {
  std::string text = "unit;running hours [h];status\n";
  const int hours[] = {212, 305, 371, 418, 466, 509, 540, 588, 633, 702, 749, 800, 800, 800, 800};
  for (int i = 0; i < 15; ++i)
    text += "P" + std::to_string(i + 1) + ";" + std::to_string(hours[i]) +
            (i < 11 ? ",5;failure\n" : ",0;running\n");
  return text;
}

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class WorkbenchTest : public ScratchTest {
 protected:
  WorkbenchTest() : session_(folder(), all_models()), routes_(session_, token) {
    session_.patience = std::chrono::minutes(5);
    HttpSettings settings;
    settings.port = 0;
    settings.limits.body_bytes = 1 << 20;
    listener_.emplace(settings, std::nullopt, routes_);
    routes_.set_port(listener_->port());
  }
  ~WorkbenchTest() override { listener_->stop(); }

  std::string host() const { return "127.0.0.1:" + std::to_string(listener_->port()); }
  std::string fields() const { return "Authorization: Bearer " + token + "\r\n"; }
  HttpReply send(const std::string& line, const std::string& of_host, const std::string& more,
                 const std::string& body = {}) const {
    HttpClient client(listener_->port());
    client.send(line + " HTTP/1.1\r\nHost: " + of_host + "\r\n" + more +
                (body.empty() ? "" : "Content-Length: " + std::to_string(body.size()) + "\r\n") +
                "\r\n" + body);
    return client.reply();
  }
  HttpReply get(const std::string& target) const { return send("GET " + target, host(), fields()); }
  HttpReply post(const std::string& target, const json& body) const {
    return send("POST " + target, host(), fields() + "Content-Type: application/json\r\n",
                body.dump());
  }
  json got(const std::string& target) const {
    const HttpReply reply = get(target);
    EXPECT_EQ(reply.status, 200) << target << reply.body;
    return json::parse(reply.body);
  }
  json done(const std::string& target, const json& body) const {
    const HttpReply reply = post(target, body);
    EXPECT_EQ(reply.status, 200) << target << reply.body;
    return json::parse(reply.body);
  }
  // What a request about the open table names.
  json named(json more = json::object()) const {
    const json session = got("/api/session");
    more["file"] = session["table"];
    more["number"] = session["table_number"];
    return more;
  }
  std::string named_query() const {
    const json session = got("/api/session");
    return "file=" + session["table"].get<std::string>() +
           "&number=" + session["table_number"].dump();
  }
  json fitted(const std::string& file, const std::string& text) const {
    done("/api/fit", {{"file", file}, {"text", text}});
    return ended_fit();
  }
  json ended_fit() const {
    for (int i = 0; i < 1200; ++i) {
      const json session = got("/api/session");
      if (session["fit"]["state"] != "running") return session["fit"];
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return {};
  }

  json ended_reading() const {
    for (int i = 0; i < 1200; ++i) {
      const json session = got("/api/session");
      if (session["reading"]["state"] != "running") return session;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return {};
  }

  Session session_;
  Routes routes_;
  std::optional<HttpListener> listener_;
};

TEST_F(WorkbenchTest, ThePageHoldsNoDataAndNeedsNoToken) {
  write("secret-name.csv", "a,b\n1,2\n");
  const HttpReply page = send("GET /", host(), "");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.body.find("secret-name"), std::string::npos);
  EXPECT_EQ(page.body.find(token), std::string::npos);
  EXPECT_THAT(page.field("Content-Security-Policy"), HasSubstr("default-src 'none'"));
  EXPECT_EQ(page.field("Content-Security-Policy").find("unsafe"), std::string::npos);
  EXPECT_EQ(page.field("X-Frame-Options"), "DENY");
  EXPECT_EQ(page.body.find("src=\"http"), std::string::npos);
}

std::string many_lives(int rows) {
  std::string text = "unit,hours [h],status\n";
  for (int i = 0; i < rows; ++i)
    text += "U" + std::to_string(i) + "," + std::to_string(100 + i % 997) + ".5,failure\n";
  return text;
}

TEST_F(WorkbenchTest, ATableIsReadWhileThePageGoesOn) {
  write("few.csv", many_lives(12));
  write("many.csv", many_lives(400'000));
  done("/api/open", {{"file", "few.csv"}});
  session_.patience = std::chrono::milliseconds(0);
  const json begun = done("/api/open", {{"file", "many.csv"}});
  EXPECT_EQ(begun["kind"], "reading");
  EXPECT_EQ(begun["lines"][0], "unit,hours [h],status");
  EXPECT_EQ(begun["lines"].size(), 20U);
  const json meanwhile = got("/api/session");
  EXPECT_EQ(meanwhile["table"], "few.csv");
  EXPECT_EQ(meanwhile["reading"]["state"], "running");
  EXPECT_EQ(got("/api/rows?from=0&count=3&" + named_query())["rows"].size(), 3U);
  done("/api/stop-reading", json::object());
  const json stopped = ended_reading();
  EXPECT_EQ(stopped["reading"]["state"], "stopped");
  EXPECT_EQ(stopped["table"], "few.csv");

  // Of two readings the later one stays, whichever ends first.
  done("/api/open", {{"file", "many.csv"}});
  const json later = done("/api/open", {{"file", "few.csv"}});
  EXPECT_EQ(ended_reading()["table"], "few.csv");
  EXPECT_EQ(got("/api/table")["number"], later["number"]);

  done("/api/open", {{"file", "many.csv"}});
  const json session = ended_reading();
  EXPECT_EQ(session["reading"]["state"], "done");
  EXPECT_EQ(session["reading"]["number"], session["table_number"]);
  const json table = got("/api/table");
  EXPECT_EQ(table["rows"], 400'000);
  EXPECT_EQ(table["columns"][1]["largest"], 1096.5);
}

TEST_F(WorkbenchTest, ATableThatCannotBeReadIsRefusedInTheBackground) {
  session_.patience = std::chrono::milliseconds(0);
  const auto uploaded = [&](const std::string& name, const std::string& body) {
    return send("POST /api/upload?file=" + name, host(), fields(), body).status;
  };
  EXPECT_EQ(uploaded("bad.csv", "a,b\n1,2\n3\n"), 200);
  json read = ended_reading()["reading"];
  EXPECT_EQ(read["state"], "failed");
  EXPECT_THAT(read["problem"].get<std::string>(), HasSubstr("bad.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "bad.csv"));
  // It is read once it is stated how.
  EXPECT_EQ(uploaded("good.csv&settings=%7B%22comment%22:%22%23%22%7D", "# 3\na,b\n1,2\n"), 200);
  read = ended_reading()["reading"];
  EXPECT_EQ(read["state"], "done");
  EXPECT_EQ(read["problem"], "");
  EXPECT_TRUE(std::filesystem::exists(folder() / "good.csv"));
}

TEST_F(WorkbenchTest, TheFormNeedsNoTable) {
  const std::string text = "model = \"lifetimes\"\n[data]\nfile = \"absent.csv\"\n";
  const json form = done("/api/form", {{"file", "a.toml"}, {"text", text}});
  EXPECT_EQ(form["keys"].size(), 2U);
  EXPECT_FALSE(form.contains("problem"));
  EXPECT_TRUE(done("/api/check", {{"file", "a.toml"}, {"text", text}}).contains("problem"));
  const json broken = done("/api/form", {{"file", "a.toml"}, {"text", text + "x = \n"}});
  EXPECT_EQ(broken["line"], 4);
}

TEST_F(WorkbenchTest, RefusesStrangers) {
  EXPECT_EQ(get("/api/session").status, 200);
  EXPECT_EQ(send("GET /api/session", host(), "").status, 401);
  EXPECT_EQ(send("GET /api/session", host(), "Authorization: Bearer 0123\r\n").status, 401);
  EXPECT_EQ(send("GET /api/session", host(), "Cookie: wearwell=" + token + "\r\n").status, 401);
  // Another name for this address, as DNS rebinding makes, and another port.
  for (const std::string& name : {std::string("evil.example"), "evil.example:" + host().substr(10),
                                  std::string("127.0.0.1"), std::string("127.0.0.1:1")})
    EXPECT_EQ(send("GET /api/session", name, fields()).status, 403) << name;
  for (const char* origin : {"http://evil.example", "http://127.0.0.1:1", "null"})
    EXPECT_EQ(send("GET /api/session", host(), fields() + "Origin: " + origin + "\r\n").status, 403)
        << origin;
  EXPECT_EQ(send("GET /api/session", host(), fields() + "Origin: http://" + host() + "\r\n").status,
            200);
  EXPECT_EQ(send("GET /api/session", host(), fields() + "Sec-Fetch-Site: cross-site\r\n").status,
            403);
  EXPECT_EQ(send("GET /api/session", host(), fields() + "Sec-Fetch-Site: same-site\r\n").status,
            403);
  // A form of another site can send no JSON.
  EXPECT_EQ(send("POST /api/stop", host(), fields() + "Content-Type: text/plain\r\n", "{}").status,
            415);
  EXPECT_EQ(get("/api/session").field("Access-Control-Allow-Origin"), "");
}

TEST_F(WorkbenchTest, RefusesHostileRequests) {
  write("ok.csv", "a,b\n1,2\n");
  std::filesystem::create_symlink("/etc/hostname", folder() / "leak.csv");
  for (const char* name : {"../x.csv", "/etc/passwd", "..", ".", "", ".hidden.csv", "a/b.csv",
                           "leak.csv", "no.csv", "a\nb.csv", "a\u202eb.csv"})
    EXPECT_EQ(post("/api/open", {{"file", name}}).status, 400) << name;
  EXPECT_EQ(post("/api/open", {{"file", std::string(5000, 'a')}}).status, 400);
  EXPECT_EQ(post("/api/open", {{"file", 7}}).status, 400);
  EXPECT_EQ(post("/api/open", json::array()).status, 400);
  EXPECT_EQ(post("/api/save", {{"file", "../x.toml"}, {"text", "a"}}).status, 400);
  EXPECT_EQ(post("/api/save", {{"file", "x.sh"}, {"text", "a"}}).status, 400);
  EXPECT_EQ(post("/api/save", {{"file", "leak.csv"}, {"text", "a"}}).status, 400);
  EXPECT_EQ(send("POST /api/upload?file=..%2Fx.csv", host(), fields(), "a\n1\n").status, 400);
  EXPECT_EQ(send("POST /api/upload?file=x.sh", host(), fields(), "a\n1\n").status, 400);
  EXPECT_FALSE(std::filesystem::exists(folder() / "x.sh"));
  EXPECT_EQ(send("POST /api/upload?file=x.csv", host(), fields(), std::string(2 << 20, 'x')).status,
            413);
  EXPECT_FALSE(std::filesystem::exists(folder() / "x.csv"));
  EXPECT_EQ(send("POST /api/open", host(), fields() + "Content-Type: application/json\r\n",
                 std::string(60000, '['))
                .status,
            400);
  EXPECT_EQ(post("/api/table", {{"settings", {{"sql", "select 1"}}}}).status, 400);
  EXPECT_EQ(get("/api/rows?from=1").status, 400);
  EXPECT_EQ(get("/api/nothing").status, 404);
  EXPECT_EQ(get("/report/0123").status, 404);
  EXPECT_EQ(send("DELETE /api/session", host(), fields()).status, 405);
  EXPECT_EQ(get("/api/fit").status, 405);
  EXPECT_EQ(post("/api/open", {{"file", "ok.csv"}}).status, 200);
  EXPECT_EQ(post("/api/table", named({{"settings", {{"sql", "from read_text('/etc/hostname')"}}}}))
                .status,
            400);
  EXPECT_EQ(
      post("/api/table", named({{"settings", {{"header_row", "1\nsql = 'select 1'"}}}})).status,
      400);
  EXPECT_EQ(get("/api/rows?from=-1&" + named_query()).status, 400);
  EXPECT_EQ(get("/api/plot?x=0&y=9&" + named_query()).status, 400);
}

TEST_F(WorkbenchTest, ShowsATableAsItWasRead) {
  write("odd.csv",
        "name,wear [um],n\n<img src=x onerror=alert(1)>,1.5,10\nb,bad,20\nc,n/a,30\nd,4,40\n");
  const json table = done("/api/open", {{"file", "odd.csv"}})["table"];
  EXPECT_EQ(table["rows"], 4);
  ASSERT_EQ(table["columns"].size(), 3u);
  EXPECT_EQ(table["columns"][1]["unit"], "um");
  EXPECT_EQ(table["columns"][1]["kind"], "text");
  EXPECT_EQ(table["columns"][1]["refused"], 1);
  EXPECT_EQ(table["columns"][1]["empty"], 1);
  EXPECT_EQ(table["columns"][2]["kind"], "number");
  EXPECT_EQ(table["columns"][2]["largest"], 40);
  const json rows = got("/api/rows?from=1&count=2&" + named_query())["rows"];
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0]["row"], 2);
  EXPECT_EQ(rows[0]["cells"][1], "bad");
  EXPECT_EQ(rows[0]["refused"]["1"], "'bad' is not a number");
  EXPECT_FALSE(rows[1].contains("refused"));
  const json plot = got("/api/plot?x=2&y=1&log_x=1&" + named_query());
  EXPECT_EQ(plot["points"], json::parse("[[10,1.5,1],[40,4,4]]"));
  EXPECT_EQ(plot["left_out"]["empty"], 2);
}

// The table that is shown is the one that was read; a study reads the file.
TEST_F(WorkbenchTest, SaysThatTheFileOfTheTableHasChanged) {
  write("lives.csv", "hours [h],status\n100,failure\n200,running\n");
  static_cast<void>(done("/api/open", {{"file", "lives.csv"}}));
  const auto is_changed = [&] {
    return done("/api/check", {{"file", "l.toml"}, {"text", "model = 1"}})["table_changed"];
  };
  EXPECT_EQ(is_changed(), false);
  write("lives.csv", "hours [h],status\n100,failure\n200,running\n300,failure\n");
  EXPECT_EQ(is_changed(), true);
  EXPECT_EQ(got("/api/session")["table_changed"], true);
  static_cast<void>(done("/api/open", {{"file", "lives.csv"}}));
  EXPECT_EQ(is_changed(), false);
  std::filesystem::remove(folder() / "lives.csv");
  EXPECT_EQ(is_changed(), true);
}

// A plot of many rows stays a picture, and keeps their range.
TEST_F(WorkbenchTest, ThinsAPlotOfManyRows) {
  std::string text = "x,y\n";
  for (int i = 0; i < 60000; ++i)
    text += std::to_string(i) + "," + std::to_string((i * 7919) % 1000) + "\n";
  write("many.csv", text);
  done("/api/open", {{"file", "many.csv"}});
  const json plot = got("/api/plot?x=0&y=1&" + named_query());
  EXPECT_EQ(plot["kept"], 60000);
  EXPECT_LE(plot["points"].size(), 161u * 91u);
  EXPECT_GT(plot["points"].size(), 5000u);
  EXPECT_EQ(plot["points"][0][0], 0);
  EXPECT_EQ(plot["points"].back()[0].get<int>() > 59000, true);
}

TEST_F(WorkbenchTest, FromATableToALifeAndTheProgramAgreesToTheLastDigit) {
  const HttpReply uploaded = send("POST /api/upload?file=pumps.csv", host(), fields(), lives());
  ASSERT_EQ(uploaded.status, 200) << uploaded.body;
  EXPECT_EQ(content(folder() / "pumps.csv"), lives());
  // the same again is no conflict, other content is
  EXPECT_EQ(send("POST /api/upload?file=pumps.csv", host(), fields(), lives()).status, 200);
  EXPECT_EQ(send("POST /api/upload?file=pumps.csv", host(), fields(), "a\n1\n").status, 409);

  const json readings = done("/api/guess", named())["readings"];
  const std::string text = readings[0]["text"];
  EXPECT_EQ(readings[0]["questions"].size(), 0u) << readings[0]["questions"];
  const json checked = done("/api/check", {{"file", "pumps.toml"}, {"text", text}});
  ASSERT_FALSE(checked.contains("problem")) << checked["problem"];
  const std::string changed = done(
      "/api/set", {{"text", text}, {"path", "predict.credible_level"}, {"value", "0.95"}})["text"];
  EXPECT_THAT(changed, HasSubstr("0.95"));

  done("/api/save", {{"file", "pumps.toml"}, {"text", changed}, {"before", nullptr}});
  EXPECT_EQ(content(folder() / "pumps.toml"), changed);
  // another page that read the earlier text does not overwrite this one
  EXPECT_EQ(post("/api/save", {{"file", "pumps.toml"}, {"text", text}, {"before", text}}).status,
            409);
  EXPECT_EQ(post("/api/save", {{"file", "pumps.toml"}, {"text", text}, {"before", nullptr}}).status,
            409);

  // a text that is not the file's is not fitted
  EXPECT_EQ(post("/api/fit", {{"file", "pumps.toml"}, {"text", text}}).status, 409);
  EXPECT_EQ(post("/api/fit", {{"file", "pumps.toml"}}).status, 400);
  const json fit = fitted("pumps.toml", changed);
  ASSERT_EQ(fit["state"], "done") << fit;
  EXPECT_EQ(fit["run"], 1);
  EXPECT_EQ(fit["written"], 1);
  const json result = got("/api/result");
  EXPECT_GT(result["checks"].size(), 3u);
  EXPECT_GT(result["tables"].size(), 2u);

  const std::filesystem::path other = folder() / "by-program";
  const CommandResult program =
      run_command(std::string(WEARWELL_BINARY) + " fit " + (folder() / "pumps.toml").string() +
                  " --quiet -o " + other.string());
  ASSERT_LE(program.exit_code, 1) << program.err;
  // The report also has the time that the run took.
  for (const char* file : {"summary.json", "state.bin", "study.toml", "tables/bounds.csv"})
    EXPECT_EQ(content(folder() / "pumps-results" / file), content(other / file)) << file;

  const json life =
      done("/api/life",
           {{"survived", "400 h"}, {"horizon", "100 h"}, {"level", "95 %"}, {"sides", "lower"}});
  const CommandResult asked =
      run_command("cd " + folder().string() +
                  " && PATH=" + std::filesystem::path(WEARWELL_BINARY).parent_path().string() +
                  ":$PATH " + life["command"].get<std::string>());
  EXPECT_EQ(life["text"], asked.out) << life["command"];
  const HttpReply wrong = post("/api/life", {{"survived", "400 mm"}});
  EXPECT_EQ(wrong.status, 400);
  EXPECT_EQ(wrong.body.find("--survived"), std::string::npos) << wrong.body;
  EXPECT_THAT(wrong.body, HasSubstr("survived"));

  // The report is reached under its own address, without a token, in a sandbox.
  const HttpReply report =
      send("GET " + got("/api/session")["report"].get<std::string>(), host(), "");
  EXPECT_EQ(report.status, 200);
  EXPECT_EQ(report.body, content(folder() / "pumps-results" / "report.html"));
  EXPECT_THAT(report.field("Content-Security-Policy"), HasSubstr("sandbox allow-scripts"));
  EXPECT_EQ(report.field("Content-Security-Policy").find("allow-same-origin"), std::string::npos);
}

TEST_F(WorkbenchTest, ResultsAreComparedAndDecideAsTheProgramDoes) {
  write("pumps.csv", lives());
  done("/api/open", {{"file", "pumps.csv"}});
  const std::string weibull = done("/api/guess", named())["readings"][0]["text"];
  std::string gamma = weibull;
  const std::string family = "family = \"weibull\"";
  ASSERT_NE(gamma.find(family), std::string::npos);
  gamma.replace(gamma.find(family), family.size(), "family = \"gamma\"");
  for (const auto& [name, text] :
       {std::pair("gamma.toml", gamma), std::pair("wei.toml", weibull)}) {
    done("/api/save", {{"file", name}, {"text", text}, {"before", nullptr}});
    ASSERT_EQ(fitted(name, text)["state"], "done");
  }
  const std::string with_program =
      " && PATH=" + std::filesystem::path(WEARWELL_BINARY).parent_path().string() + ":$PATH ";
  const auto printed = [&](std::string command) {
    const std::string in = "cd " + folder().string();
    if (command.starts_with("cd ")) command = command.substr(command.find("&& ") + 3);
    return run_command(in + with_program + command).out;
  };

  const json names = {"wei-results", "gamma-results"};
  const std::string page = got("/api/session")["comparison"];
  EXPECT_EQ(send("GET " + page, host(), "").status, 404);
  const json compared = done("/api/compare", {{"results", names}});
  EXPECT_EQ(compared["text"], printed(compared["command"])) << compared["command"];
  EXPECT_TRUE(compared["answer"]["comparable"]);
  EXPECT_EQ(compared["answer"]["studies"].size(), 2u);
  const HttpReply overlaid = send("GET " + page, host(), "");
  EXPECT_EQ(overlaid.status, 200);
  EXPECT_THAT(overlaid.body, HasSubstr("gamma-results"));
  EXPECT_THAT(overlaid.field("Content-Security-Policy"), HasSubstr("sandbox allow-scripts"));
  for (const json& wrong :
       {json::array(), json{"wei-results"}, json{"wei-results", "wei-results"},
        json{"wei-results", "../wei-results"}, json{"wei-results", "none"}, json{"wei-results", 1}})
    EXPECT_EQ(post("/api/compare", {{"results", wrong}}).status, 400) << wrong;

  const json decided =
      done("/api/decide",
           {{"failure_cost", "800 EUR"}, {"replacement_cost", "120 EUR"}, {"claims", "2 %"}});
  EXPECT_EQ(decided["text"], printed(decided["command"])) << decided["command"];
  EXPECT_EQ(decided["answer"]["currency"], "EUR");
  const std::vector<double> cost = decided["curve"]["cost"];
  EXPECT_NEAR(*std::min_element(cost.begin(), cost.end()), decided["answer"]["age"]["cost"],
              0.01 * decided["answer"]["age"]["cost"].get<double>());
  const HttpReply missing = post("/api/decide", {{"failure_cost", "800 EUR"}});
  EXPECT_EQ(missing.status, 400);
  EXPECT_THAT(missing.body, HasSubstr("replacement cost: "));
}

// A Weibull life of shape 1 and a lognormal scale: B10 and the median are fixed multiples of the scale.
TEST_F(WorkbenchTest, ShowsWhatThePriorsImplyBeforeAnyData) {
  write("pumps.csv", lives());
  done("/api/open", {{"file", "pumps.csv"}});
  std::string text = done("/api/guess", named())["readings"][0]["text"];
  const auto put = [&](const std::string& key, const std::string& line) {
    const std::size_t at = text.find("\n" + key + " = {") + 1;
    ASSERT_NE(at, 0u);
    text.replace(at, text.find('\n', at) - at, line);
  };
  put("characteristic",
      "characteristic = { distribution = \"lognormal\", median = \"1000 h\", log_sd = 0.5 }");
  put("slope", "slope = { distribution = \"uniform\", lower = 0.999999, upper = 1.000001 }");
  const json found = done("/api/priors", {{"file", "p.toml"}, {"text", text}});
  ASSERT_EQ(found["priors"].size(), 2u) << found;
  EXPECT_NEAR(found["priors"][0]["q50"], 1000, 1e-6);
  EXPECT_NEAR(found["priors"][0]["q95"], 1000 * std::exp(0.5 * 1.6448536), 1e-2);
  const auto b10 = std::find_if(
      found["quantities"].begin(), found["quantities"].end(),
      [](const json& each) { return each["name"].get<std::string>().starts_with("B10"); });
  ASSERT_NE(b10, found["quantities"].end()) << found;
  const double share = -std::log(0.9);
  EXPECT_NEAR((*b10)["q50"], 1000 * share, 2);
  EXPECT_NEAR((*b10)["q05"], 1000 * share * std::exp(-0.5 * 1.6448536), 1);
  EXPECT_NEAR((*b10)["q95"], 1000 * share * std::exp(0.5 * 1.6448536), 4);

  // A handle that is moved changes the text; the same view follows from it.
  const json& scale = found["priors"][0];
  ASSERT_EQ(scale["handles"].size(), 2u) << scale;
  const json moved = done("/api/prior", {{"text", text},
                                         {"specification", scale["specification"]},
                                         {"meaning", scale["meaning"]},
                                         {"handle", "location"},
                                         {"at", 1500.4}});
  EXPECT_EQ(moved["values"],
            (json::parse(R"([{"path": "prior.characteristic.median", "value": "1500 h"}])")));
  EXPECT_EQ(done("/api/priors", {{"file", "p.toml"}, {"text", moved["text"]}})["priors"][0],
            moved["prior"]);
  EXPECT_EQ(post("/api/prior", {{"text", text}, {"handle", "location"}, {"at", 1}}).status, 400);

  put("slope", "slope = { distribution = \"flat\" }");
  const json improper = done("/api/priors", {{"file", "p.toml"}, {"text", text}});
  EXPECT_TRUE(improper["quantities"].empty());
  EXPECT_THAT(improper["obstacle"].get<std::string>(), HasSubstr("slope"));
  EXPECT_EQ(post("/api/priors", {{"text", "model = 1"}}).status, 400);
}

TEST_F(WorkbenchTest, FamiliesStandSideBySide) {
  write("pumps.csv", lives());
  done("/api/open", {{"file", "pumps.csv"}});
  const std::string text = done("/api/guess", named())["readings"][0]["text"];
  const json found = done("/api/families", {{"file", "p.toml"}, {"text", text}});
  EXPECT_EQ(found["family"], "weibull");
  EXPECT_EQ(found["unit"], "h");
  EXPECT_EQ(found["lives"], 15);
  EXPECT_EQ(found["failures"], 11);
  ASSERT_EQ(found["families"].size(), 9u);
  double before = -INFINITY;
  for (const json& each : found["families"]) {
    const json checked = done("/api/check", {{"file", "p.toml"}, {"text", each["text"]}});
    EXPECT_FALSE(checked.contains("problem")) << checked;
    EXPECT_EQ(each["points"].size(), 11u);
    // A third parameter may leave the likelihood without a maximum.
    ASSERT_NE(each.contains("aic"), each.contains("problem")) << each;
    if (!each.contains("aic")) continue;
    EXPECT_GE(each["aic"].get<double>(), before);
    before = each["aic"];
    const double parameters = static_cast<double>(each["parameters"].size());
    EXPECT_NEAR(each["aic"], 2 * parameters - 2 * each["log_likelihood"].get<double>(), 1e-9);
    if (each["name"] == "weibull") {
      EXPECT_EQ(each["text"], text);
    }
  }
  // In hours: the density of a life in seconds is 3600 times smaller.
  const auto weibull = std::find_if(found["families"].begin(), found["families"].end(),
                                    [](const json& each) { return each["name"] == "weibull"; });
  const double scale = (*weibull)["parameters"][0]["value"],
               shape = (*weibull)["parameters"][1]["value"];
  double log_likelihood = 0;
  for (const double x :
       {212.5, 305.5, 371.5, 418.5, 466.5, 509.5, 540.5, 588.5, 633.5, 702.5, 749.5})
    log_likelihood +=
        std::log(shape / scale) + (shape - 1) * std::log(x / scale) - std::pow(x / scale, shape);
  log_likelihood -= 4 * std::pow(800 / scale, shape);
  EXPECT_NEAR((*weibull)["log_likelihood"], log_likelihood, 1e-6);

  write("two.csv", "hours [h],temperature [degC]\n100,20\n200,20\n300,40\n400,40\n");
  const std::string conditions =
      "model = \"formula\"\n[data]\nfile = \"two.csv\"\n[data.columns]\nlife = { column = "
      "\"hours\", unit = "
      "\"h\" }\ntemperature = { column = \"temperature\", unit = \"degC\" "
      "}\n[likelihood.life]\nfamily = "
      "\"weibull\"\nscale = \"a * temperature / 300 [K]\"\nshape = 2\n[prior]\na = { distribution "
      "= "
      "\"lognormal\", median = \"100 h\", log_sd = 1 }\n";
  const HttpReply refused = post("/api/families", {{"file", "c.toml"}, {"text", conditions}});
  EXPECT_EQ(refused.status, 400) << refused.body;
  EXPECT_THAT(refused.body, HasSubstr("conditions"));
}

TEST_F(WorkbenchTest, ColoursPointsByALabelAndMarksRunOuts) {
  std::string text = "stress,cycles,status,batch\n";
  for (int i = 0; i < 40; ++i)
    text += std::to_string(300 + i) + "," + std::to_string(100000 - 100 * i) +
            (i % 4 ? ",failure," : ",running,") + std::to_string(i % 10) + "\n";
  write("sn.csv", text);
  done("/api/open", {{"file", "sn.csv"}});
  const json plain = got("/api/plot?" + named_query() + "&x=0&y=1");
  EXPECT_EQ(plain["points"][0].size(), 3u);
  EXPECT_TRUE(plain["labels"].empty());
  const json status = got("/api/plot?" + named_query() + "&x=0&y=1&by=2");
  EXPECT_EQ(status["labels"], (json::parse(R"([{"text":"failure","runout":false},
                                               {"text":"running","runout":true}])")));
  for (const json& each : status["points"])
    EXPECT_EQ(each[3], (each[2].get<int>() - 1) % 4 ? 0 : 1);
  // Two of ten labels share the index behind the eight.
  const json batch = got("/api/plot?" + named_query() + "&x=0&y=1&by=3");
  EXPECT_EQ(batch["labels"].size(), 8u);
  EXPECT_EQ(std::count_if(batch["points"].begin(), batch["points"].end(),
                          [](const json& each) { return each[3] == 8; }),
            8);
  EXPECT_EQ(get("/api/plot?" + named_query() + "&x=0&y=1&by=9").status, 400);
}

TEST_F(WorkbenchTest, AFitStopsAndWritesNothing) {
  write("pumps.csv", lives());
  done("/api/open", {{"file", "pumps.csv"}});
  std::string text = done("/api/guess", named())["readings"][0]["text"];
  text += "\n[sampler]\ndraws = 1000000\n";
  done("/api/save", {{"file", "pumps.toml"}, {"text", text}, {"before", nullptr}});
  done("/api/fit", {{"file", "pumps.toml"}, {"text", text}});
  // one at a time
  EXPECT_EQ(post("/api/fit", {{"file", "pumps.toml"}, {"text", text}}).status, 400);
  done("/api/stop", json::object());
  EXPECT_EQ(ended_fit()["state"], "stopped");
  EXPECT_FALSE(std::filesystem::exists(folder() / "pumps-results"));
}

TEST_F(WorkbenchTest, AFitThatFailsSaysWhy) {
  write("bad.toml", "model = \"formula\"\n");
  const json fit = fitted("bad.toml", "model = \"formula\"\n");
  EXPECT_EQ(fit["state"], "failed");
  EXPECT_THAT(fit["problem"].get<std::string>(), HasSubstr("bad.toml"));
  EXPECT_EQ(post("/api/fit", {{"file", "no.toml"}, {"text", ""}}).status, 400);
}

// Two pages: a request of the one never gets the table of the other.
TEST_F(WorkbenchTest, ARequestIsForTheTableThatItNames) {
  write("a.csv", "a,b\n1,2\n3,4\n");
  write("lives.csv", lives());
  const json a = done("/api/open", {{"file", "a.csv"}})["table"];
  const std::string of_a = named_query();
  EXPECT_EQ(got("/api/rows?" + of_a)["rows"].size(), 2u);
  const json second = done("/api/open", {{"file", "lives.csv"}})["table"];
  EXPECT_NE(a["number"], second["number"]);
  const json names_a = {{"file", "a.csv"}, {"number", a["number"]}};
  for (const char* path : {"/api/rows?", "/api/plot?x=0&y=1&"})
    EXPECT_EQ(get(path + of_a).status, 409) << path;
  for (const char* path : {"/api/guess", "/api/table"})
    EXPECT_EQ(post(path, names_a).status, 409) << path;
  EXPECT_EQ(got("/api/rows?" + named_query())["rows"].size(), 15u);
  // the same file with other settings is another table
  const std::string before = named_query();
  done("/api/table", named({{"settings", {{"decimal", ","}}}}));
  EXPECT_EQ(get("/api/rows?" + before).status, 409);
  EXPECT_EQ(got("/api/table")["settings"]["decimal"], ",");
}

// With the method exact a run has no step, so its seconds stay 0: its number tells the runs apart.
TEST_F(WorkbenchTest, EachRunHasItsNumber) {
  write("pumps.csv", lives());
  done("/api/open", {{"file", "pumps.csv"}});
  const std::string text = done("/api/guess", named())["readings"][0]["text"];
  done("/api/save", {{"file", "pumps.toml"}, {"text", text}, {"before", nullptr}});
  EXPECT_EQ(fitted("pumps.toml", text)["written"], 1);
  std::string other = text;
  other.replace(other.find("credible_level = 0.9"), 20, "credible_level = 0.8");
  done("/api/save", {{"file", "pumps.toml"}, {"text", other}, {"before", text}});
  const json second = fitted("pumps.toml", other);
  EXPECT_EQ(second["run"], 2);
  EXPECT_EQ(second["written"], 2);
  // a run that fails leaves the result of the second
  write("bad.toml", "model = \"formula\"\n");
  const json third = fitted("bad.toml", "model = \"formula\"\n");
  EXPECT_EQ(third["run"], 3);
  EXPECT_EQ(third["written"], 2);
}

TEST_F(WorkbenchTest, AStudyKeepsItsLineEndsAndItsLink) {
  write("real.TOML", "model = \"formula\"\r\ntitle = \"a\"\r\n");
  std::filesystem::create_symlink("real.TOML", folder() / "link.toml");
  const std::string page = "model = \"formula\"\ntitle = \"a\"\n";
  const std::string next = "model = \"formula\"\ntitle = \"b\"\n";
  done("/api/save", {{"file", "link.toml"}, {"text", next}, {"before", page}});
  EXPECT_TRUE(std::filesystem::is_symlink(folder() / "link.toml"));
  EXPECT_EQ(content(folder() / "real.TOML"), "model = \"formula\"\r\ntitle = \"b\"\r\n");
  done("/api/save", {{"file", "real.TOML"}, {"text", page}, {"before", next}});
  EXPECT_EQ(post("/api/save", {{"file", "real.TOML"}, {"text", next}, {"before", next}}).status,
            409);
}

TEST_F(WorkbenchTest, OfTwoSavesFromOneTextOneWins) {
  const std::string before = "model = \"formula\"\n";
  for (int round = 0; round < 20; ++round) {
    write("s.toml", before);
    unsigned status[2] = {};
    const auto save = [&](int i) {
      status[i] = post("/api/save", {{"file", "s.toml"},
                                     {"text", before + "title = \"" + std::to_string(i) + "\"\n"},
                                     {"before", before}})
                      .status;
    };
    std::thread first(save, 0), second(save, 1);
    first.join();
    second.join();
    EXPECT_EQ(status[0] + status[1], 200u + 409u) << round;
    EXPECT_EQ(content(folder() / "s.toml"),
              before + "title = \"" + (status[0] == 200 ? "0" : "1") + "\"\n");
  }
}

TEST_F(WorkbenchTest, AnUploadThatCannotBeReadIsRemoved) {
  const std::string broken(2000, '\0');
  const auto upload = [&](const std::string& bytes) {
    return send("POST /api/upload?file=x.parquet", host(), fields(), bytes).status;
  };
  EXPECT_EQ(upload(broken), 400);
  EXPECT_FALSE(std::filesystem::exists(folder() / "x.parquet"));
  // one that was there stays
  write("x.parquet", broken);
  EXPECT_EQ(upload(broken), 400);
  EXPECT_EQ(content(folder() / "x.parquet"), broken);
}

TEST(TableView, InfiniteNumbersAreNotEmptyCells) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  OpenTable open{"x.csv"};
  open.table.rows = 4;
  Column column;
  column.name = "a";
  column.is_number = true;
  column.numbers = {infinite, -infinite, std::numeric_limits<double>::quiet_NaN(), 12345678901234};
  open.table.columns.push_back(column);
  const json rows = rows_json(open, 0, 4, 0, 1)["rows"];
  EXPECT_EQ(rows[0]["cells"][0], "inf");
  EXPECT_EQ(rows[1]["cells"][0], "-inf");
  EXPECT_EQ(rows[2]["cells"][0], nullptr);
  EXPECT_EQ(rows[3]["cells"][0], 12345678901234);
}

// Chosen roles name the headings of a wide table's file, as --column does.
TEST_F(WorkbenchTest, AWideTableHasTheHeadingsOfItsFileForRoles) {
  write("wide.csv", "Hours [h],P1 [um],P2 [um],P3 [um]\n100,1,2,3\n200,2,4,5\n300,3,6,8\n");
  const json table = done("/api/open", {{"file", "wide.csv"}})["table"];
  ASSERT_TRUE(table.contains("wide")) << table;
  EXPECT_EQ(table["headings"].size(), 4u);
  EXPECT_EQ(table["rows"], 9);
  const json first = done("/api/guess", named())["readings"][0];
  EXPECT_THAT(first["text"].get<std::string>(), HasSubstr("sql"));
  const json chosen = done(
      "/api/guess", named({{"columns", {"depth=P2 [um]", "unused=P1 [um]", "unused=P3 [um]"}}}));
  const std::string text = chosen["readings"][0]["text"];
  EXPECT_EQ(text.find("sql"), text.npos) << text;
  EXPECT_THAT(text, HasSubstr("P2"));
}

TEST_F(WorkbenchTest, EventsShowEachChange) {
  write("a.csv", "a,b\n1,2\n3,4\n");
  HttpClient client(listener_->port());
  client.send("GET /api/events HTTP/1.1\r\nHost: " + host() + "\r\n" + fields() + "\r\n");
  EXPECT_THAT(client.until("event: session\n"), HasSubstr("200 OK"));
  done("/api/open", {{"file", "a.csv"}});
  for (int i = 0; i < 5; ++i) {
    if (client.until("\n\n").find("\"table\":\"a.csv\"") != std::string::npos) return;
  }
  FAIL() << "no event named the table";
}

}  // namespace
}  // namespace wearwell::workbench
