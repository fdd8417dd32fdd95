// SHA-256 (FIPS 180-4): the name by which generated text refers to the diagram and parameters it came from.
#pragma once

#include <string>
#include <string_view>

namespace hysteron {

/// The digest of a text, as 64 hexadecimal digits in lower case.
[[nodiscard]] std::string sha256(std::string_view text);

}  // namespace hysteron
