// hysteron lsp: the language server as a command.
#pragma once

#include "tool/commands.hpp"

namespace hysteron::tool {

Action add_lsp(CLI::App& app);

}  // namespace hysteron::tool
