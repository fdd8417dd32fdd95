# Writes a C++ source with the files of the live page: cmake -D OUTPUT=… -D FILES=target=type=path;… -P embed_assets.cmake
set(arrays "")
set(list "")
set(number 0)
foreach(entry IN LISTS FILES)
  string(REGEX MATCH "^([^=]+)=([^=]+)=(.+)$" whole "${entry}")
  set(target "${CMAKE_MATCH_1}")
  set(type "${CMAKE_MATCH_2}")
  file(READ "${CMAKE_MATCH_3}" bytes HEX)
  string(LENGTH "${bytes}" length)
  math(EXPR length "${length} / 2")
  string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${bytes}")
  string(APPEND arrays "constexpr std::array<char, ${length}> text_${number}{${bytes}};\n")
  string(APPEND list "    {\"${target}\", \"${type}\", {text_${number}.data(), text_${number}.size()}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE "${OUTPUT}" "#include \"runtime/web/assets.hpp\"

#include <array>

namespace hysteron::runtime::web {
namespace {

${arrays}
constexpr std::array<Asset, ${number}> all{{
${list}}};

}  // namespace

std::span<const Asset> assets() {
  return all;
}

}  // namespace hysteron::runtime::web
")
