// What other libraries call the blocks: for "did you mean", and for the page docs/reference/other-names.md.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace hysteron {

struct OtherName {
  std::string_view name;
  std::string_view library;  ///< IEC 61131-3, OSCAT, CODESYS Util, Simulink
  std::string_view block;    ///< of the catalogue
  std::string_view differs;  ///< what to mind; empty where they do the same
};

/// All of them, by library and name.
std::span<const OtherName> other_names();

/// The block of a name of another library, without regard to case, spaces, signs and a prefix HY_; empty where there is
/// none.
std::string_view block_of_other_name(std::string_view name);

}  // namespace hysteron
