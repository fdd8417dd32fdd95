#include "tool/proof_page.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "plots/page.hpp"
#include "support/markup.hpp"

namespace hysteron::tool {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view proof_page_style = R"(.hash { font-family: monospace; overflow-wrap: anywhere; }
table.facts th { text-align: left; font-weight: normal; padding-right: 1.2rem; vertical-align: top; }
table.schedule td, table.schedule th { text-align: left; padding: .1rem .9rem .1rem 0; }
.sign { display: grid; grid-template-columns: repeat(auto-fit, minmax(11rem, 1fr)); gap: 1.2rem; margin-top: 2.6rem; }
.sign div { border-top: 1px solid currentColor; padding-top: .2rem; min-height: 1.6rem; }
pre { white-space: pre-wrap; overflow-wrap: anywhere; }
@media (max-width: 700px) { table.facts, table.facts tbody { display: block; overflow-x: visible; }
  table.facts tr { display: block; margin-bottom: .4rem; } table.facts th, table.facts td { display: block; } table.facts th { border: 0; } }
@media print { section { break-inside: avoid-page; } section.long { break-inside: auto; } tr { break-inside: avoid; } }
)";

using Fact = std::pair<std::string, std::string>;

/// A fact a line, in HTML.
std::string facts(const std::vector<Fact>& rows) {
  std::string html = "<table class=\"facts\">\n";
  for (const auto& [name, value] : rows) {
    html += value.empty() ? "" : fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", name, value);
  }
  return html + "</table>\n";
}

std::string value_html(const Json& value) {
  return escaped(value.is_string() ? value.get<std::string>() : value.dump());
}

std::string hash_html(const std::string& digits) {
  return fmt::format("<span class=\"hash\">{}</span>", escaped(digits));
}

/// A file with its hash; empty where there is none.
std::string file_html(const Json& file) {
  return file.is_null() ? std::string() : fmt::format("{}<br/>{}", value_html(file["file"]), hash_html(file["sha256"]));
}

std::string verdict_html(const Json& sheet) {
  const Json& equality = sheet["equality"];
  const std::string bits = equality["bits"];
  const std::string where = fmt::format("{}, {}: its outputs against those of {}", value_html(sheet["language"]),
                                        value_html(equality["run"]), value_html(equality["against"]));
  if (bits == "equal") {
    return fmt::format(
        "<section class=\"verdict\">\n<p class=\"summary\">Equal bits in all {} steps, at {} {}.</p>\n<p>{}.</p>\n"
        "</section>\n",
        value_html(equality["steps"]), value_html(equality["outputs"]), equality["outputs"] == 1 ? "output" : "outputs",
        where);
  }
  return fmt::format("<div class=\"box refusals\"><h2>{}</h2>\n<p>{}. {}.</p></div>\n",
                     bits == "different" ? "Other bits" : "Not run: nothing is proved", value_html(equality["fault"]),
                     where);
}

std::string schedule_html(const Json& schedule) {
  if (schedule.empty()) {
    return "<p>The diagram has no blocks: its step is one expression for each output.</p>\n";
  }
  std::string html =
      "<table class=\"schedule\">\n<thead><tr><th></th><th>block</th><th>type</th><th>does</th><th>in the "
      "steps</th></tr></thead>\n";
  std::size_t place = 0;
  for (const Json& one : schedule) {
    const bool each = one["every"] == 1;
    html += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", ++place, value_html(one["block"]),
        value_html(one["type"]), value_html(one["action"]),
        each ? std::string("all") : fmt::format("k mod {} = {}", value_html(one["every"]), value_html(one["phase"])));
  }
  return html + "</table>\n";
}

/// A bound as it is read by a person.
std::string range_html(const Json& one) {
  const auto end = [](const Json& value, std::string_view open) {
    return value.is_null() ? std::string(open) : fmt::format("{:.6g}", value.get<double>());
  };
  const std::string unit = one["unit"].get<std::string>();
  const std::string range = one["low"].is_null() && one["high"].is_null()
                                ? std::string("no bound")
                                : fmt::format("{} … {}{}", end(one["low"], "−∞"), end(one["high"], "∞"),
                                              unit.empty() ? "" : " " + escaped(unit));
  return range + (one["always_finite"].get<bool>() ? "" : "; not proved finite");
}

std::string bounds_html(const Json& bounds) {
  std::vector<Fact> rows;
  for (const Json& one : bounds) {
    rows.emplace_back(value_html(one["output"]), range_html(one));
  }
  return "<p>Proved by interval arithmetic, for every input within its stated range, in every step, with these "
         "parameters. An input without a range is any number.</p>\n" +
         facts(rows);
}

std::string files_html(const Json& files) {
  std::vector<Fact> rows;
  for (const Json& one : files) {
    rows.emplace_back(value_html(one["file"]),
                      fmt::format("{} bytes<br/>{}", value_html(one["bytes"]), hash_html(one["sha256"])));
  }
  return facts(rows);
}

}  // namespace

std::string proof_page(const Json& sheet) {
  const auto section = [](std::string_view title, const std::string& html, std::string_view kind = "") {
    return fmt::format("<section{}><h2>{}</h2>\n{}</section>\n", kind, title, html);
  };
  const Json& stack = sheet["stack_bytes"];
  std::string body = verdict_html(sheet);
  body += section("What it is",
                  facts({{"diagram", value_html(sheet["diagram"])},
                         {"source", file_html(sheet["source"])},
                         {"parameters", file_html(sheet["parameters"])},
                         {"hash of diagram and parameters", hash_html(sheet["hash_of_diagram_and_parameters"])},
                         {"language", value_html(sheet["language"])},
                         {"generator", fmt::format("{}<br/>{}", value_html(sheet["generator"]),
                                                   hash_html(sheet["generator_sha256"]))},
                         {"sample time", fmt::format("{} ms", sheet["sample_time_ns"].get<double>() / 1e6)}}));
  body += section(
      "What a step costs",
      facts({{"real numbers", value_html(sheet["real"])},
             {"state", fmt::format("{} bytes", value_html(sheet["state_bytes"]))},
             {"parameters", fmt::format("{} bytes", value_html(sheet["parameter_bytes"]))},
             {"stack", stack.is_null() ? std::string()
                                       : fmt::format("{} bytes at most, without the C library; {}",
                                                     value_html(stack["bytes"]), value_html(stack["measured"]))},
             {"operations",
              fmt::format("{} in the longest step, with all rates in it; {} of them call a function",
                          value_html(sheet["operations_per_step"]), value_html(sheet["function_calls_per_step"]))},
             {"paths", "one: both values of a choice may be computed, and loops have constant bounds"}}));
  body += section("Bounds of the outputs", bounds_html(sheet["bounds"]));
  body += section("Files", files_html(sheet["files"]));
  body += section("Schedule", schedule_html(sheet["schedule"]), " class=\"long\"");
  body += section("Repeat it",
                  fmt::format("<p>This command makes the files and this sheet again, from the same source:</p>\n"
                              "<pre>{}</pre>\n<p>What is not proved here: that the compiler of the target "
                              "rounds as this machine does, and that no value on the way to an output is "
                              "infinite.</p>\n",
                              value_html(sheet["command"])));
  body +=
      "<section><h2>Signed</h2>\n<div "
      "class=\"sign\"><div>name</div><div>date</div><div>signature</div></div></section>\n";
  return plots::page_text(
      {.title = fmt::format("Hysteron: proof sheet of {} in {}", sheet["diagram"].get<std::string>(),
                            sheet["language"].get<std::string>()),
       .style = std::string(proof_page_style),
       .body = body});
}

}  // namespace hysteron::tool
