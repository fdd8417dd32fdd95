// A file that a back-end writes.
#pragma once

#include <string>

namespace hysteron {

struct GeneratedFile {
  std::string name;
  std::string text;
};

/// Appends all parts. Text is written once, where it stays: a long diagram has some hundred megabytes of it.
template <class... Parts>
void append(std::string& text, const Parts&... parts) {
  (text.append(parts), ...);
}

}  // namespace hysteron
