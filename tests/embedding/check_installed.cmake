# An installed umbrage serves a project of its own: installs BUILD to a fresh prefix, builds EXAMPLE against that and
# nothing else, and runs it. What it prints is known from geometry.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${WORK})
function(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\nended with ${status}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${EXAMPLE} -B ${WORK}/build -G Ninja -D CMAKE_PREFIX_PATH=${WORK}/prefix
    -D CMAKE_BUILD_TYPE=Release -D CMAKE_CXX_COMPILER=${COMPILER} -D "CMAKE_CXX_FLAGS=-Wall -Wextra ${FLAGS}")
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/minimal)
if(NOT output MATCHES "^1\\.(7[6-9]|8[0-9]|90) % of the picture is in shadow")
  message(FATAL_ERROR "minimal printed \"${output}\", expected 1.83 % within a pixel along the shadow's border")
endif()
message(STATUS "${output}")
