#include <string>
#include <vector>

#include "support/failed_writes.hpp"
#include "tool/command_line.hpp"

int main(int argc, char** argv) {
  hysteron::let_writes_fail();
  hysteron::tool::Console console;
  return hysteron::tool::run_command_line(std::vector<std::string>(argv + 1, argv + argc), console);
}
