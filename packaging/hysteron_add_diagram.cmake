# hysteron_add_diagram(TARGET FILE [PARAMS P.toml] [TOP NAME] [FLOAT32])
#
# Makes an interface library TARGET of a diagram: whoever links it includes the header NAME.hpp of its step, where NAME
# is that of the block in small letters. The header is made anew where the diagram or its parameters change.
function(hysteron_add_diagram target file)
  cmake_parse_arguments(PARSE_ARGV 2 arg "FLOAT32" "PARAMS;TOP" "")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "hysteron_add_diagram does not take ${arg_UNPARSED_ARGUMENTS}; it takes PARAMS, TOP, FLOAT32.")
  endif()
  cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${target}.hysteron)
  set(options "")
  set(depends ${file})
  if(arg_PARAMS)
    cmake_path(ABSOLUTE_PATH arg_PARAMS BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE)
    list(APPEND options --params ${arg_PARAMS})
    list(APPEND depends ${arg_PARAMS})
  endif()
  if(arg_TOP)
    list(APPEND options --top ${arg_TOP})
  endif()
  if(arg_FLOAT32)
    list(APPEND options --float32)
  endif()
  add_custom_command(OUTPUT ${folder}/made
    COMMAND ${HYSTERON_PROGRAM} generate ${file} --target cpp --out ${folder} ${options}
    COMMAND ${CMAKE_COMMAND} -E touch ${folder}/made
    DEPENDS ${depends} ${HYSTERON_PROGRAM} VERBATIM COMMENT "Generating the step of ${file}")
  add_custom_target(${target}_step DEPENDS ${folder}/made)
  add_library(${target} INTERFACE)
  target_include_directories(${target} INTERFACE ${folder})
  # With these a step has the bits of `hysteron run`.
  target_compile_options(${target} INTERFACE $<$<CXX_COMPILER_ID:GNU,Clang>:-ffp-contract=off -frounding-math>)
  add_dependencies(${target} ${target}_step)
endfunction()
