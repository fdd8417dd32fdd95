#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "support/errors.hpp"
#include "support/text_file.hpp"
#include "tool/comparison.hpp"

namespace hysteron::tool {
namespace {

using Json = nlohmann::json;

Json read_verdict(const std::string& file) {
  Json json = Json::parse(read_text_file(file), nullptr, false);
  if (!json.is_object() || json.value("schema", "") != "hysteron-verdict/1") {
    throw InputError(error::bad_usage, {.file = file}, fmt::format("{} is no verdict that can be read.", file),
                     "give the verdict.json that `hysteron diagnose` writes into the folder of --out.");
  }
  return json;
}

/// The value at a path; null where there is none.
Json at(const Json& json, const char* path) {
  const Json::json_pointer pointer(path);
  return json.contains(pointer) ? json.at(pointer) : Json();
}

/// The effects with their places, in one text.
Json effects_of(const Json& verdict, const char* key) {
  std::string text;
  for (const Json& effect : verdict.value("effects", Json::array())) {
    text += (text.empty() ? "" : ", ") + effect.value(key, std::string());
  }
  return text;
}

std::string text_of(const Json& value) {
  if (value.is_null() || value == "") {
    return "–";
  }
  if (value.is_number()) {
    return fmt::format("{:.4g}", value.get<double>());
  }
  return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

Comparison compare_verdicts(const std::string& a, const std::string& b, const Tolerance& tolerance) {
  const Json one = read_verdict(a);
  const Json other = read_verdict(b);
  struct Field {
    const char* name;
    Json a;
    Json b;
  };
  const auto field = [&](const char* name, const char* path) { return Field{name, at(one, path), at(other, path)}; };
  const std::vector<Field> fields{field("verdict", "/verdict"),
                                  field("family", "/families/0/family"),
                                  field("probability of the family", "/families/0/probability"),
                                  {"effects", effects_of(one, "id"), effects_of(other, "id")},
                                  {"places", effects_of(one, "edge"), effects_of(other, "edge")},
                                  field("confidence", "/confidence"),
                                  field("signal", "/gap/signal"),
                                  field("gap before, RMS", "/gap/nominal_rms"),
                                  field("gap left, RMS", "/gap/improved_rms"),
                                  field("share closed", "/gap/closed")};
  Comparison result;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Field& one_field : fields) {
    const bool numbers = one_field.a.is_number() && one_field.b.is_number();
    const bool is_same =
        numbers ? tolerance.holds(one_field.a.get<double>(), one_field.b.get<double>()) : one_field.a == one_field.b;
    list.push_back({{"name", one_field.name}, {"a", one_field.a}, {"b", one_field.b}, {"same", is_same}});
    result.same = result.same && is_same;
    result.text +=
        is_same ? fmt::format("{}: {}\n", one_field.name, text_of(one_field.a))
                : fmt::format(
                      "{}: {} -> {}{}\n", one_field.name, text_of(one_field.a), text_of(one_field.b),
                      numbers ? fmt::format("  ({})", change_text(one_field.a.get<double>(), one_field.b.get<double>()))
                              : "");
  }
  result.json["fields"] = std::move(list);
  return result;
}

}  // namespace hysteron::tool
