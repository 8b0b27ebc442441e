# Targets with the project's flags. umbrage_stage() makes one object library of a folder of src/ and says which folders
# it may include from; tests/embedding/check_layers.cmake holds the sources to it.

function(umbrage_flags target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                                           -Wnon-virtual-dtor -Wno-missing-field-initializers)
  if(UMBRAGE_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(UMBRAGE_SANITIZE)
    target_compile_options(${target} PUBLIC -fsanitize=${UMBRAGE_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${UMBRAGE_SANITIZE})
  endif()
endfunction()

# umbrage_portable(target): an executable in bin/ with the C++ runtime inside, to be carried to other machines.
function(umbrage_portable target)
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  if(NOT UMBRAGE_SANITIZE)
    target_link_options(${target} PRIVATE -static-libstdc++ -static-libgcc)
  endif()
endfunction()

# umbrage_stage(name SOURCES a.cpp … [SHADERS x.comp …] [DEPENDS core gpu …])
function(umbrage_stage name)
  cmake_parse_arguments(arg "" "" "SOURCES;SHADERS;DEPENDS" ${ARGN})
  add_library(umbrage_${name} OBJECT ${arg_SOURCES})
  umbrage_flags(umbrage_${name})
  set_target_properties(umbrage_${name} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND NOT CMAKE_CXX_CLANG_TIDY)  # clang-tidy knows no such option
    target_compile_options(umbrage_${name} PRIVATE -fno-gnu-unique)    # umbrage_archive() could not make those local
  endif()
  target_include_directories(umbrage_${name} PRIVATE ${PROJECT_SOURCE_DIR}/src PUBLIC ${PROJECT_SOURCE_DIR}/include)
  target_include_directories(umbrage_${name} SYSTEM PRIVATE ${Vulkan_INCLUDE_DIRS})
  target_compile_definitions(umbrage_${name} PRIVATE VK_NO_PROTOTYPES)
  target_link_libraries(umbrage_${name} PRIVATE glm::glm)
  if(arg_SHADERS)
    umbrage_shaders(umbrage_${name} ${arg_SHADERS})
  endif()
  set_property(GLOBAL APPEND PROPERTY UMBRAGE_STAGES umbrage_${name})
  string(JOIN " " depends ${arg_DEPENDS})
  set_property(GLOBAL APPEND PROPERTY UMBRAGE_LAYERS "${name}: ${depends}")
endfunction()
