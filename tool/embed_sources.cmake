# Writes the sources of a generated host into one translation unit, so that the tool carries them: run at build time as
#   cmake -DROOT=… -DRUNTIME=LIST -DSUPPORT=LIST -DDATABASE=LIST -DWEB=LIST -DOUTPUT=FILE.cpp -DDEPFILE=FILE.d
#     -P embed_sources.cmake
#
# RUNTIME, SUPPORT, DATABASE and WEB name files with the sources of these targets, a line each. The rooms of the runtime
# that a host needs go in whole, with every header that they include; of the others, what they include and the source
# beside it. What the live page needs besides is a list of its own.
cmake_policy(VERSION 3.25)
set(rooms "^runtime/(config|history|host|modbus|mqtt|task)/")

# The sources of a target, relative to the root.
function(read_list file folder result)
  file(STRINGS ${file} lines)
  foreach(line ${lines})
    cmake_path(ABSOLUTE_PATH line BASE_DIRECTORY ${ROOT}/${folder} NORMALIZE)
    cmake_path(RELATIVE_PATH line BASE_DIRECTORY ${ROOT})
    list(APPEND found ${line})
  endforeach()
  set(${result} ${found} PARENT_SCOPE)
endfunction()

read_list(${RUNTIME} runtime waiting)
read_list(${SUPPORT} support below)
read_list(${DATABASE} database of_database)
list(APPEND below ${of_database})
list(FILTER waiting INCLUDE REGEX ${rooms})
# What the generated main includes besides.
list(APPEND waiting LICENSE runtime/host/host_program.hpp runtime/task/linked_program.hpp)

# All that these files include, and themselves.
function(close_over waiting result)
  set(files "")
  while(waiting)
    list(POP_FRONT waiting file)
    if(file IN_LIST files)
      continue()
    endif()
    list(APPEND files ${file})
    file(STRINGS ${ROOT}/${file} includes REGEX "^#include \"")
    foreach(include ${includes})
      string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" include "${include}")
      list(APPEND waiting ${include})
      string(REGEX REPLACE "\\.hpp$" ".cpp" source ${include})
      if(source IN_LIST below)
        list(APPEND waiting ${source})
      endif()
    endforeach()
  endwhile()
  list(SORT files)
  set(${result} ${files} PARENT_SCOPE)
endfunction()

close_over("${waiting}" host)
read_list(${WEB} runtime/web of_web)
list(FILTER of_web INCLUDE REGEX "^runtime/web/")  # its assets are generated
close_over("${of_web};runtime/web/assets.hpp;runtime/web/serve_page.hpp" page)
list(REMOVE_ITEM page ${host})

set(text "// The sources of a generated host, written by embed_sources.cmake.\n#include \"tool/host_sources.hpp\"\n\n")
# With their lengths, as literals of ""sv: to count a megabyte of characters is more than a compiler does by itself.
string(APPEND text "#include <array>\n\nnamespace hysteron::tool {\nnamespace {\n\nusing namespace std::string_view_literals;\n")
set(depends "")
foreach(list host page)
  string(APPEND text "\nconstexpr std::array ${list}_files{\n")
  foreach(file ${${list}})
    file(READ ${ROOT}/${file} source)
    string(APPEND text "    EmbeddedSource{\"${file}\", R\"embedded(${source})embedded\"sv},\n")
    string(APPEND depends " \\\n  ${ROOT}/${file}")
  endforeach()
  string(APPEND text "};\n")
endforeach()
string(APPEND text "\n}  // namespace\n")
foreach(list host page)
  string(APPEND text "\nstd::span<const EmbeddedSource> ${list}_sources() {\n  return ${list}_files;\n}\n")
endforeach()
string(APPEND text "\n}  // namespace hysteron::tool\n")
file(WRITE ${OUTPUT} "${text}")
file(WRITE ${DEPFILE} "${OUTPUT}:${depends}\n")
