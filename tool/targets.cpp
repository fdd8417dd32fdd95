#include "tool/targets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "codegen/backends/batch/batch.hpp"
#include "codegen/backends/c/c.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/backends/plcopen/plcopen.hpp"
#include "codegen/backends/st/st.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "tool/fmu.hpp"
#include "tool/graphviz.hpp"

namespace hysteron::tool {
namespace {

constexpr std::array list{
    Target{"cpp", "C++11",
           [](const Program& program, const TargetOptions& options, Diagnostics& /*warnings*/) {
             return generate_cpp(program, {.float32 = options.float32});
           }},
    Target{"c", "C99",
           [](const Program& program, const TargetOptions& options, Diagnostics& warnings) {
             std::vector<GeneratedFile> files = generate_c(program, {.float32 = options.float32});
             if (options.calibration.wanted) {
               files.push_back(calibration_file(program, options.calibration, options.float32, warnings));
             }
             return files;
           }},
    Target{"batch", "C++17 vectors",
           [](const Program& program, const TargetOptions& /*options*/, Diagnostics& /*warnings*/) {
             return std::vector{generate_batch(program)};
           },
           false},
    Target{"st", "Structured Text",
           [](const Program& program, const TargetOptions& options, Diagnostics& /*warnings*/) {
             const StOptions given{.dialect = *st_dialect(options.dialect.empty() ? "portable" : options.dialect),
                                   .float32 = options.float32};
             return options.structured ? generate_st_structured(program, given) : generate_st(program, given);
           }},
    Target{"plcopen", "PLCopen XML",
           [](const Program& program, const TargetOptions& options, Diagnostics& /*warnings*/) {
             return generate_plcopen(
                 program,
                 {.dialect = options.dialect.empty() ? "portable" : options.dialect,
                  .body = equal_ignoring_case(options.body, "fbd") ? PlcopenBody::Network : PlcopenBody::Text,
                  .float32 = options.float32,
                  .place = [](const std::string& dot) { return drawn_by_graphviz(dot, "plain", "--body st"); }});
           }},
    Target{"fmu", "FMI",
           [](const Program& program, const TargetOptions& options, Diagnostics& warnings) {
             return std::vector{pack_fmu(
                 program,
                 {.version = options.fmi == "2" ? FmiVersion::Two : FmiVersion::Three, .float32 = options.float32},
                 warnings)};
           }},
};

[[noreturn]] void refuse(std::string cause, std::string mend) {
  throw InputError(error::bad_usage, {}, std::move(cause), std::move(mend));
}

void check_dialect(const TargetOptions& options) {
  const bool text = equal_ignoring_case(options.target, "st");
  const bool project = equal_ignoring_case(options.target, "plcopen");
  if (!options.dialect.empty() && !text && !project) {
    refuse("A dialect is one of Structured Text or of PLCopen XML.",
           "write --target st or --target plcopen, or leave out --dialect.");
  }
  if (!options.dialect.empty() &&
      !(text ? st_dialect(options.dialect).has_value() : is_plcopen_dialect(options.dialect))) {
    refuse(fmt::format("There is no dialect {}.", options.dialect),
           fmt::format("the dialects are: {}.", text ? std::string(st_dialect_names()) : plcopen_dialect_names()));
  }
  if (!options.body.empty() && !project) {
    refuse("A body is chosen for PLCopen XML.", "write --target plcopen, or leave out --body.");
  }
  if (!options.body.empty() && !equal_ignoring_case(options.body, "st") && !equal_ignoring_case(options.body, "fbd")) {
    refuse(fmt::format("There is no body {}.", options.body), "the bodies are: st, fbd.");
  }
}

}  // namespace

std::span<const Target> targets() {
  return list;
}

const Target* find_target(std::string_view name) {
  const auto* const found =
      std::ranges::find_if(list, [&](const Target& one) { return equal_ignoring_case(one.name, name); });
  return found == list.end() ? nullptr : found;
}

void check_target_options(const TargetOptions& options) {
  if (find_target(options.target) == nullptr && !equal_ignoring_case(options.target, all_targets)) {
    std::vector<std::string_view> names;
    for (const Target& one : list) {
      names.push_back(one.name);
    }
    names.push_back(all_targets);
    refuse(fmt::format("There is no target {}.", options.target),
           fmt::format("the targets are: {}.", fmt::join(names, ", ")));
  }
  check_dialect(options);
  if (const Target* const found = find_target(options.target);
      found != nullptr && options.float32 && !found->has_float32) {
    refuse(fmt::format("The target {} computes in 64 bits.", found->name),
           "leave out --float32, or write --target cpp.");
  }
  if (options.structured && !equal_ignoring_case(options.target, "st")) {
    refuse("A structured text is one of Structured Text.", "write --target st, or leave out --structured.");
  }
  if (options.calibration.wanted && !equal_ignoring_case(options.target, "c")) {
    refuse("An A2L file describes the structures of C.", "write --target c, or leave out --a2l.");
  }
  if (!options.fmi.empty() && !equal_ignoring_case(options.target, "fmu")) {
    refuse("A version of FMI is one of an FMU.", "write --target fmu, or leave out --fmi.");
  }
  if (!options.fmi.empty() && options.fmi != "2" && options.fmi != "3") {
    refuse(fmt::format("There is no version {} of FMI here.", options.fmi), "write --fmi 2 or --fmi 3.");
  }
}

}  // namespace hysteron::tool
