#include "codegen/backends/cpp_host.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "codegen/backends/cpp_words.hpp"
#include "codegen/backends/identifiers.hpp"

namespace hysteron {
namespace {

constexpr std::string_view main_text = R"(// Runs the step of {name}.hpp over a record: `{name}_run < in.csv > out.csv`.
//
// The first line of the record names the columns; `t` is seconds, the others are matched to the inputs without regard
// to case. An input without a column keeps its default.
#include <cctype>
#include <charconv>
#include <cstdio>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include "{name}.hpp"

namespace {{

std::vector<std::string_view> split(std::string_view line) {{
  if (line.ends_with('\r')) {{
    line.remove_suffix(1);
  }}
  std::vector<std::string_view> cells;
  for (;;) {{
    const auto comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) {{
      return cells;
    }}
    line.remove_prefix(comma + 1);
  }}
}}

std::string lower(std::string_view text) {{
  std::string result(text);
  for (char& letter : result) {{
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  }}
  return result;
}}

template <class T>
void append(std::string& line, T value) {{
  char digits[64];
  const auto end = std::to_chars(digits, digits + sizeof(digits), value).ptr;
  line.append(digits, end);
}}

}}  // namespace

int main() {{
  std::ios::sync_with_stdio(false);
  std::string line;
  if (!std::getline(std::cin, line)) {{
    std::fputs("no record on standard input\n", stderr);
    return 2;
  }}
  std::vector<std::string> names;
  for (const auto cell : split(line)) {{
    names.push_back(lower(cell));
  }}
  {name}::Params params;
  {name}::State state;
  {name}::In in;
  {name}::reset(params, state);
  std::cout << "t{header}\n";
  for (long row = 2; std::getline(std::cin, line); ++row) {{
    const auto cells = split(line);
    if (cells.size() != names.size()) {{
      std::fprintf(stderr, "line %ld: %zu columns, the header has %zu\n", row, cells.size(), names.size());
      return 2;
    }}
    double t = 0.0;
    for (std::size_t i = 0; i < cells.size(); ++i) {{
      double value = 0.0;
      const auto [end, problem] = std::from_chars(cells[i].data(), cells[i].data() + cells[i].size(), value);
      if (problem != std::errc{{}} || end != cells[i].data() + cells[i].size()) {{
        std::fprintf(stderr, "line %ld, column %s: not a number\n", row, names[i].c_str());
        return 2;
      }}
      if (names[i] == "t") {{
        t = value;
      }}
{inputs}    }}
    const auto out = {name}::step(params, state, in);
    line.clear();
    append(line, t);
{outputs}    std::cout << line << '\n';
  }}
  return 0;
}}
)";

constexpr std::string_view cmake_text = R"(cmake_minimum_required(VERSION 3.16)
project({name} LANGUAGES CXX)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# A fused multiply-add, a reordered sum, or a function of constants that the compiler rounds in its own way would change
# the bits that the diagram defines.
add_compile_options(-Wall -Wextra {flags})
add_executable({name}_run main.cpp)
)";

}  // namespace

std::vector<std::string> cpp_port_names(const std::vector<Port>& ports) {
  Identifiers identifiers(cpp_words);
  std::vector<std::string> names;
  for (const Port& port : ports) {
    names.push_back(identifiers.make(port.name));
  }
  return names;
}

GeneratedFile cpp_host_main(const Program& program) {
  const Graph& graph = program.graph;
  std::string inputs;
  const auto input_names = cpp_port_names(graph.inputs);
  for (std::size_t i = 0; i < graph.inputs.size(); ++i) {
    const std::string& name = input_names[i];
    std::string column = graph.inputs[i].name;
    std::ranges::transform(column, column.begin(),
                           [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    inputs += fmt::format(
        "      if (names[i] == \"{}\") {{\n        in.{} = {};\n      }}\n", column, name,
        graph.inputs[i].type == Type::Bool ? "value != 0.0" : fmt::format("static_cast<decltype(in.{})>(value)", name));
  }
  std::string outputs;
  std::string header;
  const auto output_names = cpp_port_names(graph.outputs);
  for (std::size_t i = 0; i < graph.outputs.size(); ++i) {
    header += "," + graph.outputs[i].name;
    outputs += fmt::format("    line += ',';\n    append(line, out.{}{});\n", output_names[i],
                           graph.outputs[i].type == Type::Bool ? " ? 1 : 0" : "");
  }
  return {"main.cpp",
          fmt::format(fmt::runtime(main_text), fmt::arg("name", lower_identifier(graph.name)),
                      fmt::arg("inputs", inputs), fmt::arg("outputs", outputs), fmt::arg("header", header))};
}

GeneratedFile cpp_host_cmake(const Program& program) {
  return {"CMakeLists.txt",
          fmt::format(fmt::runtime(cmake_text), fmt::arg("name", lower_identifier(program.graph.name)),
                      fmt::arg("flags", cpp_numeric_flags))};
}

}  // namespace hysteron
