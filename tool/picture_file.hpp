// A picture of figures as a file: SVG, PNG, or a page with zoom, by the ending of its name.
#pragma once

#include <span>
#include <string>

#include "plots/figure.hpp"
#include "support/overwriting.hpp"

namespace hysteron::tool {

/// Asked before any work: the ending is known, the file can be written and is none of the inputs. `option` names the
/// file. Throws InputError: HY730, HY700, HY709, and HY740 where a PNG is wanted and nothing draws it.
void refuse_unfit_picture(const std::string& file, const std::string& option, const std::vector<InputFile>& inputs);

/// The bytes of the file. Throws InputError HY740 or HY741.
[[nodiscard]] std::string picture_bytes(const std::string& file, const std::string& title,
                                        std::span<const plots::Figure> figures);

}  // namespace hysteron::tool
