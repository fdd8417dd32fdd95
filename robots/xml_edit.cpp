#include "robots/xml_edit.hpp"

#include <algorithm>

namespace hysteron::robots {
namespace {

constexpr std::string_view blanks = " \t\r\n";

bool is_blank(char c) {
  return blanks.find(c) != std::string_view::npos;
}

}  // namespace

XmlEdit::Tag XmlEdit::tag_at(std::size_t name_at) const {
  Tag tag;
  std::size_t i = name_at;
  while (i < text_.size() && !is_blank(text_[i]) && text_[i] != '>' && text_[i] != '/') {
    ++i;
  }
  tag.name_end = tag.end = i;
  while (i < text_.size() && text_[i] != '>') {
    if (is_blank(text_[i]) || text_[i] == '/') {
      tag.is_empty = text_[i] == '/';
      ++i;
      continue;
    }
    const std::size_t name = i;
    while (i < text_.size() && !is_blank(text_[i]) && text_[i] != '=') {
      ++i;
    }
    const std::string attribute(text_.substr(name, i - name));
    const std::size_t quote = std::min(text_.find_first_of("\"'", i), text_.size() - 1);
    const std::size_t close = std::min(text_.find(text_[quote], quote + 1), text_.size() - 1);
    tag.values[attribute] = {quote + 1, close - quote - 1};
    i = tag.end = close + 1;
    tag.is_empty = false;
  }
  return tag;
}

std::string XmlEdit::indent_of(std::size_t at) const {
  const std::size_t line = text_.rfind('\n', at) == std::string_view::npos ? 0 : text_.rfind('\n', at) + 1;
  const std::size_t end = std::min(text_.find_first_not_of(" \t", line), text_.size());
  return std::string(text_.substr(line, end - line));
}

void XmlEdit::insert(std::size_t at, const std::string& text) {
  edits_.push_back({.at = at, .put = text});
}

void XmlEdit::set(std::size_t name_at, const std::string& attribute, const std::string& value) {
  const Tag tag = tag_at(name_at);
  const auto known = tag.values.find(attribute);
  if (known == tag.values.end()) {
    insert(tag.end, " " + attribute + "=\"" + value + "\"");
  } else {
    edits_.push_back({.at = known->second.first, .removed = known->second.second, .put = value});
  }
}

void XmlEdit::add_children(std::size_t name_at, const std::vector<std::string>& children) {
  const Tag tag = tag_at(name_at);
  const std::string indent = indent_of(name_at);
  std::string lines;
  for (const std::string& child : children) {
    lines.append("\n").append(indent).append("  ").append(child);
  }
  if (tag.is_empty) {
    const std::size_t slash = text_.find('/', tag.end);
    const std::string name(text_.substr(name_at, tag.name_end - name_at));
    edits_.push_back({.at = slash, .removed = 2, .put = ">" + lines + "\n" + indent + "</" + name + ">"});
  } else {
    insert(text_.find('>', tag.end) + 1, lines);
  }
}

std::string XmlEdit::text() const {
  std::vector<Edit> edits = edits_;
  std::ranges::stable_sort(edits, {}, &Edit::at);
  std::string result;
  std::size_t at = 0;
  for (const Edit& edit : edits) {
    result += text_.substr(at, edit.at - at);
    result += edit.put;
    at = edit.at + edit.removed;
  }
  result += text_.substr(at);
  return result;
}

}  // namespace hysteron::robots
