#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/text_file.hpp"
#include "tool/commands.hpp"
#include "tool/diagram.hpp"
#include "tool/generate_host.hpp"
#include "tool/host_sources.hpp"
#include "tool/proof_sheet.hpp"
#include "tool/targets.hpp"
#include "tool/writable.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view generate_examples = R"(Examples:
  hysteron generate feedforward.st --target cpp --out generated
  hysteron generate feedforward.st --target cpp --out generated --params tuned.toml --float32
  hysteron generate feedforward.st --target c --out generated
  hysteron generate feedforward.st --target c --a2l --elf app.elf --symbol params=axis_params --out generated
  hysteron generate feedforward.st --target st --dialect codesys --out plc
  hysteron generate feedforward.st --target st --structured --out plc
  hysteron generate feedforward.st --target plcopen --body fbd --out plc
  hysteron generate plant.st --target fmu --fmi 2 --out models
  hysteron generate feedforward.st --target all --out everywhere
  hysteron generate feedforward.st --host --params tuned.toml --config RUN.toml --out host

cpp: NAME.hpp, the step itself; main.cpp, which runs it over a record; and CMakeLists.txt, which builds both.
batch: NAME_batch.hpp, thousands of instances of the step, eight in the lanes of a vector at a time.
c: NAME.h and NAME.c, in C99. st: NAME.st, one FUNCTION_BLOCK for a PLC, and NAME_program.st, which calls it.
--a2l: NAME.a2l too, for tools of calibration; with --elf it has the addresses of the linked program.
The dialects of st: portable, codesys, twincat, siemens-scl. --structured: the diagram as calls of its blocks, and the
blocks of the library that it calls, as FUNCTION_BLOCKs.
plcopen: NAME.xml, a project in PLCopen TC6 XML. --body st holds the step as text, --body fbd the diagram as a network,
with the blocks that it calls. Its dialects: portable, openplc (plc.xml), codesys, twincat.
fmu: NAME.fmu, for co-simulation in FMI 3.0 or 2.0, with sources and, where there is a C compiler, a binary.
--proof: NAME.TARGET.proof.json beside the files: schedule, bytes, operations, hashes, the bits beside the interpreter, and
the command that repeats it. all: each target in a folder of its own, and a table: 2000 steps of random inputs, run in each beside the interpreter.
With --host: a program that does on another machine what `hysteron serve` does here, with the same registers and bits,
the sources that it is built from, a systemd unit with the rights that RUN.toml needs, what makes a Debian package or a
container of it, and a README.
All are written or none. The step has the bits that `hysteron run` shows.
Exit codes: 0 done; 1 done, but a target of all or of --proof has other bits or could not be run; 2 an error in the diagram, the parameters, the run file or the output folder.
)";

struct GenerateOptions {
  DiagramOptions diagram;
  TargetOptions target;
  std::string config;
  std::string folder;
  bool host = false;
  bool force = false;
  bool proof = false;
};

void check_usage(const GenerateOptions& options) {
  TargetOptions target = options.target;
  target.float32 = options.diagram.float32;
  if (target.target.empty() && !options.host) {
    throw InputError(error::bad_usage, {}, "It is not said what to generate.",
                     "write --target cpp for the step, or --host for a program that runs it as a task.");
  }
  if (!target.target.empty() || !target.dialect.empty() || !target.body.empty() || !target.fmi.empty() ||
      target.structured || target.calibration.wanted) {
    check_target_options(target);
  }
  check_calibration(target.calibration);
  if (options.proof && options.host) {
    throw InputError(error::bad_usage, {}, "A host has no proof sheet.", "write --target cpp, or leave out --proof.");
  }
  if (options.host == options.config.empty()) {
    throw InputError(error::bad_usage, {},
                     options.host ? "A host needs its run file." : "A run file is for a host, and none is asked for.",
                     "write --host and --config RUN.toml together.");
  }
}

/// What was written, by target.
struct Written {
  const Target* target = nullptr;
  std::vector<GeneratedFile> files{};
  ProofSheet sheet{};  ///< where it was asked for
};

/// A line for each target: what it is, its bytes, how it was run, and whether its bits are those of the interpreter.
int print_proofs(const std::vector<Written>& written, Console& console) {
  bool all_equal = true;
  console.print(
      fmt::format("{:<9} {:<16} {:>8}  {:<28} {:>6}  {}\n", "target", "language", "bytes", "run", "steps", "bits"));
  for (const Written& one : written) {
    std::size_t bytes = 0;
    for (const GeneratedFile& file : one.files) {
      bytes += file.name == one.sheet.file.name || file.name == one.sheet.page.name ? 0 : file.text.size();
    }
    const TargetProof& proof = one.sheet.proof;
    all_equal = all_equal && proof.fault.empty();
    console.print(fmt::format("{:<9} {:<16} {:>8}  {:<28} {:>6}  {}\n", one.target->name, one.target->language, bytes,
                              proof.way, proof.was_run ? std::to_string(proof.steps) : "-",
                              proof.fault.empty() ? std::string("equal") : proof.fault));
  }
  return all_equal ? exit_ok : exit_findings;
}

