#include "lsp/server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "codegen/compile.hpp"
#include "codegen/graph/names.hpp"
#include "lsp/actions.hpp"
#include "lsp/symbols.hpp"
#include "lsp/words.hpp"

namespace hysteron::lsp {
namespace {

using nlohmann::json;

// The error codes of JSON-RPC 2.0 and LSP 3.17.
constexpr int invalid_request = -32600;
constexpr int method_not_found = -32601;
constexpr int invalid_params = -32602;
constexpr int internal_error = -32603;
constexpr int server_not_initialized = -32002;
constexpr int request_failed = -32803;

struct ProtocolError : std::runtime_error {
  ProtocolError(int the_code, const std::string& text) : std::runtime_error(text), code(the_code) {}
  int code;
};

json failure(const json& id, int code, const std::string& text) {
  return {{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", text}}}};
}

Position position_in(const json& position) {
  return {position.at("line").get<std::uint64_t>(), position.at("character").get<std::uint64_t>()};
}

json as_json(Position position) {
  return {{"line", position.line}, {"character", position.character}};
}

}  // namespace

json Server::range(std::string_view text, std::size_t begin, std::size_t end) const {
  return {{"start", as_json(position_of(text, begin, encoding_))}, {"end", as_json(position_of(text, end, encoding_))}};
}

std::pair<std::size_t, std::size_t> Server::offsets(std::string_view text, const json& range) const {
  return {offset_of(text, position_in(range.at("start")), encoding_),
          offset_of(text, position_in(range.at("end")), encoding_)};
}

const Server::Document& Server::document(const json& params) const {
  const auto uri = params.at("textDocument").at("uri").get<std::string>();
  const auto found = documents_.find(uri);
  if (found == documents_.end()) {
    throw ProtocolError(invalid_params, uri + " is not open. Send textDocument/didOpen first.");
  }
  return found->second;
}

json Server::initialize(const json& params) {
  if (initialized_) {
    throw ProtocolError(invalid_request, "initialize comes once.");
  }
  const auto encodings = params.value("/capabilities/general/positionEncodings"_json_pointer, json::array());
  // Offsets are in UTF-8 here: where the client takes them as they are, nothing is counted twice.
  encoding_ = std::ranges::find(encodings, json("utf-8")) != encodings.end() ? Encoding::Utf8 : Encoding::Utf16;
  initialized_ = true;
  return {{"serverInfo", {{"name", "hysteron"}}},
          {"capabilities",
           {{"positionEncoding", encoding_ == Encoding::Utf8 ? "utf-8" : "utf-16"},
            {"textDocumentSync", {{"openClose", true}, {"change", 2}}},
            {"hoverProvider", true},
            {"definitionProvider", true},
            {"referencesProvider", true},
            {"renameProvider", {{"prepareProvider", true}}},
            {"documentSymbolProvider", true},
            {"completionProvider", {{"triggerCharacters", {".", "(", ":", "@", " "}}}},
            {"codeActionProvider", {{"codeActionKinds", {"quickfix"}}}},
            {"documentFormattingProvider", true}}}};
}

json Server::format(const json& params) {
  const auto& open = document(params);
  Diagnostics found;
  const auto formatted = format_text(path_of(params.at("textDocument").at("uri").get<std::string>()), open.text, found);
  if (found.has_errors()) {
    const auto& first = *std::ranges::find(found.all(), Severity::Error, &Diagnostic::severity);
    throw ProtocolError(request_failed, fmt::format("HY{:03}, line {}: {} {}", first.number, first.place.line,
                                                    first.cause, first.mend));
  }
  auto edits = json::array();
  if (formatted != open.text) {
    edits.push_back({{"range", range(open.text, 0, open.text.size())}, {"newText", formatted}});
  }
  return edits;
}

json Server::named(const std::string& method, const json& params) const {
  const auto& open = document(params);
  const auto uri = params.at("textDocument").at("uri").get<std::string>();
  const language::SourceFile& tree = *open.tree;
  const auto offset = offset_of(open.text, position_in(params.at("position")), encoding_);
  const Declared what = declared_at(tree, offset);
  const auto range_of = [&](const language::Span& span) {
    return range(open.text, span.offset, span.offset + span.length);
  };
  if (method == "textDocument/definition") {
    return what.block == nullptr ? json(nullptr) : json{{"uri", uri}, {"range", range_of(what.name().span)}};
  }
  const std::vector<language::Span> places = places_of(tree, what);
  if (method == "textDocument/references") {
    const bool with_declaration = params.value("/context/includeDeclaration"_json_pointer, true);
    auto list = json::array();
    for (const language::Span& place : places) {
      if (with_declaration || place.offset != what.name().span.offset) {
        list.push_back({{"uri", uri}, {"range", range_of(place)}});
      }
    }
    return list;
  }
  if (method == "textDocument/prepareRename") {
    const auto here = std::ranges::find_if(places, [&](const language::Span& place) { return touches(place, offset); });
    return here == places.end() ? json(nullptr) : range_of(*here);
  }
  if (!tree.valid) {
    throw ProtocolError(request_failed, "The text has a syntax error. Mend it before something gets another name.");
  }
  const auto new_name = params.at("newName").get<std::string>();
  if (const std::string reason = refused_name(tree, what, new_name); !reason.empty()) {
    throw ProtocolError(request_failed, reason);
  }
  auto edits = json::array();
  for (const language::Span& place : places) {
    edits.push_back({{"range", range_of(place)}, {"newText", new_name}});
  }
  return {{"changes", {{uri, edits}}}};
}

json Server::actions(const json& params) const {
  const auto& open = document(params);
  const auto uri = params.at("textDocument").at("uri").get<std::string>();
  const auto [begin, end] = offsets(open.text, params.at("range"));
  auto list = json::array();
  for (const json& one : open.diagnostics) {
    const auto [first, last] = offsets(open.text, one.at("range"));
    if (one.contains("data") && first <= end && begin <= last) {
      const auto word = one["data"].get<std::string>();
      const json edit{{"range", one["range"]}, {"newText", word}};
      list.push_back({{"title", "Write " + word},
                      {"kind", "quickfix"},
                      {"isPreferred", true},
                      {"diagnostics", json::array({one})},
                      {"edit", {{"changes", {{uri, json::array({edit})}}}}}});
    }
  }
  return list;
}

json Server::outline(const Document& open) const {
  // SymbolKind of LSP 3.17.
  constexpr int kind_class = 5;
  constexpr int kind_field = 8;
  constexpr int kind_variable = 13;
  constexpr int kind_constant = 14;
  constexpr int kind_object = 19;
  const auto symbol = [&](const language::Name& name, const std::string& detail, int kind,
                          const language::Span& whole) {
    return json{{"name", name.text},
                {"detail", detail},
                {"kind", kind},
                {"range", range(open.text, whole.offset, whole.offset + whole.length)},
                {"selectionRange", range(open.text, name.span.offset, name.span.offset + name.span.length)}};
  };
  auto list = json::array();
  for (const language::FunctionBlock& block : open.tree->blocks) {
    auto one = symbol(block.name, "FUNCTION_BLOCK", kind_class, block.span);
    auto children = json::array();
    for (const language::Variable& variable : block.variables) {
      using language::Section;
      Type type{};
      const int kind = variable.section == Section::Constant       ? kind_constant
                       : variable.section != Section::Local        ? kind_field
                       : elementary_type(variable.type.text, type) ? kind_variable
                                                                   : kind_object;
      children.push_back(symbol(variable.name, std::string(variable.type.text), kind, variable.name.span));
    }
    one["children"] = std::move(children);
    list.push_back(std::move(one));
  }
  return list;
}

json Server::request(const std::string& method, const json& params) {
  if (method == "initialize") {
    return initialize(params);
  }
  if (!initialized_) {
    throw ProtocolError(server_not_initialized, "initialize comes first.");
  }
  if (shut_down_) {
    throw ProtocolError(invalid_request, "After shutdown, only exit may come.");
  }
  if (method == "shutdown") {
    shut_down_ = true;
    return nullptr;
  }
  if (method == "textDocument/formatting") {
    return format(params);
  }
  if (method == "textDocument/codeAction") {
    return actions(params);
  }
  if (method == "textDocument/documentSymbol") {
    return outline(document(params));
  }
  if (method == "textDocument/definition" || method == "textDocument/references" ||
      method == "textDocument/prepareRename" || method == "textDocument/rename") {
    return named(method, params);
  }
  if (method == "textDocument/hover" || method == "textDocument/completion") {
    const auto& open = document(params);
    const Insight insight{open.text, *open.tree, open.known.get()};
    const auto offset = offset_of(open.text, position_in(params.at("position")), encoding_);
    if (method == "textDocument/completion") {
      return completion(insight, offset);
    }
    const auto text = hover(insight, offset, card_);
    return text.empty() ? json(nullptr) : json{{"contents", {{"kind", "plaintext"}, {"value", text}}}};
  }
  throw ProtocolError(method_not_found, method + " is not known here.");
}

void Server::change(Document& open, const json& change) const {
  auto text = change.at("text").get<std::string>();
  if (!change.contains("range")) {
    open.text = std::move(text);
    return;
  }
  const auto [begin, end] = offsets(open.text, change.at("range"));
  open.text.replace(begin, std::max(begin, end) - begin, text);
}

json Server::published(const std::string& uri, Document& open) const {
  const auto path = path_of(uri);
  Diagnostics found;
  try {
    auto parsed = language::parse(path, open.text, found);
    const bool valid = parsed.valid && !found.has_errors();
    open.tree = std::make_shared<const language::SourceFile>(std::move(parsed));
    if (valid) {
      open.known = open.tree;
      check(open.tree, found);
    }
  } catch (const InputError& error) {
    found = error.diagnostics();
  }
  auto list = json::array();
  for (const Diagnostic& one : found.all()) {
    const bool here = one.place.file == path;
    const auto begin = here ? offset_of_place(open.text, one.place.line, one.place.column) : 0;
    const auto end = here ? offset_of_place(open.text, one.place.line, one.place.column + one.place.length) : 0;
    list.push_back({{"range", range(open.text, begin, end)},
                    {"severity", one.severity == Severity::Error ? 1 : 2},
                    {"code", fmt::format("HY{:03}", one.number)},
                    {"source", "hysteron"},
                    {"message", (here ? "" : one.place.file + ": ") + one.cause + "\n" + one.mend}});
    const std::string written = open.text.substr(begin, end - begin);
    if (const auto word = here ? proposed_word(written, one.mend) : std::nullopt) {
      list.back()["data"] = *word;
    }
  }
  open.diagnostics = list;
  return {{"jsonrpc", "2.0"},
          {"method", "textDocument/publishDiagnostics"},
          {"params", {{"uri", uri}, {"diagnostics", list}}}};
}

std::vector<json> Server::notification(const std::string& method, const json& params) {
  if (method == "exit") {
    exited_ = true;
  }
  if (!initialized_ || shut_down_) {
    return {};
  }
  if (method == "textDocument/didOpen") {
    const auto& item = params.at("textDocument");
    const auto uri = item.at("uri").get<std::string>();
    Document open;
    open.text = item.at("text").get<std::string>();
    auto& kept = documents_[uri] = std::move(open);
    return {published(uri, kept)};
  }
  if (method == "textDocument/didChange") {
    const auto uri = params.at("textDocument").at("uri").get<std::string>();
    auto next = document(params);
    for (const auto& one : params.at("contentChanges")) {
      change(next, one);
    }
    auto& kept = documents_[uri] = std::move(next);
    return {published(uri, kept)};
  }
  if (method == "textDocument/didClose") {
    const auto uri = params.at("textDocument").at("uri").get<std::string>();
    documents_.erase(uri);
    return {{{"jsonrpc", "2.0"},
             {"method", "textDocument/publishDiagnostics"},
             {"params", {{"uri", uri}, {"diagnostics", json::array()}}}}};
  }
  return {};
}

std::vector<json> Server::handle(const json& message) {
  const bool is_request = message.is_object() && message.contains("id");
  const json id = is_request ? message.at("id") : json(nullptr);
  const auto method = message.is_object() ? message.find("method") : message.end();
  if (!message.is_object() || (method != message.end() && !method->is_string())) {
    return {failure(id, invalid_request, "A message is an object with a method.")};
  }
  if (method == message.end()) {
    return {};  // a response: nothing was asked here
  }
  const json params = message.value("params", json::object());
  try {
    if (!is_request) {
      return notification(*method, params);
    }
    return {{{"jsonrpc", "2.0"}, {"id", id}, {"result", request(*method, params)}}};
  } catch (const ProtocolError& error) {
    return is_request ? std::vector{failure(id, error.code, error.what())} : std::vector<json>{};
  } catch (const json::exception& error) {
    return is_request ? std::vector{failure(id, invalid_params, error.what())} : std::vector<json>{};
  } catch (const std::exception& error) {
    return is_request ? std::vector{failure(id, internal_error, error.what())} : std::vector<json>{};
  }
}

}  // namespace hysteron::lsp
