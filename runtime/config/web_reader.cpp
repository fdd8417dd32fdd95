#include "runtime/config/web_reader.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "runtime/config/page_rights.hpp"
#include "support/errors.hpp"

namespace hysteron::runtime {

WebConfig read_web(TomlReader table, Diagnostics& found) {
  WebConfig web;
  web.place = table.place("listen");
  table.read("listen", web.listen);
  table.read("token_file", web.token_file);
  table.read("read_token_file", web.read_token_file);
  if (!table.has("rights")) {
    return web;
  }
  std::vector<std::string> words;
  table.read("rights", words, R"(["parameters", "reset"])");
  web.rights = {.parameters = false, .reset = false, .force = false};
  for (const std::string& word : words) {
    const auto* const right = std::ranges::find(page_rights, word, &PageRight::name);
    if (right == page_rights.end()) {
      found.error(error::wrong_run_value, table.place("rights"), "The live page has no right \"" + word + "\".",
                  "use some of: parameters, reset, force.");
    } else {
      web.rights.*right->is_given = true;
    }
  }
  return web;
}

}  // namespace hysteron::runtime
