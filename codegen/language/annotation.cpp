#include "codegen/language/annotation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "support/errors.hpp"

namespace hysteron::language {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v';
}
bool is_key_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_key_character(char c) {
  return is_key_letter(c) || (c >= '0' && c <= '9');
}

constexpr std::array keys{AnnotationKey{"unit", "the unit, as @unit um or @unit N*m"},
                          AnnotationKey{"min", "the least value"},
                          AnnotationKey{"max", "the largest value"},
                          AnnotationKey{"param", "the input is a parameter"},
                          AnnotationKey{"doc", "what it means"},
                          AnnotationKey{"role", "what a parameter is for, where its unit does not tell"},
                          AnnotationKey{"ts", "the sample time of the block, as @ts 1ms"},
                          AnnotationKey{"body", "the statements of the block are executed in their order"},
                          AnnotationKey{"every", "the instance runs in each n-th step alone"},
                          AnnotationKey{"phase", "the step in which it does"},
                          AnnotationKey{"file", "the FMU that the instance is", true},
                          AnnotationKey{"effect", "the block is an effect of that name"},
                          AnnotationKey{"family", "the family of the effect"},
                          AnnotationKey{"neutral", "the setting at which the effect is none"}};

}  // namespace

std::span<const AnnotationKey> annotation_keys() {
  return keys;
}

std::vector<Annotation> annotations_of(std::string_view text, Span comment) {
  std::vector<Annotation> found;
  const auto inside = text.substr(0, comment.offset + comment.length);
  const auto body_end = inside.ends_with("*)") && comment.length >= 4 ? inside.size() - 2 : inside.size();
  const auto starts_key = [&](std::size_t i) {
    return text[i] == '@' && (i == comment.offset + 2 || is_blank(text[i - 1])) && i + 1 < body_end &&
           is_key_letter(text[i + 1]);
  };
  for (std::size_t i = inside.find('@', comment.offset + 2); i < body_end;) {
    if (!starts_key(i)) {
      i = inside.find('@', i + 1);
      continue;
    }
    const auto start = i++;
    while (i < body_end && is_key_character(text[i])) {
      ++i;
    }
    const auto key = text.substr(start + 1, i - start - 1);
    auto value_start = i;
    while (i < body_end && text[i] != '\n' && !starts_key(i)) {
      ++i;
    }
    auto value_end = i;
    while (value_start < value_end && is_blank(text[value_start])) {
      ++value_start;
    }
    while (value_end > value_start && is_blank(text[value_end - 1])) {
      --value_end;
    }
    const auto span = [](std::size_t from, std::size_t to) {
      return Span{static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(to - from)};
    };
    const bool has_value = value_end > value_start;
    const auto end = has_value ? value_end : start + 1 + key.size();
    found.push_back({key, text.substr(value_start, value_end - value_start), span(start, end),
                     has_value ? span(value_start, value_end) : span(end, end)});
    i = inside.find('@', i);
  }
  return found;
}

bool has_no_key_of_ours(std::string_view text, Span comment) {
  const auto found = annotations_of(text, comment);
  return std::none_of(found.begin(), found.end(), [](const Annotation& one) {
    return std::ranges::any_of(
        keys, [&](const AnnotationKey& key) { return !key.of_diagrams && same_name(key.name, one.key); });
  });
}

void attach_annotations(SourceFile& file, const std::vector<Comment>& comments,
                        const std::vector<Declaration>& declarations, Reporter& reporter) {
  for (const auto& comment : comments) {
    const auto found = annotations_of(*file.text, comment.span);
    if (found.empty()) {
      continue;
    }
    const auto after = std::upper_bound(declarations.begin(), declarations.end(), comment.span.offset,
                                        [](std::uint32_t offset, const Declaration& d) { return offset < d.begin; });
    const Declaration* owner = after == declarations.begin() ? nullptr : &*(after - 1);
    const bool inside = owner != nullptr && comment.span.offset < owner->end;
    const bool behind = owner != nullptr && comment.previous_end == owner->end;
    if (inside || (behind && (owner->is_head || comment.trailing))) {
      auto& block = file.blocks[owner->block];
      if (owner->is_head) {
        block.annotations.insert(block.annotations.end(), found.begin(), found.end());
      }
      for (std::size_t i = 0; i < owner->variable_count; ++i) {
        auto& annotations = block.variables[owner->first_variable + i].annotations;
        annotations.insert(annotations.end(), found.begin(), found.end());
      }
      continue;
    }
    reporter.error(error::stray_annotation, found.front().span,
                   fmt::format("@{} stands beside no declaration.", found.front().key),
                   "Put the comment behind the declaration that it speaks of, on the same line, or behind "
                   "FUNCTION_BLOCK and its name.");
  }
}

bool duration_of(std::string_view text, std::int64_t& nanoseconds) {
  double number = 0.0;
  const auto* end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, number);
  if (problem != std::errc{}) {
    return false;
  }
  std::string_view unit(stop, static_cast<std::size_t>(end - stop));
  while (unit.starts_with(' ')) {
    unit.remove_prefix(1);
  }
  double factor = 0.0;
  for (const auto& [name, scale] :
       {std::pair<std::string_view, double>{"ns", 1.0}, {"us", 1e3}, {"µs", 1e3}, {"ms", 1e6}, {"s", 1e9}}) {
    if (unit == name) {
      factor = scale;
    }
  }
  const double exact = number * factor;
  nanoseconds = factor > 0.0 && exact < 9e18 ? std::llround(exact) : 0;
  return nanoseconds > 0 && std::abs(exact - static_cast<double>(nanoseconds)) < 1e-3;
}

}  // namespace hysteron::language
