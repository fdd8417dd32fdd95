// The proof sheet beside generated files: what they are made of, and that they do what the diagram does.
#pragma once

#include <string>
#include <vector>

#include "tool/diagram.hpp"
#include "tool/target_proof.hpp"

namespace hysteron::tool {

struct ProofSheet {
  GeneratedFile file{};  ///< NAME.TARGET.proof.json
  GeneratedFile page{};  ///< NAME.TARGET.proof.html: the same for a person who signs it
  TargetProof proof{};
};

/// Runs the files of a target beside the interpreter, and tells: schedule, bytes of state and of parameters,
/// operations, hashes of diagram, parameters and files, the version of the generator, the bits, and the command that
/// repeats it. The same input gives the same bytes. A dialect that no front end here reads is proved by the portable
/// text of the same step.
[[nodiscard]] ProofSheet proof_sheet(const Program& program, const Target& target,
                                     const std::vector<GeneratedFile>& files, const TargetOptions& options,
                                     const DiagramOptions& diagram);

}  // namespace hysteron::tool
