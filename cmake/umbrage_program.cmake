# Executables that run where their build is carried to: the C++ runtime is linked into them and what Debian has as
# shared libraries only lies beside them.
include(umbrage_targets)

# umbrage_portable(target): links the C++ runtime statically and looks for shared libraries beside the executable.
function(umbrage_portable target)
  if(NOT UMBRAGE_SANITIZE)
    target_link_options(${target} PRIVATE -static-libstdc++ -static-libgcc)
  endif()
  set_target_properties(${target} PROPERTIES BUILD_RPATH_USE_ORIGIN ON BUILD_RPATH "$ORIGIN" INSTALL_RPATH "$ORIGIN"
                                             RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
endfunction()
