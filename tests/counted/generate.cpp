// Writes the headers of a diagram, of one instance and of a batch: `generate_step FILE.st FOLDER`. It is apart from the tool, so that what is built from
// generated code at build time needs codegen alone.
#include <fstream>
#include <iostream>

#include "codegen/backends/batch/batch.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "support/render.hpp"

int main(int count, char** arguments) {
  if (count != 3) {
    std::cerr << "usage: generate_step FILE.st FOLDER\n";
    return 2;
  }
  try {
    hysteron::Diagnostics warnings;
    const auto program = hysteron::compile_file(arguments[1], {}, warnings);
    for (const auto& header : {hysteron::generate_cpp_header(program), hysteron::generate_batch(program)}) {
      std::ofstream file(std::string(arguments[2]) + "/" + header.name, std::ios::binary);
      file << header.text;
      file.close();
      if (!file) {
        return 1;
      }
    }
    return 0;
  } catch (const hysteron::InputError& problem) {
    std::cerr << problem.what() << '\n';
    return 1;
  }
}
