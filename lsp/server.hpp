// The language server: one client, over JSON-RPC 2.0 as LSP 3.17 frames it.
#pragma once

#include <iosfwd>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lsp/document.hpp"
#include "lsp/insight.hpp"

namespace hysteron::lsp {

class Server {
 public:
  explicit Server(Card card) : card_(std::move(card)) {}

  /// Answers one message: the responses and notifications that it causes, in their order. Never throws for what a
  /// client sends: a fault of the message is an error of JSON-RPC.
  [[nodiscard]] std::vector<nlohmann::json> handle(const nlohmann::json& message);

  [[nodiscard]] bool has_exited() const { return exited_; }
  [[nodiscard]] bool was_shut_down() const { return shut_down_; }

 private:
  struct Document {
    std::string text;
    std::shared_ptr<const language::SourceFile> tree;
    std::shared_ptr<const language::SourceFile> known;  ///< the tree of the last text without a syntax error
    nlohmann::json diagnostics;                         ///< as published, each with the word that mends it as `data`
  };

  nlohmann::json request(const std::string& method, const nlohmann::json& params);
  std::vector<nlohmann::json> notification(const std::string& method, const nlohmann::json& params);
  nlohmann::json initialize(const nlohmann::json& params);
  nlohmann::json format(const nlohmann::json& params);
  /// Definition, references, rename: what the word at a position names, and its places.
  [[nodiscard]] nlohmann::json named(const std::string& method, const nlohmann::json& params) const;
  /// The words that mend what stands in a range, each as an edit.
  [[nodiscard]] nlohmann::json actions(const nlohmann::json& params) const;
  [[nodiscard]] nlohmann::json outline(const Document& open) const;
  void change(Document& open, const nlohmann::json& change) const;
  nlohmann::json published(const std::string& uri, Document& open) const;
  [[nodiscard]] const Document& document(const nlohmann::json& params) const;
  [[nodiscard]] nlohmann::json range(std::string_view text, std::size_t begin, std::size_t end) const;
  [[nodiscard]] std::pair<std::size_t, std::size_t> offsets(std::string_view text, const nlohmann::json& range) const;

  Card card_;
  Encoding encoding_ = Encoding::Utf16;
  bool initialized_ = false;
  bool shut_down_ = false;
  bool exited_ = false;
  std::map<std::string, Document> documents_;
};

/// Serves a client until it says `exit` or its stream ends. Gives back what the protocol wants as exit code: 0 where
/// `shutdown` came first, else 1. A frame that cannot be read is answered, and reading goes on.
int serve(std::istream& in, std::ostream& out, Card card);

}  // namespace hysteron::lsp
