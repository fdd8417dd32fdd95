// The label of a block's box: its name, its type and settings, the pins at both sides, and what a body does.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hysteron::dot {

/// A name with its unit, for a label.
std::string with_unit(std::string_view name, std::string_view unit);

/// What wires call the pins of a box.
std::string pin_port(std::string_view name);
std::string output_port(std::string_view name);

class BoxLabel {
 public:
  BoxLabel(std::string_view name, std::string_view type, std::vector<std::string> settings)
      : name_(name), type_(type), settings_(std::move(settings)) {}

  void add_input(std::string_view name, std::string_view unit);
  void add_output(std::string_view name, std::string_view unit);
  /// Statements, as body_text gives them.
  void add_body(std::string text) { body_ = std::move(text); }

  [[nodiscard]] std::string text() const;

 private:
  std::string_view name_;
  std::string_view type_;
  std::vector<std::string> settings_;
  std::vector<std::string> left_;
  std::vector<std::string> right_;
  std::string body_;
};

}  // namespace hysteron::dot
