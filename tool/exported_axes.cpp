#include "tool/exported_axes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "tool/option_values.hpp"

namespace hysteron::tool {
namespace {

struct NamedValue {
  std::string name{};  ///< empty: for every joint
  std::string value{};
};

InputError refusal(std::string cause, std::string mend) {
  return {error::bad_usage, {}, std::move(cause), std::move(mend)};
}

/// `elbow=50`, where elbow is a joint, or has to be one.
NamedValue named_value(const std::string& text, const std::vector<ExportedAxis>& axes, const char* option,
                       bool is_file) {
  const auto equals = text.find('=');
  if (equals == std::string::npos) {
    return {.value = text};
  }
  const std::string name = text.substr(0, equals);
  if (std::ranges::find(axes, name, &ExportedAxis::joint) != axes.end()) {
    return {.name = name, .value = text.substr(equals + 1)};
  }
  if (is_file) {
    return {.value = text};  // a name of a file may have the sign
  }
  std::vector<std::string> joints;
  for (const ExportedAxis& one : axes) {
    joints.push_back(one.joint);
  }
  throw refusal(fmt::format("{} {}: no --joint is called {}.", option, text, name),
                fmt::format("the joints are {}: write {} {}={}, or the value alone for all of them.",
                            fmt::join(joints, ", "), option, joints.front(), text.substr(equals + 1)));
}

/// Sets a value of each axis that it is for. What a name states counts before what is stated for all.
template <class Set>
void set_each(const std::vector<std::string>& texts, std::vector<ExportedAxis>& axes, const char* option, bool is_file,
              const Set& set) {
  std::vector<NamedValue> values;
  for (const std::string& text : texts) {
    NamedValue value = named_value(text, axes, option, is_file);
    if (std::ranges::find(values, value.name, &NamedValue::name) != values.end()) {
      throw refusal(
          fmt::format("{} is stated twice{}.", option, value.name.empty() ? "" : " for " + value.name),
          fmt::format("state it once for all joints, or once for each: {} {}=….", option, axes.front().joint));
    }
    values.push_back(std::move(value));
  }
  std::stable_partition(values.begin(), values.end(), [](const NamedValue& one) { return one.name.empty(); });
  for (const NamedValue& value : values) {
    for (ExportedAxis& axis : axes) {
      if (value.name.empty() || value.name == axis.joint) {
        set(axis, value.value);
      }
    }
  }
}

double checked_number(const std::string& text, const char* option, const CLI::Validator& check) {
  if (const std::string fault = check(text); !fault.empty()) {
    throw refusal(fmt::format("{}: {}.", option, fault),
                  fmt::format("write {0} 2.5, or {0} JOINT=2.5 for one joint of several.", option));
  }
  return parse_number(text).value;
}

}  // namespace

std::vector<ExportedAxis> exported_axes(const AxisTexts& texts) {
  std::vector<ExportedAxis> axes;
  bool is_common_used = texts.joints.empty();
  for (const std::string& text : texts.joints) {
    const auto equals = text.find('=');
    ExportedAxis axis{.joint = text.substr(0, equals)};
    if (axis.joint.empty() || equals == text.size() - 1) {
      throw refusal(fmt::format("--joint \"{}\" names no {}.", text, axis.joint.empty() ? "joint" : "file"),
                    "write --joint elbow, or --joint elbow=elbow.toml with the file of its parameters.");
    }
    if (std::ranges::find(axes, axis.joint, &ExportedAxis::joint) != axes.end()) {
      throw refusal(fmt::format("--joint {} is stated twice.", axis.joint), "state each joint once.");
    }
    axis.parameters = equals == std::string::npos ? texts.parameters : text.substr(equals + 1);
    is_common_used = is_common_used || equals == std::string::npos;
    axes.push_back(std::move(axis));
  }
  if (axes.empty()) {
    axes.push_back({.parameters = texts.parameters});
  }
  if (!texts.parameters.empty() && !is_common_used) {
    throw refusal(fmt::format("--params {} is of no joint: each --joint states a file of its own.", texts.parameters),
                  "leave --params out, or leave the file out of the joint that it is for.");
  }
  set_each(texts.gears, axes, "--gear", false, [](ExportedAxis& axis, const std::string& text) {
    axis.gear = checked_number(text, "--gear", number_above_zero());
  });
  set_each(texts.link_inertias, axes, "--link-inertia", false, [](ExportedAxis& axis, const std::string& text) {
    axis.link_inertia = checked_number(text, "--link-inertia", number_from_zero());
  });
  set_each(texts.records, axes, "--in", true, [](ExportedAxis& axis, const std::string& text) { axis.record = text; });
  return axes;
}

}  // namespace hysteron::tool
