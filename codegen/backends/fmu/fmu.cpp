#include "codegen/backends/fmu/fmu.hpp"

#include <fmt/format.h>

#include "codegen/backends/c/c.hpp"
#include "codegen/backends/c_family/names.hpp"
#include "codegen/backends/fmu/model_description.hpp"
#include "codegen/backends/fmu/wrapper.hpp"
#include "codegen/program_hash.hpp"

namespace hysteron {

FmuContents generate_fmu(const Program& program, const FmuOptions& options) {
  const auto step = generate_c(program, {.float32 = options.float32});
  const bool three = options.version == FmiVersion::Three;
  const auto variables = fmu_variables(program, options);
  FmuModel model{
      .name = program.graph.name,
      .identifier = namespace_identifier(program.graph.name),
      .token = fmt::format("hysteron-{}-{}-fmi{}", program_hash(program), options.float32 ? 32 : 64, three ? 3 : 2),
      .sample_time = program.graph.sample_time()};
  std::vector<std::string> sources{model.identifier + ".c", fmt::format("{}_fmi{}.c", model.identifier, three ? 3 : 2)};

  FmuContents contents{
      .model_identifier = model.identifier,
      .binary = fmt::format("binaries/{}/{}.so", three ? "x86_64-linux" : "linux64", model.identifier)};
  contents.files.push_back({"modelDescription.xml", model_description(model, variables, sources, options)});
  for (const GeneratedFile& file : step) {
    contents.files.push_back({"sources/" + file.name, file.text});
  }
  contents.files.push_back({"sources/" + sources.back(), fmu_wrapper(model, variables, options)});
  if (three) {
    contents.files.push_back({"sources/buildDescription.xml", build_description(model, sources)});
  }
  for (const std::string& source : sources) {
    contents.sources.push_back("sources/" + source);
  }
  return contents;
}

}  // namespace hysteron
