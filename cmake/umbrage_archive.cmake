# umbrage::umbrage: all stages in one archive that shows nothing but umbrage::. The stages' objects are linked into one
# relocatable object and every other symbol in it (templates of std and glm, third-party code) is made local, so that
# none can clash with the host's own copies or be replaced by them. tests/embedding lists what is left.
function(umbrage_archive)
  get_property(stages GLOBAL PROPERTY UMBRAGE_STAGES)
  if(NOT CMAKE_OBJCOPY)
    message(FATAL_ERROR "objcopy of the binutils is needed to build libumbrage.a")
  endif()
  set(objects ${stages})
  list(TRANSFORM objects REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>")

  # Itanium mangling: (virtual tables, type names, guards,) an optional qualifier, then "umbrage" with its length.
  set(public_symbols _ZN7umbrage* _ZNK7umbrage* _ZNO7umbrage* _ZNKO7umbrage* _ZNR7umbrage* _ZNKR7umbrage*
                     _ZTVN7umbrage* _ZTIN7umbrage* _ZTSN7umbrage* _ZGVN7umbrage* _ZGVNK7umbrage*)
  list(TRANSFORM public_symbols PREPEND "--keep-global-symbol=")
  set(joined ${PROJECT_BINARY_DIR}/umbrage.o)
  # Groups are dissolved first: a host with the same template would otherwise make the linker drop ours, which by
  # then is reachable only from within this object.
  add_custom_command(
    OUTPUT ${joined}
    COMMAND ${CMAKE_LINKER} -r --force-group-allocation -o ${joined}.all ${objects}
    COMMAND ${CMAKE_OBJCOPY} --wildcard ${public_symbols} ${joined}.all ${joined}
    COMMAND ${CMAKE_COMMAND} -E rm ${joined}.all
    DEPENDS ${objects}
    COMMENT "Joining umbrage.o"
    COMMAND_EXPAND_LISTS VERBATIM)
  set_source_files_properties(${joined} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)

  add_library(umbrage_library STATIC ${joined})
  add_library(umbrage::umbrage ALIAS umbrage_library)
  set_target_properties(umbrage_library PROPERTIES OUTPUT_NAME umbrage EXPORT_NAME umbrage LINKER_LANGUAGE CXX)
  target_compile_features(umbrage_library INTERFACE cxx_std_20)
  target_include_directories(umbrage_library INTERFACE
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(umbrage_library INTERFACE Vulkan::Headers)
  if(UMBRAGE_SANITIZE)
    target_link_options(umbrage_library INTERFACE $<BUILD_INTERFACE:-fsanitize=${UMBRAGE_SANITIZE}>)
  endif()
  if(TARGET umbrage_glsl)
    add_dependencies(umbrage_library umbrage_glsl)
  endif()

  # For tests of what is inside: the stages' objects themselves, to be linked instead of the archive.
  add_library(umbrage_internals INTERFACE)
  target_sources(umbrage_internals INTERFACE ${objects})
  target_include_directories(umbrage_internals INTERFACE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include)
  target_link_libraries(umbrage_internals INTERFACE Vulkan::Headers glm::glm)
  target_compile_definitions(umbrage_internals INTERFACE VK_NO_PROTOTYPES)
endfunction()
