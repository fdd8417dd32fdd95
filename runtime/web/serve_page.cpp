#include "runtime/web/serve_page.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "runtime/host/notices.hpp"
#include "runtime/modbus/tls_context.hpp"
#include "runtime/web/access.hpp"
#include "support/errors.hpp"

namespace hysteron::runtime::web {
namespace {

/// An error about what the run file says is said at its place there.
template <class Work>
auto placed(const Place& place, const Work& work) {
  try {
    return work();
  } catch (const InputError& refused) {
    Diagnostics diagnostics;
    for (Diagnostic one : refused.diagnostics().all()) {
      one.place = one.place.file.empty() ? place : one.place;
      diagnostics.add(std::move(one));
    }
    throw InputError(std::move(diagnostics));
  }
}

}  // namespace

std::optional<ServerOptions> page_server_options(const RunConfig& config, const PageOptions& options) {
  const WebConfig web = config.web.value_or(WebConfig{});
  const bool is_by_command = !options.listen.empty();
  const std::string& listen = is_by_command ? options.listen : web.listen;
  if (listen.empty()) {
    if (!options.token_file.empty() || !options.read_token_file.empty()) {
      throw InputError(error::bad_usage, {}, "A token file is named, and no address for the live page.",
                       "add --web 127.0.0.1:8080, or listen under [web] in the run file.");
    }
    return {};
  }
  return placed(is_by_command ? Place{} : web.place, [&] {
    ServerOptions server{.endpoint = parse_endpoint(listen),
                         .tell = [](const std::string& line) { tell("Live page", line); }};
    const auto token_in = [](const std::string& own, const std::string& of_file, const char* credential) {
      const std::string& file = own.empty() ? of_file : own;
      return file.empty() ? std::string() : read_token(modbus::credential_path(file, credential));
    };
    server.access = {.is_loopback = server.endpoint.is_loopback,
                     .token = token_in(options.token_file, web.token_file, token_credential),
                     .read_token = token_in(options.read_token_file, web.read_token_file, read_token_credential),
                     .rights = web.rights};
    check_access(server.endpoint, server.access);
    return std::optional(std::move(server));
  });
}

BesideTask page_beside(const ServerOptions& options, const RunConfig& config, const ProgramShape& shape) {
  const HistoryConfig history = config.history.value_or(HistoryConfig{});
  const Subject subject{
      .name = shape.name, .period = shape.period, .history = history.file, .history_points = history.points};
  return [options, subject](PointDoor& door, std::string& where) -> std::shared_ptr<void> {
    auto server = std::make_shared<Server>(door, subject, options);
    where += fmt::format("; live page on http://{}/", text_of(options.endpoint, server->port()));
    return server;
  };
}

BesideTask page_of_run_file(const RunConfig& config, const ProgramShape& shape) {
  const auto options = page_server_options(config, {});
  return options ? page_beside(*options, config, shape) : BesideTask();
}

}  // namespace hysteron::runtime::web
