#include "tool/console.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "support/errors.hpp"
#include "support/progress.hpp"
#include "support/utf8.hpp"
#include "support/wrapped.hpp"
#include "tool/commands.hpp"

namespace hysteron::tool {

void Console::speak(const Speech& speech) {
  quiet_ = speech.quiet;
  results_ = speech.results;
  if (quiet_) {
    Progress::silence();
  }
}

void Console::print(std::string_view all) {
  if (results_ == Results::Report && quiet_) {
    return;
  }
  const std::string text = results_ == Results::Product ? std::string(all) : wrapped(all, terminal_width(stdout));
  if (write_error_ == 0 && std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) {
    write_error_ = errno;
  }
}

void Console::note(std::string_view file, std::string_view text) {
  if (quiet_) {
    return;
  }
  (void)std::fflush(stdout);
  const auto line = wrapped(fmt::format("note: {}: {}\n", printable(file), printable(text)), terminal_width(stderr));
  (void)std::fwrite(line.data(), 1, line.size(), stderr);
}

void Console::report(const Diagnostics& diagnostics) {
  if (!diagnostics.all().empty()) {
    (void)std::fflush(stdout);
    const auto text = wrapped(as_text(diagnostics, sources_, {.colour = wants_colour(stderr)}), terminal_width(stderr));
    (void)std::fwrite(text.data(), 1, text.size(), stderr);
  }
}

void Console::print(const Diagnostics& diagnostics) {
  print(as_text(diagnostics, sources_, {.colour = colour()}));
}

int Console::finish(int exit_code) {
  if (std::fflush(stdout) != 0 && write_error_ == 0) {
    write_error_ = errno;
  }
  if (write_error_ == 0 || write_error_ == EPIPE) {
    return exit_code;
  }
  Diagnostics diagnostics;
  diagnostics.error(error::unwritable_file, {},
                    fmt::format("The results cannot be written: {}.", std::strerror(write_error_)),
                    "make room on the disk, or send the results elsewhere.");
  report(diagnostics);
  return exit_bad_input;
}

}  // namespace hysteron::tool
