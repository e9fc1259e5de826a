#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace wearwell {

struct CommandResult {
  int exit_code = -1;
  std::string out;  ///< standard output
  std::string err;  ///< standard error
};

/// Runs a line of shell, "true && echo done".
inline CommandResult run_command(const std::string& line) {
  char name[] = "/tmp/wearwell-test-XXXXXX";
  const int descriptor = mkstemp(name);
  if (descriptor < 0) throw std::runtime_error("cannot make a temporary file");
  close(descriptor);
  FILE* pipe = popen(("{ " + line + "\n} 2>" + name).c_str(), "r");
  if (!pipe) throw std::runtime_error("cannot run a shell");
  CommandResult result;
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) result.out.append(buffer, n);
  const int status = pclose(pipe);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  std::ifstream err(name);
  std::stringstream text;
  text << err.rdbuf();
  result.err = text.str();
  std::remove(name);
  return result;
}

/// Runs the real program with arguments as a shell would read them: "bearing rate --radius '20
/// mm'".
inline CommandResult run_wearwell(const std::string& arguments) {
  return run_command("'" WEARWELL_BINARY "' " + arguments);
}

}  // namespace wearwell
