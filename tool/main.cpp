#include <csignal>
#include <string>
#include <vector>

#include "tool/command_line.hpp"

int main(int argc, char** argv) {
  // Where the reader of a pipe goes away, a write fails instead of killing the process between two files.
  (void)std::signal(SIGPIPE, SIG_IGN);
  hysteron::tool::Console console;
  return hysteron::tool::run_command_line(std::vector<std::string>(argv + 1, argv + argc), console);
}
