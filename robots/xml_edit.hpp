// Attributes of an XML text that are set without touching anything else of it.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hysteron::robots {

/// A text with edits that are made together at the end: the places are those of the text as it came.
class XmlEdit {
 public:
  explicit XmlEdit(std::string_view text) : text_(text) {}

  /// Sets an attribute of the element whose name stands at `name_at`; puts it behind the others where it is new.
  void set(std::size_t name_at, const std::string& attribute, const std::string& value);
  /// Puts children in as the first of an element, each with a line and an indent of its own. Once for an element.
  void add_children(std::size_t name_at, const std::vector<std::string>& children);
  [[nodiscard]] std::string text() const;

 private:
  struct Tag {
    std::size_t name_end = 0;
    std::size_t end = 0;                                                  ///< of what stands in the tag: before > or />
    bool is_empty = false;                                                ///< ends with />
    std::map<std::string, std::pair<std::size_t, std::size_t>> values{};  ///< place and length, without the quotes
  };
  [[nodiscard]] Tag tag_at(std::size_t name_at) const;
  /// Puts text in at a place, behind what was put there before.
  void insert(std::size_t at, const std::string& text);
  /// The blanks that the line of a place begins with.
  [[nodiscard]] std::string indent_of(std::size_t at) const;

  struct Edit {
    std::size_t at = 0;
    std::size_t removed = 0;
    std::string put{};
  };
  std::string_view text_;
  std::vector<Edit> edits_{};
};

}  // namespace hysteron::robots
