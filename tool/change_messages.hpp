// What `hysteron serve` and `hysteron online-change` tell each other, as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "runtime/host/online_change.hpp"
#include "support/atomic_file.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::tool {

using Json = nlohmann::ordered_json;

/// As docs/reference/schemas/online-change.schema.json has it; what is no number is null.
[[nodiscard]] Json as_json(const runtime::ChangeReport& report);

/// Back from what support/render.hpp makes of them.
[[nodiscard]] Diagnostics diagnostics_of(const Json& json);

[[nodiscard]] Json as_json(const std::vector<OutputFile>& files);
[[nodiscard]] std::vector<OutputFile> files_of(const Json& json);

}  // namespace hysteron::tool
