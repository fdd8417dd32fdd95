// The import: a PLCopen TC6 project that was drawn elsewhere, as the text of diagrams.
#pragma once

#include <string>

#include "support/diagnostic.hpp"

namespace hysteron {

struct ImportOptions {
  std::string pou{};    ///< this POU alone, and what it calls; empty: all function blocks, and programs that are drawn
  std::string cycle{};  ///< the sample time, as @ts has it; empty: that of the task that runs the POU
};

/// The text, in the house's layout. What the text means less exactly than the drawing (a REAL that is an LREAL now) is
/// added to the warnings. Throws InputError: HY743 where the file is no PLCopen XML, HY744 with every element that a
/// diagram cannot express.
std::string import_plcopen(const std::string& file, const std::string& xml, const ImportOptions& options,
                           Diagnostics& warnings);

}  // namespace hysteron
