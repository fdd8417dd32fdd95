// An FMU as a block of the language: its pins have names and units of the language, its outputs depend on its memory
// alone.
//
// One step is one communication step: the inputs of step k are set, the FMU computes from t_k to t_k+1, and its outputs
// are those of step k + 1. In step 0 they are what the FMU begins with. So a loop may go through it.
#pragma once

#include <string>
#include <string_view>

#include "codegen/graph/graph.hpp"
#include "codegen/trace/block_type.hpp"

namespace hysteron {

/// The block of a file. It lives as long as the process. Throws InputError HY219.
[[nodiscard]] const BlockType& fmu_block(const std::string& path);

/// What the FMU calls a pin of its block, by the place of the pin among inputs and parameters, or among outputs.
[[nodiscard]] std::string_view name_in_fmu(const BlockType& block, std::size_t pin);
[[nodiscard]] std::string_view output_name_in_fmu(const BlockType& block, std::size_t output);

/// Where the file of an FMU is, as named by an annotation of a text.
[[nodiscard]] std::string fmu_path(const language::SourceFile& source, std::string_view file);

/// Parameters of an FMU are set when it begins: a signal cannot drive them. Reports HY207; of a finished graph.
void check_fmu_parameters(const Graph& graph, Diagnostics& diagnostics);

/// Where no FMU can be: throws InputError HY754 with the reason and the mend if the graph has one.
void refuse_fmu(const Graph& graph, std::string_view why, std::string mend);

/// What generated code and a served task need: a sample time (HY404), and no FMU (HY754). Throws InputError.
void require_generable(const Graph& graph);

}  // namespace hysteron
