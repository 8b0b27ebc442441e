# umbrage_public_shader(target src/….shared.h name.glsl): makes include/umbrage/shaders/name.glsl in the build tree, one
# file without includes for a host's shaders, from headers shared by C++ and GLSL: includes are expanded, the macros of
# core/shared_math.h are resolved, and every name gets the prefix umbrage_ (types and constants: Umbrage).
# The same file is the script that does it: cmake -D SOURCE= -D ROOT= -D OUTPUT= -P umbrage_public_shader.cmake

function(umbrage_public_shader target source name)
  set(output ${PROJECT_BINARY_DIR}/include/umbrage/shaders/${name})
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*.shared.h ${PROJECT_SOURCE_DIR}/src/lookup/*.glsl)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -D SOURCE=${source} -D ROOT=${PROJECT_SOURCE_DIR}/src -D OUTPUT=${output}
            -P ${PROJECT_SOURCE_DIR}/cmake/umbrage_public_shader.cmake
    DEPENDS ${headers} ${PROJECT_SOURCE_DIR}/cmake/umbrage_public_shader.cmake
    COMMENT "Making ${name}"
    VERBATIM)
  add_custom_target(${target}_public_shader DEPENDS ${output})
  add_dependencies(${target} ${target}_public_shader)
endfunction()

cmake_policy(SET CMP0057 NEW)

# Each file once. Include guards stay around each part, so that two generated files that share one can be included together.
function(expand file result)
  get_property(expanded GLOBAL PROPERTY expanded)
  if(file IN_LIST expanded)
    set(${result} "" PARENT_SCOPE)
    return()
  endif()
  set_property(GLOBAL APPEND PROPERTY expanded ${file})
  file(READ ${ROOT}/${file} text)
  string(REPLACE "#include \"core/shared_math.h\"\n" "" text "${text}")
  while(text MATCHES "#include \"([^\"]+)\"\n")
    set(directive "${CMAKE_MATCH_0}")
    expand(${CMAKE_MATCH_1} included)
    string(FIND "${text}" "${directive}" at)
    string(LENGTH "${directive}" length)
    string(SUBSTRING "${text}" 0 ${at} before)
    math(EXPR at "${at} + ${length}")
    string(SUBSTRING "${text}" ${at} -1 after)
    set(text "${before}${included}${after}")
  endwhile()
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

# Prefixes every name that `pattern` (one group: the name) finds.
function(prefix_names pattern prefix result)
  set(text "${${result}}")
  string(REGEX MATCHALL "${pattern}" definitions "${text}")
  foreach(definition IN LISTS definitions)
    string(REGEX REPLACE "${pattern}" "\\1" old "${definition}")
    string(REGEX REPLACE "(^|[^A-Za-z0-9_])${old}([^A-Za-z0-9_])" "\\1${prefix}${old}\\2" text "${text}")
  endforeach()
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  expand(${SOURCE} text)
  prefix_names("struct ([A-Za-z0-9_]+)" Umbrage text)
  prefix_names("UMB_FN [A-Za-z0-9_]+ ([a-z0-9_]+)" umbrage_ text)
  prefix_names("UMB_CONST [a-z0-9]+ ([A-Za-z0-9]+)" Umbrage text)
  string(REGEX REPLACE "UMB_(NAMESPACE_BEGIN|NAMESPACE_END|ASSERT_SIZE[^\n]*)\n" "" text "${text}")
  string(REPLACE "_SHARED_H\n" "_GLSL\n" text "${text}")
  string(REPLACE "UMB_FN " "" text "${text}")
  string(REPLACE "UMB_CONST " "const " text "${text}")
  string(REPLACE "UMB_PRECISE " "precise " text "${text}")
  string(REGEX REPLACE "UMB_OUT\\(([A-Za-z0-9_]+)\\)" "out \\1" text "${text}")
  string(REGEX REPLACE "UMB_INOUT\\(([A-Za-z0-9_]+)\\)" "inout \\1" text "${text}")
  string(REGEX REPLACE "\n\n\n+" "\n\n" text "${text}")
  if(text MATCHES "[^A-Za-z0-9_](UMB_[A-Z_]+)")
    message(FATAL_ERROR "${SOURCE}: ${CMAKE_MATCH_1} is no macro that umbrage_public_shader.cmake knows; add it there")
  endif()
  file(WRITE ${OUTPUT} "// Generated from src/${SOURCE} of umbrage.\n${text}")
endif()
