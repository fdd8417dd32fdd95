#include "codegen/parameters/toml_comments.hpp"

#include <algorithm>
#include <cstdint>
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
};

/// The place of the quote that ends a text which begins at `at`; `at` itself where none begins there.
std::size_t end_of_quoted(std::string_view code, std::size_t at) {
  const char quote = code[at];
  if (quote != '"' && quote != '\'') {
    return at;
  }
  for (++at; at < code.size() && code[at] != quote; ++at) {
    at += code[at] == '\\' && quote == '"' ? 1 : 0;
  }
  return at;
}

Line cut(std::string_view text) {
  Line line{.code = trimmed(text, blanks)};
  for (std::size_t i = 0; i < text.size(); ++i) {
    i = end_of_quoted(text, i);
    if (i < text.size() && text[i] == '#') {
      line.code = trimmed(text.substr(0, i), blanks);
      line.comment = trimmed(text.substr(i), blanks);
      break;
    }
  }
  return line;
}

/// Where in a value the reading stands: how deep in brackets, and behind how many elements of the outermost list.
class ValueDepth {
 public:
  void follow(std::string_view code) {
    for (std::size_t i = 0; i < code.size(); ++i) {
      const char c = code[i];
      if (c == ']' || c == '}') {
        --depth_;
      } else if (c == ',') {
        is_in_element_ = is_in_element_ && depth_ > 1;
      } else if (blanks.find(c) == std::string_view::npos) {
        begin_element();
        depth_ += c == '[' || c == '{' ? 1 : 0;
        i = end_of_quoted(code, i);
      }
    }
  }
  [[nodiscard]] bool is_open() const { return depth_ > 0; }
  [[nodiscard]] std::uint32_t elements() const { return elements_; }

 private:
  void begin_element() {
    if (depth_ == 1 && !is_in_element_) {
      is_in_element_ = true;
      ++elements_;
    }
  }

  int depth_ = 0;
  std::uint32_t elements_ = 0;
  bool is_in_element_ = false;
};

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
    if (value_.is_open()) {  // a list over several lines
      value_.follow(line.code);
      add_pending(line.comment);
      flush(line.code.empty()  ? Comment::Where::InList
            : value_.is_open() ? Comment::Where::BesideElement
                               : Comment::Where::Beside,
            key_);
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
      value_ = {};
      value_.follow(line.code.substr(std::min(line.code.find('='), line.code.size() - 1) + 1));
    }
    flush(Comment::Where::Above, key_);
    add_pending(line.comment);
    flush(value_.is_open() ? Comment::Where::BesideElement : Comment::Where::Beside, key_);
  }

  void add_pending(std::string_view comment) {
    if (!comment.empty()) {
      pending_ += (pending_.empty() ? "" : "\n") + std::string(comment);
    }
  }

  void flush(Comment::Where where, const std::string& key) {
    if (!pending_.empty()) {
      comments_.push_back(
          {.where = where, .element = value_.elements(), .key = key, .text = std::exchange(pending_, {})});
    }
  }

  std::vector<Comment> comments_;
  std::string pending_;
  std::string table_;
  std::string key_;     ///< of the line before; empty above the first
  ValueDepth value_{};  ///< of that key
};

}  // namespace

std::vector<Comment> comments_of(std::string_view text) {
  if (text.starts_with(byte_order_mark)) {
    text.remove_prefix(byte_order_mark.size());
  }
  return Scanner().scan(text);
}

}  // namespace hysteron::parameters
