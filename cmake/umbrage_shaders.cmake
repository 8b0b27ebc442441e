# umbrage_shaders(target a.comp b.vert …): compiles each to SPIR-V and embeds it. C++ includes "shaders/a.comp.inc", a
# brace-enclosed list of 32-bit words for a `constexpr uint32_t[]`. "b.vert:X+Y" defines X and Y and makes "shaders/b_X_Y.vert.inc".
find_program(UMBRAGE_GLSLC glslc REQUIRED)

function(umbrage_shaders target)
  set(outputs)
  foreach(entry ${ARGN})
    string(REGEX MATCH "^([^:]+):?(.*)$" matched ${entry})
    set(shader ${CMAKE_MATCH_1})
    string(REPLACE "+" ";" defines "${CMAKE_MATCH_2}")
    get_filename_component(name ${shader} NAME)
    if(defines)
      list(JOIN defines "_" suffix)
      string(REGEX REPLACE "^([^.]+)" "\\1_${suffix}" name ${name})
      list(TRANSFORM defines PREPEND -D)
    endif()
    set(source ${CMAKE_CURRENT_SOURCE_DIR}/${shader})
    set(output ${CMAKE_CURRENT_BINARY_DIR}/shaders/${name}.inc)
    add_custom_command(
      OUTPUT ${output}
      COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_CURRENT_BINARY_DIR}/shaders
      COMMAND ${UMBRAGE_GLSLC} --target-env=vulkan1.3 -O -Werror -mfmt=c -MD -MF ${output}.d
              -I ${PROJECT_SOURCE_DIR}/src -I ${PROJECT_SOURCE_DIR}/include -I ${PROJECT_BINARY_DIR}/include
              ${UMBRAGE_SHADER_FLAGS} ${defines} -o ${output} ${source}
      DEPENDS ${source} ${UMBRAGE_SHADER_DEPENDS}
      DEPFILE ${output}.d
      COMMENT "Compiling ${name}"
      COMMAND_EXPAND_LISTS VERBATIM)
    list(APPEND outputs ${output})
  endforeach()
  add_custom_target(${target}_shaders DEPENDS ${outputs})
  if(TARGET umbrage_glsl)  # what hosts' shaders include is itself made by the build
    add_dependencies(${target}_shaders umbrage_glsl)
  endif()
  add_dependencies(${target} ${target}_shaders)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()
