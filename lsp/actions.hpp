// Errors that mend themselves: those whose mend is one word in the place of another.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace hysteron::lsp {

/// The word that a mend proposes in the place of the one that was written: XIN of `Did you mean XIN?`, and of `Its
/// inputs are XIN, R1.` where it is near. Nothing where the mend is something to think about.
[[nodiscard]] std::optional<std::string> proposed_word(std::string_view written, std::string_view mend);

}  // namespace hysteron::lsp
