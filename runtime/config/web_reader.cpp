#include "runtime/config/web_reader.hpp"

#include <string>
#include <vector>

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
    bool* const right = word == "parameters" ? &web.rights.parameters
                        : word == "reset"    ? &web.rights.reset
                        : word == "force"    ? &web.rights.force
                                             : nullptr;
    if (right == nullptr) {
      found.error(error::wrong_run_value, table.place("rights"), "The live page has no right \"" + word + "\".",
                  "use some of: parameters, reset, force.");
    } else {
      *right = true;
    }
  }
  return web;
}

}  // namespace hysteron::runtime
