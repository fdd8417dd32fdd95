#include "runtime/config/tls_reader.hpp"

#include <algorithm>
#include <utility>

#include "support/errors.hpp"

namespace hysteron::runtime {

void TlsReader::read(const toml::table* tls, const toml::table* roles) {
  if (tls == nullptr || !config_->modbus) {
    if (tls != nullptr || roles != nullptr) {
      const auto* const table = tls != nullptr ? tls : roles;
      found_->error(error::roles_without_tls, place_of(*file_, table->source()),
                    tls != nullptr ? "There is a table [tls], and no server." : "There are roles, and no TLS.",
                    tls != nullptr ? "add the table [modbus], or remove [tls]."
                                   : "a role is told by a client's certificate: add the table [tls], or remove "
                                     "[roles].");
    }
    return;
  }
  modbus::TlsOptions options;
  read_files({*file_, "[tls]", *tls, run_table("tls").keys, *found_}, options);
  bool all_understood = true;
  if (roles != nullptr) {
    const auto before = found_->all().size();
    for (const auto& [name, node] : *roles) {
      read_role(std::string(name.str()), node, options);
    }
    all_understood = found_->all().size() == before;
  }
  const bool any = std::ranges::any_of(options.roles, [](const auto& one) { return one.second != modbus::no_rights; });
  if (all_understood && !any && options.without_role == modbus::no_rights) {
    found_->error(
        error::no_role_may_anything, place_of(*file_, tls->source()),
        "No role may do anything, so every request would be refused.",
        "add the table [roles] with the roles that your certificates name: operator = [\"read\", \"inputs\"].");
  }
  config_->modbus->tls = std::move(options);
}

void TlsReader::read_files(TomlReader table, modbus::TlsOptions& tls) {
  const auto read = [&](const std::string& key, std::string& into, Place& place) {
    table.require(key, "\"" + key + ".pem\"");
    table.read(key, into);
    place = table.place(key);
  };
  read("certificate", tls.certificate, tls.certificate_place);
  read("key", tls.key, tls.key_place);
  read("clients", tls.clients, tls.clients_place);
  std::vector<std::string> words;
  table.read("without_role", words, R"(["read"])");
  tls.without_role = rights_in(words, table.place("without_role"));
}

void TlsReader::read_role(const std::string& name, const toml::node& node, modbus::TlsOptions& tls) {
  const Place place = place_of(*file_, node.source());
  const auto* const list = node.as_array();
  std::vector<std::string> words;
  const bool well = list != nullptr && !name.empty() && std::ranges::all_of(*list, [&](const toml::node& one) {
                      words.push_back(one.value_or(std::string()));
                      return one.is_string();
                    });
  if (!well) {
    found_->error(error::wrong_run_value, place, "The role \"" + name + "\" must have a name and a list of rights.",
                  "write it as in operator = [\"read\", \"inputs\"]; a name with other signs than letters in quotes.");
    return;
  }
  tls.roles[name] = rights_in(words, place);
}

modbus::Rights TlsReader::rights_in(const std::vector<std::string>& words, const Place& place) {
  modbus::Rights rights = modbus::no_rights;
  for (const std::string& word : words) {
    bool* const right = word == "read"         ? &rights.read
                        : word == "inputs"     ? &rights.inputs
                        : word == "parameters" ? &rights.parameters
                        : word == "reset"      ? &rights.reset
                                               : nullptr;
    if (right == nullptr) {
      found_->error(error::wrong_run_value, place, "There is no right \"" + word + "\".",
                    "use some of: read, inputs, parameters, reset.");
    } else {
      *right = true;
    }
  }
  return rights;
}

}  // namespace hysteron::runtime
