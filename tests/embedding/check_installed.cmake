# An installed umbrage serves a project of its own, wherever it has been moved: installs BUILD to a fresh prefix, moves
# that, builds EXAMPLE against it and nothing else, and runs it. What it prints is known from geometry. The installed
# program finds its ray tracer in the moved tree, too: it compares SCENE (empty: there is no program).
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
file(RENAME ${WORK}/prefix ${WORK}/moved)
run(${CMAKE_COMMAND} -S ${EXAMPLE} -B ${WORK}/build -G Ninja -D CMAKE_PREFIX_PATH=${WORK}/moved
    -D CMAKE_BUILD_TYPE=Release -D CMAKE_CXX_COMPILER=${COMPILER} -D "CMAKE_CXX_FLAGS=-Wall -Wextra ${FLAGS}")
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/minimal)
if(NOT output MATCHES "^1\\.(7[6-9]|8[0-9]|90) % of the picture is in shadow")
  message(FATAL_ERROR "minimal printed \"${output}\", expected 1.83 % within a pixel along the shadow's border")
endif()
message(STATUS "${output}")

if(SCENE)
  run(${WORK}/moved/bin/umbrage compare ${SCENE} --size 64x36)
  string(JSON evaluated GET "${output}" pairs evaluated)
  if(evaluated EQUAL 0)
    message(FATAL_ERROR "the moved program compared nothing:\n${output}")
  endif()
endif()
