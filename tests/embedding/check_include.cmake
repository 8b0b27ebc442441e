# umbrage.glsl compiles in this stage of a host's shader, next to nothing else, and uses neither derivatives nor subgroup
# operations, so that it may be called from diverging control flow.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND ${GLSLC} --target-env=vulkan1.3 -Werror -I ${INCLUDE} -S -o - ${SHADER}
                OUTPUT_VARIABLE assembly COMMAND_ERROR_IS_FATAL ANY)
if(NOT assembly MATCHES "OpEntryPoint")
  message(FATAL_ERROR "${SHADER}: no entry point in what glslc made")
endif()
if(SHADER MATCHES "without_set" AND assembly MATCHES "OpTypeImage|DescriptorSet [1-9]")
  message(FATAL_ERROR "${SHADER}: umbrage.glsl uses a descriptor though no UMBRAGE_SET is defined")
endif()
if(assembly MATCHES "(OpGroupNonUniform[A-Za-z]*|OpSubgroup[A-Za-z]*|OpDPd[xy][A-Za-z]*|OpFwidth[A-Za-z]*|OpImage[A-Za-z]*ImplicitLod)")
  message(FATAL_ERROR "${SHADER}: umbrage.glsl uses ${CMAKE_MATCH_1}")
endif()
