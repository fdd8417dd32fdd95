// A folder in which the tool is run as a user runs it: by a shell, with files by their plain names.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tests/support/exit_code.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::test {

struct Outcome {
  int code = -1;  ///< 128 and the signal's number where it was killed
  std::string out{};
  std::string err{};
};

class Workbench {
 public:
  std::string write(std::string_view name, std::string_view text) const {
    std::filesystem::create_directories((work_.path() / name).parent_path());
    return work_.write(name, text);
  }
  [[nodiscard]] std::string read(std::string_view name) const { return contents_of(work_.path() / name); }
  [[nodiscard]] bool has(std::string_view name) const { return std::filesystem::exists(work_.path() / name); }
  [[nodiscard]] std::set<std::string> names() const { return work_.names(); }
  [[nodiscard]] const std::filesystem::path& path() const { return work_.path(); }

  /// Runs a line of the shell in the folder; `hysteron` is the tool under test.
  [[nodiscard]] Outcome shell(const std::string& line) const {
    const auto out = streams_ / "out";
    const auto err = streams_ / "err";
    const auto bin = std::filesystem::path(HYSTERON_TOOL).parent_path().string();
    const std::string command = "cd '" + work_.path().string() + "' && export PATH='" + bin + "':\"$PATH\" TMPDIR='" +
                                shared_temporary() + "' && ( " + line + " ) > '" + out + "' 2> '" + err + "'";
    const int status = std::system(command.c_str());
    if (status == -1) {
      throw std::runtime_error("no shell");
    }
    return {.code = exit_code(status), .out = contents_of(out), .err = contents_of(err)};
  }

 private:
  /// Compiled programs are kept from one test to the next, but not among those of the user.
  static const std::string& shared_temporary() {
    static const std::string folder = [] {
      const auto path = std::filesystem::temp_directory_path() / "hysteron-tool-tests";
      std::filesystem::create_directories(path);
      return path.string();
    }();
    return folder;
  }

  ScratchFolder work_;
  ScratchFolder streams_;
};

/// A gain with a range, a unit, a reset and a default.
inline constexpr std::string_view plant = R"(FUNCTION_BLOCK PLANT  (* @ts 1ms *)
  VAR_INPUT
    X     : LREAL;          (* @unit V @min -10 @max 10 *)
    RESET : BOOL := FALSE;
  END_VAR
  VAR_OUTPUT
    Y    : LREAL;  (* @unit V*s *)
    BUSY : BOOL;
  END_VAR
  VAR
    AMP : HY_GAIN := (K := 2.0);
    SUM : HY_INTEGRAL;
  END_VAR

  AMP(XIN := X);
  SUM(XIN := AMP.XOUT, R1 := RESET);
  Y := SUM.XOUT;
  BUSY := SUM.Q;
END_FUNCTION_BLOCK
)";

inline constexpr std::string_view plant_log = "t,x,reset\n0.000,1.0,0\n0.001,1.0,0\n0.002,1.0,1\n0.003,-0.5,0\n";

}  // namespace hysteron::test
