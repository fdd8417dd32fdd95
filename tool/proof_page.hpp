// The proof sheet as a page that a person reads, prints and signs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hysteron::tool {

/// `sheet` is what NAME.TARGET.proof.json holds. The page says nothing that the sheet does not.
[[nodiscard]] std::string proof_page(const nlohmann::ordered_json& sheet);

}  // namespace hysteron::tool
