#include "tool/commands.hpp"

#include <array>

namespace hysteron::tool {

std::span<const Command> commands() {
  static constexpr std::array list{
      Command{"new", "Makes a folder to begin with: diagram, parameters, record, test.", add_new, Results::Report},
      Command{"check", "Checks diagrams: syntax, names, types, wires, units, loops.", add_check, Results::Findings},
      Command{"fmt", "Formats diagrams, and never changes what they mean.", add_fmt},
      Command{"draw", "Draws a diagram as a picture.", add_draw, Results::Report},
      Command{"record", "Says what was understood of a measured record.", add_record, Results::Findings},
      Command{"plot", "Draws records and parameters as a picture, or as a page with zoom.", add_plot, Results::Report},
      Command{"compare", "Compares two records, parameter files, diagrams or verdicts.", add_compare,
              Results::Findings},
      Command{"run", "Runs a diagram over a record.", add_run, Results::Report},
      Command{"tune", "Fits parameters of a diagram to records, or tunes a controller for a goal.", add_tune,
              Results::Report},
      Command{"relay", "Says what a relay experiment tells of a process, and where a PID may begin.", add_relay,
              Results::Findings},
      Command{"diagnose", "Explains the gap between a diagram and the machine.", add_diagnose, Results::Report},
      Command{"fleet", "Diagnoses or tunes the machines of a manifest, a record at a time.", add_fleet,
              Results::Report},
      Command{"fleet-report", "Says which machines of a fleet drift or stand out.", add_fleet_report, Results::Report},
      Command{"generate", "Generates code from a diagram.", add_generate, Results::Report},
      Command{"export", "Exports a fitted axis as a joint of a robot: MuJoCo or URDF.", add_export, Results::Report},
      Command{"library", "Writes the blocks of the library for a PLC, in Structured Text.", add_library,
              Results::Report},
      Command{"import", "Reads a diagram of another editor: PLCopen XML, or a .TcPOU of TwinCAT.", add_import, Results::Report},
      Command{"test", "Runs the tests beside diagrams, interpreted and as generated code.", add_test,
              Results::Findings},
      Command{"serve", "Runs a diagram as a cyclic task, and serves it over Modbus.", add_serve, Results::Report},
      Command{"online-change", "Changes the diagram of a task that runs, without ending it.", add_online_change,
              Results::Report},
      Command{"replay", "Runs a recorded trace again, and compares every bit.", add_replay, Results::Findings},
      Command{"history", "What a task has kept for days: listed, or as a record.", add_history},
      Command{"map", "Prints the registers of a served diagram.", add_map},
      Command{"retained", "Shows what a task keeps through a restart, and brings it back into a parameter file.",
              add_retained},
      Command{"doctor", "Says what of this machine makes a cyclic task late, and how to mend it.", add_doctor,
              Results::Findings},
      Command{"blocks", "Lists the blocks of the library, or describes one.", add_blocks, Results::Findings},
      Command{"lsp", "Serves an editor: diagnostics, hover, completion, layout.", add_lsp},
      Command{"explain", "Explains an error by its number.", add_explain, Results::Findings},
      Command{"man", "Prints a manual page.", add_man},
      Command{"completion", "Prints the completion for a shell.", add_completion},
  };
  return list;
}

}  // namespace hysteron::tool
