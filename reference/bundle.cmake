# cmake -D MODULE=file.so -D DESTINATION=folder -P bundle.cmake: copies a module and the shared libraries that it
# needs, glibc aside, into one folder, each under the name by which the loader asks for it.
execute_process(COMMAND ldd ${MODULE} OUTPUT_VARIABLE listing RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "ldd ${MODULE} failed (${status})")
endif()
if(listing MATCHES "([^ \t\n]+) => not found")
  message(FATAL_ERROR "${MODULE} needs ${CMAKE_MATCH_1}, which is not installed: run scripts/setup")
endif()

file(MAKE_DIRECTORY ${DESTINATION})
get_filename_component(module_name ${MODULE} NAME)
file(COPY_FILE ${MODULE} ${DESTINATION}/${module_name} ONLY_IF_DIFFERENT)

set(glibc "^(libc|libm|libdl|libpthread|librt|libresolv|libmvec)\\.so|^ld-linux")
string(REGEX MATCHALL "[^ \t\n]+ => /[^ \n]+" needed "${listing}")
foreach(entry IN LISTS needed)
  string(REGEX MATCH "^([^ ]+) => (.+)$" _ ${entry})
  set(name ${CMAKE_MATCH_1})
  file(REAL_PATH ${CMAKE_MATCH_2} source)
  if(NOT name MATCHES "${glibc}")
    file(COPY_FILE ${source} ${DESTINATION}/${name} ONLY_IF_DIFFERENT)
  endif()
endforeach()
