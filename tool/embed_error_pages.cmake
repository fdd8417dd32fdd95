# Writes the pages of docs/errors into one translation unit, so that the tool explains its errors where it is installed
# without the documentation:   cmake -DPAGES=docs/errors -DOUTPUT=FILE.cpp -P embed_error_pages.cmake
cmake_policy(VERSION 3.25)
file(GLOB pages ${PAGES}/HY*.md)
list(SORT pages)
set(text "// The pages of docs/errors, written by embed_error_pages.cmake.\n#include \"tool/error_pages.hpp\"\n\n")
string(APPEND text "#include <array>\n\nnamespace hysteron::tool {\nnamespace {\n\nconstexpr std::array pages{\n")
foreach(page ${pages})
  string(REGEX REPLACE ".*/HY([0-9]+)\\.md$" "\\1" number ${page})
  file(READ ${page} source)
  string(APPEND text "    ErrorPage{${number}, R\"embedded(${source})embedded\"},\n")
endforeach()
string(APPEND text "};\n\n}  // namespace\n\nstd::span<const ErrorPage> error_pages() {\n  return pages;\n}\n\n}  // namespace hysteron::tool\n")
file(WRITE ${OUTPUT} "${text}")