int generate(const GenerateOptions& options, Console& console) {
  check_usage(options);
  Diagnostics warnings;
  const Program program = load_diagram(options.diagram, warnings);
  const bool float32 = options.diagram.float32;
  std::vector<InputFile> inputs = inputs_of(options.diagram);
  inputs.push_back({.file = options.config, .named_by = "--config"});
  inputs.push_back({.file = options.target.calibration.elf, .named_by = "--elf"});
  const bool all = equal_ignoring_case(options.target.target, all_targets);
  TargetOptions target = options.target;
  target.float32 = float32;
  std::vector<Written> written;
  if (options.host) {
    written.push_back(
        {.files = generate_host(program, {.run_file = options.config, .inputs = inputs, .float32 = float32})});
  } else {
    for (const Target& one : targets()) {
      if (all ? one.has_float32 || !float32 : equal_ignoring_case(one.name, target.target)) {
        written.push_back({.target = &one, .files = one.generate(program, target, warnings)});
      }
    }
  }
  for (Written& one : written) {
    if (one.target != nullptr && (all || options.proof)) {
      one.sheet = proof_sheet(program, *one.target, one.files, target, options.diagram);
      if (options.proof) {
        one.files.push_back(one.sheet.file);
        one.files.push_back(one.sheet.page);
      }
    }
  }
  std::vector<OutputFile> files;
  for (const Written& one : written) {
    const fs::path folder = all ? fs::path(options.folder) / one.target->name : fs::path(options.folder);
    for (const GeneratedFile& file : one.files) {
      files.push_back({.path = folder / file.name, .contents = file.text});
      refuse_to_overwrite({.file = files.back().path.string(), .mend = "give another folder for --out."}, inputs);
      if (!options.force) {
        refuse_foreign_file(files.back().path, files.back().contents,
                            "choose another folder with --out, or overwrite the file with --force.");
      }
    }
  }
  write_files_atomically(files);
  console.report(warnings);
  if (all) {
    return print_proofs(written, console);
  }
  for (const OutputFile& file : files) {
    if (!file.path.lexically_relative(options.folder).string().starts_with("hysteron/")) {
      console.print(file.path.string() + "\n");
    }
  }
  if (options.host) {
    console.print(
        fmt::format("{}: {} sources\n", (fs::path(options.folder) / "hysteron").string(), host_sources().size()));
  }
  if (options.proof && !written.front().sheet.proof.fault.empty()) {
    console.print(fmt::format("{}: {}\n", written.front().sheet.file.name, written.front().sheet.proof.fault));
    return exit_findings;
  }
  return exit_ok;
}

}  // namespace

Action add_generate(CLI::App& app) {
  const auto options = std::make_shared<GenerateOptions>();
  add_diagram_options(app, options->diagram);
  app.add_option(
         "--target", options->target.target,
         "The language: cpp (C++11), batch (C++17, many instances), c (C99), st (Structured Text), plcopen (PLCopen "
         "XML), fmu (FMI); or all, each run beside the interpreter.")
      ->option_text("cpp|batch|c|st|plcopen|fmu|all");
  app.add_option("--dialect", options->target.dialect,
                 "Of Structured Text or PLCopen XML; portable where none is given.")
      ->option_text("DIALECT");
  app.add_flag("--a2l", options->target.calibration.wanted,
               "Of C: an A2L file too, with parameters, states, inputs and outputs for a tool of calibration.");
  app.add_option("--elf", options->target.calibration.elf, "The linked program, whose addresses the A2L file gets.")
      ->option_text("APP.elf");
  app.add_option("--symbol", options->target.calibration.symbols,
                 "The variable that holds params, state, in or out, where it has another name; may be repeated.")
      ->option_text("params=NAME");
  app.add_flag("--structured", options->target.structured,
               "Of Structured Text: the blocks stay blocks, and stand beside the diagram.");
  app.add_option("--body", options->target.body, "Of PLCopen XML: the step as text, or the diagram as a network.")
      ->option_text("st|fbd");
  app.add_option("--fmi", options->target.fmi, "The version of FMI of an FMU; 3 where none is given.")
      ->option_text("2|3");
  app.add_flag("--host", options->host, "A program that runs the step as a cyclic task with Modbus.");
  app.add_option("--config", options->config, "The run file of the host.")->option_text("RUN.toml");
  app.add_option("--out", options->folder, "The folder for the files; it is made where there is none.")
      ->required()
      ->option_text("DIR");
  app.add_flag(
      "--proof", options->proof,
      "Runs the files beside the interpreter, and writes NAME.TARGET.proof.json and a page to sign beside them.");
  app.add_flag("--force", options->force, "Overwrites files that Hysteron did not write.");
  app.footer(std::string(generate_examples));
  return [options](Console& console) { return generate(*options, console); };
}

}  // namespace hysteron::tool
