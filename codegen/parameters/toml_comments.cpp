#include "codegen/parameters/toml_comments.hpp"

#include <string>
#include <utility>

#include "support/byte_order_mark.hpp"
#include "support/names.hpp"
#include "support/trimmed.hpp"

namespace hysteron::parameters {
namespace {

constexpr std::string_view blanks = " \t\r";

struct Line {
  std::string_view code{};
  std::string_view comment{};  ///< from its # on; empty where there is none
  int opened = 0;              ///< brackets that the code opens and does not close
};

Line cut(std::string_view text) {
  Line line{.code = trimmed(text, blanks)};
  char quote = '\0';
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != '\0') {
      i += c == '\\' && quote == '"' ? 1 : 0;
      quote = c == quote ? '\0' : quote;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '#') {
      line.code = trimmed(text.substr(0, i), blanks);
      line.comment = trimmed(text.substr(i), blanks);
      break;
    } else {
      line.opened += c == '[' || c == '{' ? 1 : (c == ']' || c == '}' ? -1 : 0);
    }
  }
  return line;
}

/// `fit . "inv".c1` as FIT.INV.C1.
std::string plain_key(std::string_view written) {
  std::string key;
  for (const char c : written) {
    if (std::string_view(" \t\"'[]").find(c) == std::string_view::npos) {
      key += c;
    }
  }
  return in_capitals(key);
}

class Scanner {
 public:
  std::vector<Comment> scan(std::string_view text) {
    while (!text.empty()) {
      const auto end = text.find('\n');
      take(cut(text.substr(0, end)));
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    flush(key_.empty() ? Comment::Where::Head : Comment::Where::End, {});
    return std::move(comments_);
  }

 private:
  void take(const Line& line) {
    if (depth_ > 0) {  // inside a list over several lines
      add_pending(line.comment);
      flush(Comment::Where::Above, key_);
      depth_ += line.opened;
      return;
    }
    if (line.code.empty()) {
      add_pending(line.comment);
      if (line.comment.empty() && key_.empty()) {
        flush(Comment::Where::Head, {});
      }
      return;
    }
    if (line.code.front() == '[') {
      table_ = plain_key(line.code);
      key_ = table_;
    } else {
      key_ = (table_.empty() ? table_ : table_ + ".") + plain_key(line.code.substr(0, line.code.find('=')));
      depth_ = line.opened;
    }
    flush(Comment::Where::Above, key_);
    add_pending(line.comment);
    flush(Comment::Where::Beside, key_);
  }

  void add_pending(std::string_view comment) {
    if (!comment.empty()) {
      pending_ += (pending_.empty() ? "" : "\n") + std::string(comment);
    }
  }

  void flush(Comment::Where where, const std::string& key) {
    if (!pending_.empty()) {
      comments_.push_back({.where = where, .key = key, .text = std::exchange(pending_, {})});
    }
  }

  std::vector<Comment> comments_;
  std::string pending_;
  std::string table_;
  std::string key_;  ///< of the line before; empty above the first
  int depth_ = 0;
};

}  // namespace

std::vector<Comment> comments_of(std::string_view text) {
  if (text.starts_with(byte_order_mark)) {
    text.remove_prefix(byte_order_mark.size());
  }
  return Scanner().scan(text);
}

}  // namespace hysteron::parameters
