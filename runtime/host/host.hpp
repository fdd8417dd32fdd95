// A program run as its run file says, from the start to the safe outputs at the end: what `hysteron serve` and a
// generated host have in common.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/config/run_config.hpp"
#include "runtime/host/online_change.hpp"
#include "runtime/point.hpp"
#include "runtime/task/changeable_program.hpp"
#include "runtime/task/field_io.hpp"
#include "runtime/task/step_program.hpp"
#include "support/overwriting.hpp"

namespace hysteron::runtime {

/// Makes what else serves the door beside the task, and adds to the status line where. Its life is that of the task.
using BesideTask = std::function<std::shared_ptr<void>(PointDoor& door, std::string& where)>;

struct HostOptions {
  std::string how{};         ///< compiled, interpreted, generated: for the status line
  std::uint64_t cycles = 0;  ///< ends after so many; 0: when it is asked to
  bool virtual_time = false;
  BesideTask beside{};
  /// Where the version of the diagram may change: the program itself, and what hands on to it who wishes a change, as
  /// `beside`. Where the run file has no [online_change], it is not asked for.
  ChangeableProgram* changeable = nullptr;
  std::function<std::shared_ptr<void>(OnlineChange& change, std::string& where)> take_changes{};
  /// The field, in place of the devices of the run file: a plant that is simulated. Null: those devices.
  FieldIo* field = nullptr;
};

/// Throws InputError HY709 where the run file has the trace or the one before it, the lock file or what is retained
/// written over one of the inputs, or over a file that it names itself. The inputs are those that the run file does not
/// name, and the run file.
void refuse_to_overwrite_inputs(const RunConfig& config, std::vector<InputFile> inputs);

/// Runs until SIGTERM, Ctrl-C, a fault that ends it or its number of cycles. Prints a line when it runs, and another at
/// its end. True where it ended as asked, with its outputs safe and all that it keeps on the disk. Throws InputError
/// HY811, HY812, HY814 to HY816 and those of the server, and then no device and no file was touched. To be called while
/// the process has one thread: it forks the guard.
[[nodiscard]] bool run_host(StepProgram& program, RunConfig config, const HostOptions& options,
                            const std::function<void(std::string_view)>& print);

}  // namespace hysteron::runtime
